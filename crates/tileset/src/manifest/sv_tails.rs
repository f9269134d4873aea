//! The list of tiles that end with many bytes of SV roads, so that readers that draw by GEO need
//! not read these bytes.

use std::{cmp::Reverse, collections::BTreeSet};

use corniche_geom::{TileId, TileIdError};
use serde::{Deserialize, Serialize};

use crate::tile_order::{pmtiles_order, tile_of_order};

/// SV roads with fewer bytes are not listed: neighbouring tiles are read as one range across gaps
/// of this size.
pub(crate) const LEAST_TAIL_BYTES: u32 = 4096;
/// The list is read before the first tile, so it stays small: about 6 kB compressed.
pub(crate) const MOST_TAILS: usize = 1000;

/// A tile whose payload ends with many bytes of SV roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "[u32; 4]", try_from = "[u32; 4]")]
pub struct SvTail {
    /// The tile.
    pub tile: TileId,
    /// Number of bytes of the SV roads section at the end of the payload.
    pub bytes: u32,
}

impl From<SvTail> for [u32; 4] {
    fn from(SvTail { tile, bytes }: SvTail) -> Self {
        [u32::from(tile.z()), tile.x(), tile.y(), bytes]
    }
}

impl TryFrom<[u32; 4]> for SvTail {
    type Error = TileIdError;

    fn try_from([z, x, y, bytes]: [u32; 4]) -> Result<Self, TileIdError> {
        // A level beyond 255 is invalid, too.
        let tile = TileId::new(u8::try_from(z).unwrap_or(u8::MAX), x, y)?;
        Ok(Self { tile, bytes })
    }
}

/// Collects the list for a manifest from the SV roads of all tiles, in any order.
#[derive(Debug, Clone, Default)]
pub struct SvTails {
    /// The smallest sections first; of sections of equal size, the tile that is last in a package.
    largest: BTreeSet<(u32, Reverse<u64>)>,
}

impl SvTails {
    /// Returns a collection without tiles.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a tile with the number of bytes of SV roads at the end of its payload; 0 if there are
    /// none.
    pub fn add(&mut self, tile: TileId, bytes: u64) {
        let Some(bytes) = u32::try_from(bytes).ok().filter(|&bytes| bytes >= LEAST_TAIL_BYTES)
        else {
            return;
        };
        self.largest.insert((bytes, Reverse(pmtiles_order(tile))));
        if self.largest.len() > MOST_TAILS {
            self.largest.pop_first();
        }
    }

    /// The tiles with the largest sections, in the order of tiles in a package.
    #[must_use]
    pub fn list(&self) -> Vec<SvTail> {
        let mut tails: Vec<SvTail> = (self.largest.iter())
            .filter_map(|&(bytes, Reverse(order))| {
                tile_of_order(order).map(|tile| SvTail { tile, bytes })
            })
            .collect();
        tails.sort_by_key(|tail| pmtiles_order(tail.tile));
        tails
    }
}

#[cfg(test)]
#[path = "sv_tails_tests.rs"]
mod tests;
