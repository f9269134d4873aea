//! Which roads meet which tile of which level.

use std::{cmp::Reverse, collections::BinaryHeap};

use corniche_geom::TileId;
use corniche_tileset::pmtiles_order;

use crate::{BuildError, Storage, storage::Kind, storage::Span};

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

    /// Ends the gathering: the pairs can now be read back in order.
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

    /// The same for several tiles, in package order.
    pub(crate) fn lists_of(&mut self, ids: &[TileId]) -> Result<Vec<Vec<u32>>, BuildError> {
        ids.iter().map(|&id| self.roads_of(id)).collect()
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

#[cfg(test)]
#[path = "by_tile_tests.rs"]
mod tests;
