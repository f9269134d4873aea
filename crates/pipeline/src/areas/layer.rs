//! Reads the areas of the extract and keeps, for each tile of each level, the section with what lies in it.
//!
//! ```text
//! extract ─► areas ─► parts by level and tile ─► sorted by tile and area ─► one section for each tile
//! ```

use corniche_areas::{Area, AreaClass, AreaObject, AreaTable};
use corniche_geom::{LatticePoint, TileId};
use corniche_osm::{AreaLoss, ReadOsmError, ReadRequest, read_areas};
use corniche_store::{Artifacts, Groups, SortRecord, Sorter};
use corniche_tileset::{AreaRecord, AreaRings, encode_areas, pmtiles_order};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{sea::SeaPlace, sections::TileAreas, split::AreaSplitting, totals::AreaTotals};
use crate::{
    BuildError, Defect, Observer,
    artifacts::{Kind, damaged, tile_of},
};

/// Areas and points of areas that are split at once.
const BATCH_AREAS: usize = 512;
const BATCH_POINTS: usize = 1 << 16;

/// Keeps the sections of all tiles and last the totals. `on_defect` is told what is wrong with areas, in an order that depends on
/// the extract alone.
pub(crate) fn partition(
    request: &ReadRequest<'_>,
    table: &AreaTable,
    (splitting, sea): (&AreaSplitting<'_>, &SeaPlace<'_>),
    store: &dyn Artifacts,
    observer: &dyn Observer,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<Result<(), ReadOsmError>, BuildError> {
    // The reader keeps a third of its memory while it hands out areas.
    let parts = Sorter::new(request.scratch, request.memory_bytes / 3 * 2);
    let mut gathered = Gathered {
        splitting,
        pool: request.pool,
        batch: Vec::new(),
        batch_points: 0,
        areas: 0,
        parts,
        intricate: Vec::new(),
        failed: None,
    };
    let should_stop = || observer.is_cancelled();
    let read = read_areas(
        request,
        table,
        &mut |area| gathered.add(area),
        &mut |defect| on_defect(Defect::from(defect)),
        &should_stop,
    );
    let mut summary = match read {
        Ok(summary) => summary,
        Err(error) => return Ok(Err(error)),
    };
    if let Some(sea) = sea.close(&mut summary, &mut |defect| on_defect(Defect::from(defect)))? {
        gathered.add(sea);
    }
    gathered.split_batch();
    if let Some(error) = gathered.failed {
        return Err(error);
    }
    for (object, class, area_m2) in gathered.intricate {
        if let Some(kept) = summary.kept.get_mut(&class) {
            kept.areas -= 1;
            kept.area_m2 -= area_m2;
        }
        *summary.lost.entry(AreaLoss::TooIntricate).or_default() += 1;
        let (kind, id) = object.parts();
        let (is_relation, loss) = (kind == "relation", AreaLoss::TooIntricate);
        on_defect(corniche_osm::Defect::LostArea { is_relation, id, loss }.into());
    }
    put_sections(gathered.parts, splitting, store, observer)?;
    AreaTotals::of(&summary).put(store)?;
    Ok(Ok(()))
}

/// Areas as they come in.
struct Gathered<'a> {
    splitting: &'a AreaSplitting<'a>,
    pool: &'a rayon::ThreadPool,
    batch: Vec<Area>,
    batch_points: usize,
    areas: u64,
    parts: Sorter<'a, AreaPartRecord>,
    /// Areas that could not be split, with their true area.
    intricate: Vec<(AreaObject, AreaClass, f64)>,
    /// The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    failed: Option<BuildError>,
}

impl Gathered<'_> {
    fn add(&mut self, area: Area) {
        let rings = area.polygons.iter().flat_map(corniche_areas::Polygon::rings);
        self.batch_points += rings.map(|ring| ring.points().len()).sum::<usize>();
        self.batch.push(area);
        if self.batch.len() >= BATCH_AREAS || self.batch_points >= BATCH_POINTS {
            self.split_batch();
        }
    }

    /// Splits the areas of the batch side by side, and takes them in their order.
    fn split_batch(&mut self) {
        let batch = std::mem::take(&mut self.batch);
        self.batch_points = 0;
        if self.failed.is_some() {
            return;
        }
        let splitting = self.splitting;
        let split: Vec<_> =
            self.pool.install(|| batch.par_iter().map(|area| splitting.split(area)).collect());
        for (area, parts) in batch.iter().zip(split) {
            let number = self.areas;
            self.areas += 1;
            let Ok(parts) = parts else {
                self.intricate.push((area.object, area.class, area.area_m2));
                continue;
            };
            for (id, record) in parts {
                let part = StoredArea::from(record);
                let record =
                    AreaPartRecord { tile: pmtiles_order(id), number, bytes: part.to_bytes() };
                if let Err(error) = self.parts.push(record) {
                    self.failed = Some(BuildError::Storage(error));
                    return;
                }
            }
        }
    }
}

