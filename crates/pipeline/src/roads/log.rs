//! Roads as read, kept in storage, and which of them meet which tile of which level.

use std::{cmp::Reverse, collections::BinaryHeap};

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{Form, FunctionalRoadClass, Oneway, Road, RoadAttributes, Structure};
use corniche_tileset::pmtiles_order;

use crate::{BuildError, Storage, storage::Kind, storage::Span};

/// All roads of a run, by ordinal: the order in which they were read, which is that of their way ids.
pub(crate) struct RoadLog<'a> {
    storage: &'a dyn Storage,
    spans: Vec<Span>,
}

impl<'a> RoadLog<'a> {
    pub(crate) fn new(storage: &'a dyn Storage) -> Self {
        Self { storage, spans: Vec::new() }
    }

    pub(crate) fn len(&self) -> usize {
        self.spans.len()
    }

    /// Keeps `road` and says its ordinal.
    pub(crate) fn push(&mut self, road: &Road) -> Result<u32, BuildError> {
        let ordinal = self.spans.len() as u32;
        self.spans
            .push(self.storage.append(Kind::Roads, &to_bytes(road)).map_err(BuildError::Storage)?);
        Ok(ordinal)
    }

    /// Reads a road back.
    pub(crate) fn load(&self, ordinal: u32) -> Result<Road, BuildError> {
        let damaged = || BuildError::Damaged { what: format!("road {ordinal}") };
        let span = *self.spans.get(ordinal as usize).ok_or_else(damaged)?;
        let bytes = self.storage.read(Kind::Roads, span).map_err(BuildError::Storage)?;
        from_bytes(&bytes).ok_or_else(damaged)
    }
}

/// Pairs of tile and road, gathered in any order, given back tile by tile in package order.
///
/// An external merge sort: sorted runs of bounded size go to storage, so memory does not grow with the extract.
pub(crate) struct RoadTiles<'a> {
    storage: &'a dyn Storage,
    run_length: usize,
    pairs: Vec<(u64, u32)>,
    runs: Vec<Span>,
}

/// Bytes of a pair in storage.
const PAIR_BYTES: u64 = 12;
/// Pairs of a run that are read at once while merging.
const PAGE_PAIRS: u64 = 4096;

impl<'a> RoadTiles<'a> {
    /// Keeps at most about `memory_bytes` in memory.
    pub(crate) fn new(storage: &'a dyn Storage, memory_bytes: u64) -> Self {
        let run_length = (memory_bytes as usize / size_of::<(u64, u32)>()).max(PAGE_PAIRS as usize);
        Self { storage, run_length, pairs: Vec::new(), runs: Vec::new() }
    }

    /// Notes that the road meets the tile.
    pub(crate) fn push(&mut self, id: TileId, ordinal: u32) -> Result<(), BuildError> {
        self.pairs.push((pmtiles_order(id), ordinal));
        if self.pairs.len() >= self.run_length { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> Result<(), BuildError> {
        self.pairs.sort_unstable();
        let bytes: Vec<u8> = self
            .pairs
            .drain(..)
            .flat_map(|(tile, ordinal)| {
                let mut pair = [0; PAIR_BYTES as usize];
                pair[..8].copy_from_slice(&tile.to_le_bytes());
                pair[8..].copy_from_slice(&ordinal.to_le_bytes());
                pair
            })
            .collect();
        if !bytes.is_empty() {
            self.runs
                .push(self.storage.append(Kind::RoadTiles, &bytes).map_err(BuildError::Storage)?);
        }
        Ok(())
    }

    /// No more pairs come: gives them back in order.
    pub(crate) fn finish(mut self) -> Result<RoadTileCursor<'a>, BuildError> {
        self.flush()?;
        let mut cursor =
            RoadTileCursor { storage: self.storage, runs: Vec::new(), heads: BinaryHeap::new() };
        for span in self.runs {
            cursor.runs.push(Run { span, read: 0, page: Vec::new() });
            cursor.refill(cursor.runs.len() - 1)?;
        }
        Ok(cursor)
    }
}

/// A sorted run that is being merged.
struct Run {
    span: Span,
    /// Bytes read so far.
    read: u64,
    /// What was read and not yet given, last first.
    page: Vec<(u64, u32)>,
}

/// Gives the roads of tiles that are asked for in package order.
pub(crate) struct RoadTileCursor<'a> {
    storage: &'a dyn Storage,
    runs: Vec<Run>,
    /// Smallest pair of each run: tile, road, run.
    heads: BinaryHeap<Reverse<(u64, u32, usize)>>,
}

