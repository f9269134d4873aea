//! One area to its parts in the tiles of each level.

use corniche_areas::{
    Area, Axis, OutlineError, Polygon, coarsen, cut_out, divide_all, intersection,
};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion, TileId};
use corniche_spec::{data_tiles::DataTiles, extent::AreaExtent};
use corniche_tileset::{AreaRecord, AreaRings};

use crate::layers::plan_splitting::PlanSplitting;

/// How areas are split.
pub(crate) struct AreaSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    /// Areas end where it does.
    pub extent: &'a AreaExtent,
}

impl AreaSplitting<'_> {
    /// The parts of an area by tile. On coarse levels, polygons smaller than a cell are left out.
    pub(crate) fn split(&self, area: &Area) -> Result<Vec<(TileId, AreaRecord)>, OutlineError> {
        let PlanSplitting { frame, data, polygon, .. } = self.plan;
        let mut parts = Vec::new();
        for level in 0..=frame.max_level() {
            let step = self.plan.step(level);
            let mut coarse = Vec::new();
            for polygon in &area.polygons {
                coarse.extend(coarsen(polygon, step)?);
            }
            if level < frame.max_level() {
                let [east, north] = frame.node_steps(level).map(i128::from);
                coarse.retain(|polygon| polygon.doubled_area() >= 2 * east * north);
            }
            // Before other cuts: the data's rectangle is not on the lattice of coarse levels.
            for region in polygon.into_iter().chain(&self.extent.region) {
                coarse = inside(coarse, region, step)?;
            }
            let coarse = cut_out(&coarse, &self.extent.bounds)?;
            let mut tiles = Vec::new();
            let wanted = Wanted { frame, data: data.above(level), level };
            wanted.divide(TileId::ROOT, coarse, &mut tiles)?;
            parts.extend(tiles.into_iter().map(|(id, polygons)| (id, record(area, &polygons))));
        }
        Ok(parts)
    }
}

/// The parts of polygons in a region, on the lattice of a level.
fn inside(
    polygons: Vec<Polygon>,
    region: &LatticeRegion,
    step: i64,
) -> Result<Vec<Polygon>, OutlineError> {
    let points: Vec<LatticePoint> =
        polygons.iter().flat_map(|polygon| polygon.outer().points()).copied().collect();
    // Outlines are put on the lattice of the level, too.
    let Some(near) = LatticeBounds::of(&points).map(|bounds| bounds.expanded(2 * step)) else {
        return Ok(polygons);
    };
    if region.edges_near(&near).next().is_some() {
        return intersection(&polygons, region.rings(), step);
    }
    Ok(if region.contains(near.min) { polygons } else { Vec::new() })
}

/// The tiles of a level on which data can lie.
struct Wanted<'a> {
    frame: &'a GridFrame,
    data: DataTiles,
    level: u8,
}

impl Wanted<'_> {
    /// Divides polygons that lie in a tile, or beside it, by the lines between the tiles beneath it, down to the level.
    ///
    /// All tiles are made by the same lines in the same order, those of an area between two tiles by the line between them: so both have
    /// the same points on it.
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
        // The four children meet in the south-eastern corner of the first, which is north-western.
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
    LatticeBounds::of(polygon.outer().points()).is_some_and(|own| own.intersects(bounds))
}

fn record(area: &Area, polygons: &[Polygon]) -> AreaRecord {
    let rings = |polygon: &Polygon| AreaRings {
        rings: polygon.rings().map(|ring| ring.points().to_vec()).collect(),
    };
    AreaRecord {
        object: area.object,
        class: area.class,
        name: area.name.clone().unwrap_or_default(),
        polygons: polygons.iter().map(rings).collect(),
    }
}

#[cfg(test)]
#[path = "split_tests.rs"]
mod tests;