/// The part of an area on its way to its tile. No two have the same tile and number.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct AreaPartRecord {
    /// The tile's place in the order of the package.
    tile: u64,
    number: u64,
    bytes: Vec<u8>,
}

impl SortRecord for AreaPartRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.tile.to_le_bytes());
        bytes.extend(self.number.to_le_bytes());
        bytes.extend((self.bytes.len() as u64).to_le_bytes());
        bytes.extend(&self.bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let mut number = || -> Option<u64> {
            let (number, rest) = bytes.split_first_chunk()?;
            *bytes = rest;
            Some(u64::from_le_bytes(*number))
        };
        let (tile, own, length) = (number()?, number()?, number()?);
        let (part, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
        *bytes = rest;
        Some(Self { tile, number: own, bytes: part.to_vec() })
    }

    fn extra_bytes(&self) -> usize {
        self.bytes.capacity()
    }
}

/// An area of a tile, as it is kept while it is sorted.
#[derive(Serialize, Deserialize)]
struct StoredArea {
    is_relation: bool,
    id: i64,
    class: u8,
    name: String,
    polygons: Vec<Vec<Vec<LatticePoint>>>,
}

impl From<AreaRecord> for StoredArea {
    fn from(record: AreaRecord) -> Self {
        let AreaRecord { object, class, name, polygons } = record;
        let (kind, id) = object.parts();
        Self {
            is_relation: kind == "relation",
            id,
            class: class.number(),
            name,
            polygons: polygons.into_iter().map(|polygon| polygon.rings).collect(),
        }
    }
}

impl StoredArea {
    fn to_bytes(&self) -> Vec<u8> {
        // Writing to a list cannot fail, and all of it can be written.
        let written = bincode::serde::encode_to_vec(self, bincode::config::standard());
        debug_assert!(written.is_ok(), "{}", self.id);
        written.unwrap_or_default()
    }

    fn of_bytes(bytes: &[u8]) -> Option<AreaRecord> {
        let read = bincode::serde::decode_from_slice(bytes, bincode::config::standard());
        let (Self { is_relation, id, class, name, polygons }, _) = read.ok()?;
        let polygons = polygons.into_iter().map(|rings| AreaRings { rings }).collect();
        let object = if is_relation { AreaObject::Relation(id) } else { AreaObject::Way(id) };
        Some(AreaRecord { object, class: AreaClass::from_number(class)?, name, polygons })
    }
}

/// Puts one section for each tile, in the order of the package.
fn put_sections(
    parts: Sorter<'_, AreaPartRecord>,
    splitting: &AreaSplitting<'_>,
    store: &dyn Artifacts,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let mut tiles = Groups::of(parts.finish().map_err(BuildError::Storage)?);
    while let Some(records) = tiles.next_by(|record| record.tile).map_err(BuildError::Storage)? {
        observer.check()?;
        let tile = records[0].tile;
        let no_part = || damaged(Kind::AreaSection.item(tile), &"what was read back is no area");
        let parts: Result<Vec<_>, _> = records
            .into_iter()
            .map(|record| StoredArea::of_bytes(&record.bytes).ok_or_else(no_part))
            .collect();
        put_section(tile, &parts?, splitting, store)?;
    }
    Ok(())
}

fn put_section(
    tile: u64,
    areas: &[AreaRecord],
    splitting: &AreaSplitting<'_>,
    store: &dyn Artifacts,
) -> Result<(), BuildError> {
    let id: TileId = tile_of(Kind::AreaSection.item(tile))?;
    let step = splitting.step(id.z());
    let Some(section) = encode_areas(id, splitting.frame, step, areas)? else { return Ok(()) };
    let rings = areas.iter().flat_map(|area| &area.polygons).flat_map(|part| &part.rings);
    let kept = TileAreas {
        section: section.into_bytes(),
        areas: areas.len() as u64,
        points: rings.map(|ring| ring.len() as u64).sum(),
    };
    kept.put(store, id)
}
