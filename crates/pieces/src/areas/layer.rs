//! The areas of the extract, split by tile: each tile of each level gets a section with the areas
//! inside it.

use corniche_areas::{
    Area, AreaClass, AreaObject, Axis, OutlineError, Polygon, coarsen, cut_out, divide_all,
    intersection,
};
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, LatticeRegion, TileId};
use corniche_osm::{AreaLoss, AreaSummary};
use corniche_spec::{Defect, artifacts::damaged, data_tiles::DataTiles, extent::AreaExtent};
use corniche_store::{Artifacts, ScratchSpace, record_bytes, take_record};
use corniche_tileset::{AreaRecord, AreaRings, encode_areas};
use corniche_work::Stage;

use super::sea::SeaPlace;
use crate::{
    ExtractError,
    layers::{
        SectionLayer,
        layer_writer::{LayerContext, LayerEncoder, TileSplitting},
        parts_by_tile::PartsByTile,
        plan_splitting::PlanSplitting,
        tile_section::AreaTotals,
        tile_section::TileSection,
    },
};

/// Splits areas by tile.
pub(crate) struct AreaSplitting<'a> {
    pub plan: PlanSplitting<'a>,
    /// The extent to which areas are clipped.
    pub extent: &'a AreaExtent,
}

impl AreaSplitting<'_> {
    /// Returns the parts of an area by tile. On coarse levels, polygons smaller than a cell are
    /// skipped.
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
            // The region comes before other cuts, because the data's rectangle is not on the
            // lattice of coarse levels.
            for region in polygon.into_iter().chain(&self.extent.region) {
                coarse = inside(coarse, region, step)?;
            }
            let coarse = cut_out(&coarse, &self.extent.bounds)?;
            let mut tiles = Vec::new();
            let wanted = DataTilesOfLevel { frame, data: data.above(level), level };
            wanted.divide(TileId::ROOT, coarse, &mut tiles)?;
            parts.extend(tiles.into_iter().map(|(id, polygons)| (id, record(area, &polygons))));
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

/// Receives areas in the order in which they are read.
pub(crate) struct AreaLayer<'a> {
    splitting: AreaSplitting<'a>,
    sea: SeaPlace<'a>,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, u64>,
    /// Areas that were too complex to split, with their true area.
    intricate: Vec<(AreaObject, AreaClass, f64)>,
}

impl<'a> AreaLayer<'a> {
    pub(crate) fn new(
        (splitting, sea): (AreaSplitting<'a>, SeaPlace<'a>),
        (store, scratch): (&'a dyn Artifacts, &'a dyn ScratchSpace),
        memory_bytes: u64,
    ) -> Self {
        let parts = PartsByTile::new(scratch, memory_bytes);
        Self { splitting, sea, store, parts, intricate: Vec::new() }
    }
}

/// An area that has been split.
pub(crate) struct SplitArea {
    number: u64,
    object: AreaObject,
    class: AreaClass,
    area_m2: f64,
    parts: Result<Vec<(TileId, Vec<u8>)>, OutlineError>,
}

impl TileSplitting for AreaSplitting<'_> {
    type Object = Area;
    type Split = SplitArea;

    fn points(area: &Area) -> usize {
        let rings = area.polygons.iter().flat_map(Polygon::rings);
        rings.map(|ring| ring.points().len()).sum()
    }

    fn split_object(&self, number: u64, area: Area) -> SplitArea {
        let Area { object, class, area_m2, .. } = area;
        let parts = self
            .split(&area)
            .map(|parts| parts.into_iter().map(|(id, part)| (id, record_bytes(part))).collect());
        SplitArea { number, object, class, area_m2, parts }
    }
}

impl<'a> LayerEncoder for AreaLayer<'a> {
    type Splitting = AreaSplitting<'a>;
    type Summary = AreaSummary;
    type Done = AreaTotals;

    fn stage(&self) -> Stage {
        SectionLayer::Areas.stage()
    }

    fn splitting(&self) -> &AreaSplitting<'a> {
        &self.splitting
    }

    fn take(&mut self, split: SplitArea) -> Result<(), ExtractError> {
        let SplitArea { number, object, class, area_m2, parts } = split;
        let Ok(parts) = parts else {
            self.intricate.push((object, class, area_m2));
            return Ok(());
        };
        parts.into_iter().try_for_each(|(id, bytes)| self.parts.push(id, number, bytes))
    }

    /// Closes the sea, and stores the sections of all tiles and finally the totals.
    fn finish(
        mut self,
        count: u64,
        mut summary: AreaSummary,
        told: &LayerContext<'_>,
    ) -> Result<AreaTotals, ExtractError> {
        let on_defect = &mut |defect| told.on_defect(Defect::from(defect));
        if let Some(sea) = self.sea.close(&mut summary, on_defect) {
            let split = self.splitting.split_object(count, sea);
            self.take(split)?;
        }
        for (object, class, area_m2) in self.intricate {
            if let Some(kept) = summary.kept.get_mut(&class) {
                kept.areas -= 1;
                kept.area_m2 -= area_m2;
            }
            *summary.lost.entry(AreaLoss::TooIntricate).or_default() += 1;
            let (kind, id) = object.parts();
            let (is_relation, loss) = (kind == "relation", AreaLoss::TooIntricate);
            on_defect(corniche_osm::ExtractDefect::LostArea { is_relation, id, loss });
        }
        let (splitting, store) = (&self.splitting.plan, self.store);
        self.parts.for_each_tile(
            told.observer,
            |parts: &mut Vec<AreaRecord>, tile, _, bytes| {
                parts.push(take_record(&mut &*bytes).ok_or_else(|| {
                    let key = SectionLayer::Areas.section().item(tile);
                    damaged(key, &"the record read back is not an area")
                })?);
                Ok(())
            },
            |tile, parts| put_section(tile, &parts, splitting, store),
        )?;
        let totals = AreaTotals {
            objects: summary.objects,
            kept: summary
                .kept
                .iter()
                .map(|(class, kept)| (class.number(), (kept.areas, kept.area_m2)))
                .collect(),
            lost: summary.lost.iter().map(|(loss, &n)| (loss.reason().to_owned(), n)).collect(),
        };
        totals.put(SectionLayer::Areas, store)?;
        Ok(totals)
    }
}

fn put_section(
    tile: u64,
    areas: &[AreaRecord],
    splitting: &PlanSplitting<'_>,
    store: &dyn Artifacts,
) -> Result<(), ExtractError> {
    let rings = areas.iter().flat_map(AreaRecord::rings);
    let counts = [areas.len() as u64, rings.map(|ring| ring.len() as u64).sum()];
    TileSection::put((SectionLayer::Areas, tile), store, counts, |id| {
        encode_areas(id, splitting.frame, splitting.step(id.z()), areas)
    })
}

#[cfg(test)]
#[path = "layer_tests.rs"]
mod tests;
