//! Points of a layer, split by tile: each point is in one tile of each level.

use corniche_geom::{LatticePoint, TileId};
use corniche_osm::{LayerPoint, PointSummary};
use corniche_tileset::LayerShape;

use crate::layers::{
    layer_writer::TileSplitting,
    object_layer::{ObjectSplitting, SplitObject, value_points},
    plan_splitting::PlanSplitting,
    tile_section::ObjectMeasure,
};

/// Splits points by tile.
pub(crate) struct PointSplitting<'a> {
    pub plan: PlanSplitting<'a>,
}

impl PointSplitting<'_> {
    /// Returns the tile that contains a point on each level, and the point on the level's lattice.
    /// A point on a border is in the tile in the east or south, if there can be one.
    pub(crate) fn split(&self, class: u8, at: LatticePoint) -> Vec<(TileId, LatticePoint)> {
        let PlanSplitting { frame, data, clip, polygon, .. } = self.plan;
        if clip.is_some_and(|clip| !clip.contains(at))
            || polygon.is_some_and(|region| !region.contains(at))
        {
            return Vec::new();
        }
        let on_level = |level| {
            let at = self.plan.on_lattice(at, level);
            let id = data.above(level).owner(frame, at);
            frame.tile_lattice_bounds(id).contains(at).then_some((id, at))
        };
        self.plan.levels_of(class).filter_map(on_level).collect()
    }
}

impl TileSplitting for PointSplitting<'_> {
    type Object = LayerPoint;
    type Split = SplitObject;

    fn points(point: &LayerPoint) -> usize {
        1 + value_points(&point.values)
    }

    fn split_object(&self, _: u64, point: LayerPoint) -> SplitObject {
        let LayerPoint { object, class, values, at } = point;
        let parts = self.split(class, at).into_iter();
        let shapes = parts.map(|(id, at)| (id, LayerShape::Point(at))).collect();
        SplitObject::new((class, object), &values, ObjectMeasure::default(), Ok(shapes))
    }
}

impl ObjectSplitting for PointSplitting<'_> {
    type Summary = PointSummary;

    fn plan(&self) -> &PlanSplitting<'_> {
        &self.plan
    }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
