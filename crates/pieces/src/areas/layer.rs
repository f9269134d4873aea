//! The areas of the extract: for each tile of each level, the section with what lies in it.

use corniche_areas::{Area, AreaClass, AreaObject, OutlineError, Polygon};
use corniche_geom::TileId;
use corniche_osm::{AreaLoss, AreaSummary};
use corniche_spec::{Defect, artifacts::damaged};
use corniche_store::{Artifacts, Scratch};
use corniche_tileset::{AreaRecord, encode_areas};
use corniche_work::Stage;

use super::{sea::SeaPlace, split::AreaSplitting};
use crate::{
    ExtractError,
    layers::{
        SectionLayer,
        layer_totals::AreaTotals,
        layer_writer::{LayerContext, TileLayer, TileSplitting},
        parts_by_tile::{PartsByTile, part_bytes, part_of_bytes},
        plan_splitting::PlanSplitting,
        tile_section::TileSection,
    },
};

/// Areas as they come in.
pub(crate) struct AreaLayer<'a> {
    splitting: AreaSplitting<'a>,
    sea: SeaPlace<'a>,
    store: &'a dyn Artifacts,
    parts: PartsByTile<'a, u64>,
    /// Areas that could not be split, with their true area.
    intricate: Vec<(AreaObject, AreaClass, f64)>,
}

impl<'a> AreaLayer<'a> {
    pub(crate) fn new(
        (splitting, sea): (AreaSplitting<'a>, SeaPlace<'a>),
        (store, scratch): (&'a dyn Artifacts, &'a dyn Scratch),
        memory_bytes: u64,
    ) -> Self {
        let parts = PartsByTile::new(scratch, memory_bytes);
        Self { splitting, sea, store, parts, intricate: Vec::new() }
    }
}

/// An area that was split.
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
            .map(|parts| parts.into_iter().map(|(id, part)| (id, part_bytes(part))).collect());
        SplitArea { number, object, class, area_m2, parts }
    }
}

impl<'a> TileLayer for AreaLayer<'a> {
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

    /// Closes the sea, and keeps the sections of all tiles and last the totals.
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
            on_defect(corniche_osm::Defect::LostArea { is_relation, id, loss });
        }
        let (splitting, store) = (&self.splitting.plan, self.store);
        self.parts.for_each_tile(
            told.observer,
            |parts: &mut Vec<AreaRecord>, tile, _, bytes| {
                parts.push(part_of_bytes(&bytes).ok_or_else(|| {
                    let key = SectionLayer::Areas.section().item(tile);
                    damaged(key, &"what was read back is no area")
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
    let rings = areas.iter().flat_map(|area| &area.polygons).flat_map(|part| &part.rings);
    let counts = [areas.len() as u64, rings.map(|ring| ring.len() as u64).sum()];
    TileSection::put((SectionLayer::Areas, tile), store, counts, |id| {
        encode_areas(id, splitting.frame, splitting.step(id.z()), areas)
    })
}