impl RoadTileCursor<'_> {
    /// Ordinals of the roads that meet the tile, ascending. Tiles must be asked for in package order; those
    /// left out are skipped.
    pub(crate) fn roads_of(&mut self, id: TileId) -> Result<Vec<u32>, BuildError> {
        let wanted = pmtiles_order(id);
        let mut roads = Vec::new();
        while let Some(&Reverse((tile, ordinal, run))) = self.heads.peek() {
            if tile > wanted {
                break;
            }
            if tile == wanted && roads.last() != Some(&ordinal) {
                roads.push(ordinal);
            }
            self.heads.pop();
            self.refill(run)?;
        }
        Ok(roads)
    }

    fn refill(&mut self, index: usize) -> Result<(), BuildError> {
        let run = &mut self.runs[index];
        if run.page.is_empty() {
            let bytes = self
                .storage
                .read(Kind::RoadTiles, run.span.part(run.read, PAGE_PAIRS * PAIR_BYTES))
                .map_err(BuildError::Storage)?;
            run.read += bytes.len() as u64;
            run.page.extend(bytes.chunks_exact(PAIR_BYTES as usize).rev().map(|b| {
                let tile = u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
                (tile, u32::from_le_bytes([b[8], b[9], b[10], b[11]]))
            }));
        }
        if let Some((tile, ordinal)) = run.page.pop() {
            self.heads.push(Reverse((tile, ordinal, index)));
        }
        Ok(())
    }
}

/// Little-endian fields in order, texts and lists after their lengths. Only this process reads it back.
fn to_bytes(road: &Road) -> Vec<u8> {
    let Road { way_id, class, attributes, line, fixed } = road;
    let mut bytes = Vec::with_capacity(64 + line.points().len() * 20);
    bytes.extend(way_id.to_le_bytes());
    bytes.extend([
        class.number(),
        attributes.form as u8,
        attributes.structure as u8,
        attributes.layer.cast_unsigned(),
        attributes.oneway as u8,
    ]);
    for text in [&attributes.name, &attributes.reference, &attributes.surface] {
        bytes.extend((text.len() as u32).to_le_bytes());
        bytes.extend(text.as_bytes());
    }
    bytes.extend((line.points().len() as u32).to_le_bytes());
    for point in line.points() {
        bytes.extend(point.u.to_le_bytes());
        bytes.extend(point.v.to_le_bytes());
    }
    bytes.extend((fixed.len() as u32).to_le_bytes());
    bytes.extend(fixed.iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

fn from_bytes(bytes: &[u8]) -> Option<Road> {
    let mut rest = bytes;
    let mut take = |count: usize| {
        let (head, tail) = rest.split_at_checked(count)?;
        rest = tail;
        Some(head)
    };
    let way_id = i64::from_le_bytes(take(8)?.try_into().ok()?);
    let &[class, form, structure, layer, oneway] = take(5)? else { return None };
    let mut texts = [const { String::new() }; 3];
    for text in &mut texts {
        let length = u32::from_le_bytes(take(4)?.try_into().ok()?);
        *text = String::from_utf8(take(length as usize)?.to_vec()).ok()?;
    }
    let count = u32::from_le_bytes(take(4)?.try_into().ok()?) as usize;
    let coordinate = |bytes: &[u8]| Some(i64::from_le_bytes(bytes.try_into().ok()?));
    let points = take(count.checked_mul(16)?)?
        .chunks_exact(16)
        .map(|b| Some(LatticePoint::new(coordinate(&b[..8])?, coordinate(&b[8..])?)))
        .collect::<Option<Vec<_>>>()?;
    let count = u32::from_le_bytes(take(4)?.try_into().ok()?) as usize;
    let fixed = take(count.checked_mul(4)?)?
        .chunks_exact(4)
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    let [name, reference, surface] = texts;
    let attributes = RoadAttributes {
        form: [Form::Ordinary, Form::DualCarriageway, Form::Link, Form::Roundabout]
            .into_iter()
            .find(|&known| known as u8 == form)?,
        structure: [Structure::Ground, Structure::Bridge, Structure::Tunnel]
            .into_iter()
            .find(|&known| known as u8 == structure)?,
        layer: layer.cast_signed(),
        oneway: [Oneway::No, Oneway::Forward, Oneway::Backward]
            .into_iter()
            .find(|&known| known as u8 == oneway)?,
        name,
        reference,
        surface,
    };
    Some(Road {
        way_id,
        class: FunctionalRoadClass::new(class)?,
        attributes,
        line: Polyline::new(points).ok()?,
        fixed,
    })
}

#[cfg(test)]
#[path = "log_tests.rs"]
mod tests;
