//! Lines of a layer, split by tile: each tile of each level gets the segments near it.

use std::borrow::Cow;

use corniche_drape::{ClippedPart, clip_region};
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_layers::OsmObject;
use corniche_osm::{LayerLine, LineSummary};
use corniche_roads::simplify;
use corniche_spec::{levels::Levels, tiles_near::for_each_tile_near, true_lengths::TrueLengths};
use corniche_tileset::LayerShape;

use crate::layers::{
    fixed_points::fixed_of_part,
    layer_writer::TileSplitting,
    object_layer::{ObjectSplitting, SplitObject, value_points},
    plan_splitting::PlanSplitting,
    tile_section::ObjectMeasure,
};

/// Splits and measures lines.
pub(crate) struct LineSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    pub levels: &'a Levels,
    pub lengths: &'a TrueLengths<'a>,
}

/// The points of a line or of a part of it, and the indices of those that simplification must keep.
type LinePart<'a> = (Cow<'a, [LatticePoint]>, Cow<'a, [u32]>);

impl LineSplitting<'_> {
    /// Returns the parts of a line by tile.
    pub(crate) fn split(&self, object: &LayerLine) -> Vec<(TileId, Vec<LatticePoint>)> {
        let parts = self.parts(object);
        let levels = self.plan.levels_of(object.class);
        levels
            .flat_map(|level| parts.iter().flat_map(move |part| self.split_level(part, level)))
            .collect()
    }

    /// The parts of a line inside the polygon; without a polygon, the line.
    fn parts<'b>(&self, object: &'b LayerLine) -> Vec<LinePart<'b>> {
        let LayerLine { points, fixed, .. } = object;
        let Some(region) = self.plan.polygon else {
            return vec![(Cow::Borrowed(points), Cow::Borrowed(fixed))];
        };
        let Ok(line) = Polyline::new(points.clone()) else { return Vec::new() };
        let cut = |part: ClippedPart| {
            let fixed = fixed_of_part(points, fixed, &part);
            (Cow::Owned(part.line.points().to_vec()), Cow::Owned(fixed))
        };
        clip_region(&line, region).into_iter().map(cut).collect()
    }

    fn split_level(&self, part: &LinePart<'_>, level: u8) -> Vec<(TileId, Vec<LatticePoint>)> {
        let points = self.line(part, level);
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
            (run[0].0, points[first..=last + 1].to_vec())
        };
        runs.map(points_of).collect()
    }

    fn is_wanted(&self, id: TileId) -> bool {
        let tile = self.plan.frame.tile_lattice_bounds(id);
        self.plan.clip.is_none_or(|clip| clip.intersects(&tile))
    }

    /// A line as a level shows it: simplified, on the level's lattice.
    fn line(&self, (points, fixed): &LinePart<'_>, level: u8) -> Vec<LatticePoint> {
        let frame = self.plan.frame;
        let tolerance_m = if level == frame.max_level() {
            0.0
        } else {
            self.plan.table.form().simplify_cells * frame.level_cell(level).shorter_m()
        };
        let Ok(line) = Polyline::new(points.to_vec()) else { return Vec::new() };
        let simplified = simplify(&line, fixed, tolerance_m / frame.lattice_step_m());
        let points = simplified.points().iter();
        let mut points: Vec<LatticePoint> =
            points.map(|&point| self.plan.on_lattice(point, level)).collect();
        points.dedup();
        points
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
        let parts = self.split(&object).into_iter();
        let shapes = parts.map(|(id, points)| (id, LayerShape::Line(points))).collect();
        let way = OsmObject::Way(object.way_id);
        SplitObject::new((object.class, way), &object.values, measure, Ok(shapes))
    }
}

impl ObjectSplitting for LineSplitting<'_> {
    type Summary = LineSummary;

    fn plan(&self) -> &PlanSplitting<'_> {
        &self.plan
    }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
