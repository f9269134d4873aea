//! Lines of a layer, split by tile: each tile of each level gets the segments near it.

use std::borrow::Cow;

use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_layers::OsmObject;
use corniche_osm::{LayerLine, LineSummary};
use corniche_roads::{Structure, kept_points};
use corniche_spec::{levels::Levels, true_lengths::TrueLengths};
use corniche_tileset::{LayerShape, LayerSlot, RunOwner};

use crate::layers::{
    fixed_points::fixed_of_part,
    layer_writer::TileSplitting,
    object_layer::{ObjectSplitting, SplitObject, value_points},
    plan_splitting::PlanSplitting,
    segment_run::{LevelPart, alongs_um},
    span_pieces::{self, CarriedLine, SpanLineOf},
    tile_section::ObjectMeasure,
};

/// Splits and measures lines.
pub(crate) struct LineSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    pub levels: &'a Levels,
    pub lengths: &'a TrueLengths<'a>,
    /// The layer, if its bridges and tunnels become spans.
    pub spans: Option<LayerSlot>,
}

/// A line, or a part of it inside the polygon.
struct LinePart<'a> {
    points: Cow<'a, [LatticePoint]>,
    /// The indices of the points that simplification must keep.
    fixed: Cow<'a, [u32]>,
    /// The position of each point along the line, micrometres; empty on the ground.
    along_um: Vec<u64>,
}

impl LineSplitting<'_> {
    /// Returns the parts of a line by tile.
    pub(crate) fn split(&self, object: &LayerLine) -> Vec<(TileId, LevelPart)> {
        let parts = self.parts(object);
        let levels = self.plan.levels_of(object.class);
        levels
            .flat_map(|level| parts.iter().flat_map(move |part| self.split_level(part, level)))
            .collect()
    }

    /// The parts of a line inside the polygon; without a polygon, the line.
    fn parts<'b>(&self, object: &'b LayerLine) -> Vec<LinePart<'b>> {
        let LayerLine { points, fixed, .. } = object;
        let Ok(line) = Polyline::new(points.clone()) else { return Vec::new() };
        let segments_um = if self.spans.is_some() && object.structure != Structure::Ground {
            // As for bridges and tunnels of roads, lengths do not depend on bounds.
            self.lengths.projected_segments_um(&line)
        } else {
            Vec::new()
        };
        let Some(region) = self.plan.polygon else {
            return vec![LinePart {
                points: Cow::Borrowed(points),
                fixed: Cow::Borrowed(fixed),
                along_um: alongs_um(0, &segments_um),
            }];
        };
        let cut = |part: ClippedPart| {
            let along_um = if segments_um.is_empty() {
                Vec::new()
            } else {
                let (from_um, part_um) = self.lengths.part_um(&line, &part, &segments_um);
                alongs_um(from_um, &part_um)
            };
            let fixed = Cow::Owned(fixed_of_part(points, fixed, &part));
            LinePart { points: Cow::Owned(part.line.into_points()), fixed, along_um }
        };
        clip_region(&line, region).into_iter().map(cut).collect()
    }

    fn split_level(&self, part: &LinePart<'_>, level: u8) -> Vec<(TileId, LevelPart)> {
        let line = self.line(part, level);
        let data = self.plan.data.above(level);
        let is_wanted = |id| data.contains(id) && self.is_wanted(id);
        let runs = line.runs(level, self.levels, is_wanted).into_iter();
        runs.map(|(id, run)| (id, line.stretch(run))).collect()
    }

    fn is_wanted(&self, id: TileId) -> bool {
        let tile = self.plan.frame.tile_lattice_bounds(id);
        self.plan.clip.is_none_or(|clip| clip.intersects(&tile))
    }

    /// A line as a level shows it: simplified, on the level's lattice.
    fn line(&self, part: &LinePart<'_>, level: u8) -> LevelPart {
        let frame = self.plan.frame;
        let tolerance_m = if level == frame.max_level() {
            0.0
        } else {
            self.plan.table.form().simplify_cells * frame.level_cell(level).shorter_m()
        };
        let LinePart { points, fixed, along_um } = part;
        let Ok(line) = Polyline::new(points.to_vec()) else { return LevelPart::default() };
        let kept = kept_points(&line, fixed, tolerance_m / frame.lattice_step_m());
        LevelPart::new((points, along_um), &kept, |at| self.plan.on_lattice(at, level))
    }
}

impl TileSplitting for LineSplitting<'_> {
    type Object = LayerLine;
    type Split = SplitObject;

    fn points(line: &LayerLine) -> usize {
        line.points.len() + value_points(&line.values)
    }

    fn split_object(&self, _: u64, object: LayerLine) -> SplitObject {
        let line = Polyline::new(object.points.clone());
        let length_um = line.map_or(0, |line| self.lengths.segments_um(&line).iter().sum());
        let measure = ObjectMeasure { length_um, ..ObjectMeasure::default() };
        let (mut shapes, mut spans) = (Vec::new(), Vec::new());
        let (way_id, start) = (object.way_id, object.points[0]);
        for (id, part) in self.split(&object) {
            shapes.push((id, LayerShape::Line(part.points.clone())));
            if let Some((slot, &from_um)) = self.spans.zip(part.along_um.first())
                && let Some(run) = part.run()
            {
                let of = SpanLineOf {
                    line: CarriedLine::Way(way_id, start),
                    way_id,
                    owner: RunOwner::Layer(slot),
                    structure: object.structure,
                };
                spans.push((id, (way_id, start, from_um), span_pieces::to_bytes(of, &run)));
            }
        }
        let way = OsmObject::Way(object.way_id);
        let split = SplitObject::new((object.class, way), &object.values, measure, Ok(shapes));
        split.with_spans(spans)
    }
}

impl ObjectSplitting for LineSplitting<'_> {
    type Summary = LineSummary;

    fn plan(&self) -> &PlanSplitting<'_> {
        &self.plan
    }

    fn has_spans(&self) -> bool {
        self.spans.is_some()
    }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
