//! Areas of a layer, split by tile: each tile of each level gets the areas inside it.

use corniche_areas::{Axis, OutlineError, Polygon, coarsen, cut_out, divide_all, intersection};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion, Projection, TileId};
use corniche_osm::{AreaSummary, ExtractDefect, LayerArea};
use corniche_spec::{data_tiles::DataTiles, extent::AreaExtent};
use corniche_tileset::{AreaPolygon, LayerShape};

use super::sea;
use crate::layers::{
    layer_writer::TileSplitting,
    object_layer::{ObjectSplitting, SplitObject, value_points},
    plan_splitting::PlanSplitting,
    tile_section::ObjectMeasure,
};

/// Splits areas by tile.
pub(crate) struct AreaSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    /// The extent to which areas are clipped.
    pub extent: &'a AreaExtent,
    /// WGS84 ⇄ the grid's working CRS, for the size of the sea.
    pub projection: &'a (dyn Projection + Sync),
}

impl AreaSplitting<'_> {
    /// Returns the parts of an area by tile. On coarse levels, polygons smaller than a cell are
    /// skipped.
    pub(crate) fn split(
        &self,
        area: &LayerArea,
    ) -> Result<Vec<(TileId, Vec<AreaPolygon>)>, OutlineError> {
        let PlanSplitting { frame, data, polygon, .. } = self.plan;
        let mut parts = Vec::new();
        for level in self.plan.levels_of(area.class) {
            let step = self.plan.step(level);
            let mut coarse = Vec::new();
            for polygon in &area.polygons {
                coarse.extend(coarsen(polygon, step)?);
            }
            if level < frame.max_level() {
                let [east, north] = frame.node_steps(level).map(i128::from);
                coarse.retain(|polygon| polygon.doubled_area() >= 2 * east * north);
            }
            // The region comes before other cuts, because the data's rectangle is not on the
            // lattice of coarse levels.
            for region in polygon.into_iter().chain(&self.extent.region) {
                coarse = inside(coarse, region, step)?;
            }
            let coarse = cut_out(&coarse, &self.extent.bounds)?;
            let mut tiles = Vec::new();
            let wanted = DataTilesOfLevel { frame, data: data.above(level), level };
            wanted.divide(TileId::ROOT, coarse, &mut tiles)?;
            let rings = |polygons: Vec<Polygon>| polygons.iter().map(rings_of).collect();
            parts.extend(tiles.into_iter().map(|(id, polygons)| (id, rings(polygons))));
        }
        Ok(parts)
    }
}

/// The parts of polygons inside a region, on the lattice of a level.
fn inside(
    polygons: Vec<Polygon>,
    region: &LatticeRegion,
    step: i64,
) -> Result<Vec<Polygon>, OutlineError> {
    let points: Vec<LatticePoint> =
        polygons.iter().flat_map(|polygon| polygon.outer().points()).copied().collect();
    // Outlines are snapped to the level's lattice, too.
    let Some(near) = LatticeBounds::around(&points).map(|bounds| bounds.expanded(2 * step)) else {
        return Ok(polygons);
    };
    if region.edges_near(&near).next().is_some() {
        return intersection(&polygons, region.rings(), step);
    }
    Ok(if region.contains(near.min) { polygons } else { Vec::new() })
}

/// The tiles of a level in which there can be data.
struct DataTilesOfLevel<'a> {
    frame: &'a GridFrame,
    data: DataTiles,
    level: u8,
}

impl DataTilesOfLevel<'_> {
    /// Divides polygons inside or around a tile along the borders of the tiles beneath it, down to
    /// the level.
    ///
    /// Every tile is cut along the same lines in the same order, and two neighbouring tiles are cut
    /// along the line between them. So both have the same points on this line.
    fn divide(
        &self,
        id: TileId,
        polygons: Vec<Polygon>,
        tiles: &mut Vec<(TileId, Vec<Polygon>)>,
    ) -> Result<(), OutlineError> {
        let bounds = self.frame.tile_lattice_bounds(id);
        let polygons: Vec<Polygon> =
            polygons.into_iter().filter(|polygon| meets(polygon, &bounds)).collect();
        if polygons.is_empty() {
            return Ok(());
        }
        if id.z() == self.level {
            if self.data.contains(id) {
                tiles.push((id, polygons));
            }
            return Ok(());
        }
        // The four children meet in the south-eastern corner of the first child, which is the
        // north-western one.
        let Some(first) = id.children().next() else { return Ok(()) };
        let first = self.frame.tile_lattice_bounds(first);
        let [west, east] = divide_all(&polygons, Axis::East, first.max.u)?;
        let [south_west, north_west] = divide_all(&west, Axis::North, first.min.v)?;
        let [south_east, north_east] = divide_all(&east, Axis::North, first.min.v)?;
        let quarters = [north_west, north_east, south_west, south_east];
        for (child, quarter) in id.children().zip(quarters) {
            self.divide(child, quarter, tiles)?;
        }
        Ok(())
    }
}

fn meets(polygon: &Polygon, bounds: &LatticeBounds) -> bool {
    LatticeBounds::around(polygon.outer().points()).is_some_and(|own| own.intersects(bounds))
}

impl TileSplitting for AreaSplitting<'_> {
    type Object = LayerArea;
    type Split = SplitObject;

    fn points(area: &LayerArea) -> usize {
        let rings = area.polygons.iter().flat_map(Polygon::rings);
        rings.map(|ring| ring.points().len()).sum::<usize>() + value_points(&area.values)
    }

    fn split_object(&self, _: u64, area: LayerArea) -> SplitObject {
        let parts = self.split(&area);
        let shape = |(id, polygons): (TileId, Vec<AreaPolygon>)| (id, LayerShape::Area(polygons));
        let shapes = parts.map(|parts| parts.into_iter().map(shape).collect());
        let measure = ObjectMeasure { area_m2: area.area_m2, ..ObjectMeasure::default() };
        SplitObject::new((area.class, area.object), &area.values, measure, shapes)
    }
}

impl ObjectSplitting for AreaSplitting<'_> {
    type Summary = AreaSummary;

    fn plan(&self) -> &PlanSplitting<'_> {
        &self.plan
    }

    fn last_object(
        &self,
        summary: &mut AreaSummary,
        on_defect: &mut dyn FnMut(ExtractDefect),
    ) -> Option<LayerArea> {
        let PlanSplitting { table, frame, .. } = self.plan;
        sea::close((table, self.extent), (frame, self.projection), summary, on_defect)
    }
}

fn rings_of(polygon: &Polygon) -> AreaPolygon {
    AreaPolygon { rings: polygon.rings().map(|ring| ring.points().to_vec()).collect() }
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
