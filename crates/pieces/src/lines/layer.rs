//! Lines of a layer, split by tile: each tile of each level gets the segments near it.

use std::borrow::Cow;

use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_layers::OsmObject;
use corniche_osm::{LayerLine, LineSummary};
use corniche_roads::{Structure, kept_points};
use corniche_spec::{levels::Levels, tiles_near::for_each_tile_near, true_lengths::TrueLengths};
use corniche_tileset::LayerShape;

use crate::layers::{
    fixed_points::fixed_of_part,
    layer_writer::TileSplitting,
    object_layer::{ObjectSplitting, SplitObject, value_points},
    plan_splitting::PlanSplitting,
    span_pieces::SpanPiece,
    tile_section::ObjectMeasure,
};

/// Splits and measures lines.
pub(crate) struct LineSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    pub levels: &'a Levels,
    pub lengths: &'a TrueLengths<'a>,
    /// Whether bridges and tunnels of the layer become spans.
    pub spans: bool,
}

/// A line, or a part of it inside the polygon.
struct LinePart<'a> {
    points: Cow<'a, [LatticePoint]>,
    /// The indices of the points that simplification must keep.
    fixed: Cow<'a, [u32]>,
    /// The position of each point along the line, micrometres; empty on the ground.
    along_um: Vec<u64>,
}

/// A part of a line as a level shows it, or a stretch of it near a tile.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct LevelPart {
    pub(crate) points: Vec<LatticePoint>,
    /// The position of each point along the line, micrometres; empty on the ground.
    pub(crate) along_um: Vec<u64>,
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
        let segments_um = if self.spans && object.structure != Structure::Ground {
            // As for bridges and tunnels of roads, lengths do not depend on bounds.
            self.lengths.projected_segments_um(&line)
        } else {
            Vec::new()
        };
        let Some(region) = self.plan.polygon else {
            return vec![LinePart {
                points: Cow::Borrowed(points),
                fixed: Cow::Borrowed(fixed),
                along_um: alongs_um(0, segments_um.iter().copied()),
            }];
        };
        let cut = |part: ClippedPart| LinePart {
            fixed: Cow::Owned(fixed_of_part(points, fixed, &part)),
            along_um: self.alongs_of_part_um((&line, &part), &segments_um),
            points: Cow::Owned(part.line.points().to_vec()),
        };
        clip_region(&line, region).into_iter().map(cut).collect()
    }

    /// The positions of a part's points along the line, which has segments of these lengths.
    fn alongs_of_part_um(
        &self,
        (line, part): (&Polyline, &ClippedPart),
        segments_um: &[u64],
    ) -> Vec<u64> {
        if segments_um.is_empty() {
            return Vec::new();
        }
        let (from_um, part_um) = self.lengths.part_um(line, part, segments_um);
        alongs_um(from_um, part_um.into_iter())
    }

    fn split_level(&self, part: &LinePart<'_>, level: u8) -> Vec<(TileId, LevelPart)> {
        let LevelPart { points, along_um } = self.line(part, level);
        let data = self.plan.data.above(level);
        let mut near: Vec<(TileId, usize)> = Vec::new();
        for (segment, pair) in points.array_windows::<2>().enumerate() {
            for_each_tile_near(*pair, level, self.levels, |id| {
                if data.contains(id) && self.is_wanted(id) {
                    near.push((id, segment));
                }
            });
        }
        near.sort_unstable();
        let runs = near.chunk_by(|(one, at), (other, next)| one == other && at + 1 == *next);
        let points_of = |run: &[(TileId, usize)]| {
            let (first, last) = (run[0].1, run[run.len() - 1].1);
            let own = LevelPart {
                points: points[first..=last + 1].to_vec(),
                along_um: along_um.get(first..=last + 1).unwrap_or_default().to_vec(),
            };
            (run[0].0, own)
        };
        runs.map(points_of).collect()
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
        let mut of_level = LevelPart::default();
        let last = kept.len().saturating_sub(1);
        for (number, index) in kept.into_iter().enumerate() {
            let at = self.plan.on_lattice(points[index], level);
            let own_um = along_um.get(index).copied();
            if of_level.points.last() != Some(&at) {
                of_level.points.push(at);
                of_level.along_um.extend(own_um);
            } else if let (true, Some(last_um)) = (number == last, of_level.along_um.last_mut()) {
                // Of two points in one place, the line's end counts: decks end there.
                *last_um = own_um.unwrap_or(*last_um);
            }
        }
        of_level
    }
}

/// The positions of all points of a line, from the lengths of its segments; empty without lengths.
fn alongs_um(from_um: u64, segments_um: impl ExactSizeIterator<Item = u64>) -> Vec<u64> {
    if segments_um.len() == 0 {
        return Vec::new();
    }
    let sum = |along_um: &mut u64, length_um: u64| {
        *along_um += length_um;
        Some(*along_um)
    };
    std::iter::once(from_um).chain(segments_um.scan(from_um, sum)).collect()
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
        let from = (object.way_id, object.points[0]);
        for (id, LevelPart { points, along_um }) in self.split(&object) {
            if !along_um.is_empty() {
                spans.push((id, SpanPiece::new(from, object.structure, (&points, &along_um))));
            }
            shapes.push((id, LayerShape::Line(points)));
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
        self.spans
    }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
