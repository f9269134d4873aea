//! Reads the boundaries of the extract and keeps, for each tile of each level, the section with what comes near it.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;
use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_osm::{Boundary, ReadOsmError, ReadRequest, read_boundaries};
use corniche_store::{Artifacts, Groups, SortRecord, Sorter};
use corniche_tileset::{BoundaryRecord, encode_boundaries, pmtiles_order};
use serde::{Deserialize, Serialize};

use super::{sections::TileBoundaries, split::BoundarySplitting, totals::BoundaryTotals};
use crate::{
    BuildError, Defect, Observer,
    artifacts::{Kind, damaged, tile_of},
    true_lengths::TrueLengths,
};

/// Keeps the sections of all tiles and last the totals. `on_defect` is told what is wrong, in an order that depends on the extract alone.
pub(crate) fn partition(
    request: &ReadRequest<'_>,
    (splitting, lengths): (&BoundarySplitting<'_>, &TrueLengths<'_>),
    store: &dyn Artifacts,
    observer: &dyn Observer,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<Result<(), ReadOsmError>, BuildError> {
    // The reader keeps a third of its memory while it hands out lines.
    let mut parts = Sorter::new(request.scratch, request.memory_bytes / 3 * 2);
    let mut lengths_um: BTreeMap<BoundaryClass, u64> = BTreeMap::new();
    // The reader's sink cannot fail; the first failure is kept and everything after it ignored.
    let mut failed = None;
    let mut sink = |boundary: Boundary| {
        if failed.is_some() {
            return;
        }
        let Ok(line) = Polyline::new(boundary.points.clone()) else { return };
        *lengths_um.entry(boundary.class).or_default() +=
            lengths.segments_um(&line).iter().sum::<u64>();
        for (number, (id, record)) in (0..).zip(splitting.split(&boundary)) {
            let record = BoundaryPartRecord::of(id, number, &record);
            if let Err(error) = parts.push(record) {
                failed = Some(BuildError::Storage(error));
                return;
            }
        }
    };
    let should_stop = || observer.is_cancelled();
    let mut defect = |defect| on_defect(Defect::from(defect));
    let read = read_boundaries(request, &mut sink, &mut defect, &should_stop);
    let summary = match read {
        Ok(summary) => summary,
        Err(error) => return Ok(Err(error)),
    };
    if let Some(error) = failed {
        return Err(error);
    }
    put_sections(parts, splitting, store, observer)?;
    BoundaryTotals::of(&summary, &lengths_um).put(store)?;
    Ok(Ok(()))
}

/// The part of a boundary on its way to its tile. Parts of a tile are sorted by class and way; those of one way by where they begin, so that
/// their order depends on what they are alone.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct BoundaryPartRecord {
    /// The tile's place in the order of the package.
    tile: u64,
    class: u8,
    way_id: i64,
    first: LatticePoint,
    number: u64,
    bytes: Vec<u8>,
}

#[derive(Serialize, Deserialize)]
struct StoredPart {
    class: u8,
    way_id: i64,
    number: u64,
    points: Vec<LatticePoint>,
}

impl BoundaryPartRecord {
    fn of(id: TileId, number: u64, record: &BoundaryRecord) -> Self {
        let stored = StoredPart {
            class: record.class.number(),
            way_id: record.way_id,
            number,
            points: record.points.clone(),
        };
        // Writing to a list cannot fail, and all of it can be written.
        let written = bincode::serde::encode_to_vec(&stored, bincode::config::standard());
        debug_assert!(written.is_ok(), "{}", record.way_id);
        Self {
            tile: pmtiles_order(id),
            class: stored.class,
            way_id: stored.way_id,
            first: record.points[0],
            number,
            bytes: written.unwrap_or_default(),
        }
    }

    fn stored(bytes: &[u8]) -> Option<StoredPart> {
        let read = bincode::serde::decode_from_slice(bytes, bincode::config::standard());
        read.ok().map(|(stored, _)| stored)
    }

    fn record(&self) -> Option<BoundaryRecord> {
        let StoredPart { class, way_id, points, .. } = Self::stored(&self.bytes)?;
        Some(BoundaryRecord { way_id, class: BoundaryClass::from_number(class)?, points })
    }
}

impl SortRecord for BoundaryPartRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.tile.to_le_bytes());
        bytes.extend((self.bytes.len() as u64).to_le_bytes());
        bytes.extend(&self.bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let mut number = || -> Option<u64> {
            let (number, rest) = bytes.split_first_chunk()?;
            *bytes = rest;
            Some(u64::from_le_bytes(*number))
        };
        let (tile, length) = (number()?, number()?);
        let (part, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
        *bytes = rest;
        let StoredPart { class, way_id, number, points } = Self::stored(part)?;
        let first = *points.first()?;
        Some(Self { tile, class, way_id, first, number, bytes: part.to_vec() })
    }

    fn extra_bytes(&self) -> usize {
        self.bytes.capacity()
    }
}

/// Puts one section for each tile, in the order of the package.
fn put_sections(
    parts: Sorter<'_, BoundaryPartRecord>,
    splitting: &BoundarySplitting<'_>,
    store: &dyn Artifacts,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let mut tiles = Groups::of(parts.finish().map_err(BuildError::Storage)?);
    while let Some(records) = tiles.next_by(|record| record.tile).map_err(BuildError::Storage)? {
        observer.check()?;
        let tile = records[0].tile;
        let no_part =
            || damaged(Kind::BoundarySection.item(tile), &"what was read back is no boundary");
        let parts: Result<Vec<_>, _> =
            records.into_iter().map(|record| record.record().ok_or_else(no_part)).collect();
        put_section(tile, &parts?, splitting, store)?;
    }
    Ok(())
}

fn put_section(
    tile: u64,
    boundaries: &[BoundaryRecord],
    splitting: &BoundarySplitting<'_>,
    store: &dyn Artifacts,
) -> Result<(), BuildError> {
    let id: TileId = tile_of(Kind::BoundarySection.item(tile))?;
    let Some(section) = encode_boundaries(id, splitting.step(id.z()), boundaries)? else {
        return Ok(());
    };
    let kept = TileBoundaries {
        section: section.into_bytes(),
        parts: boundaries.len() as u64,
        points: boundaries.iter().map(|boundary| boundary.points.len() as u64).sum(),
    };
    kept.put(store, id)
}
