//! Which tiles have many SV roads at their end, so that who draws by GEO need not fetch these bytes.

use std::{cmp::Reverse, collections::BTreeSet};

use corniche_geom::{TileId, TileIdError};
use serde::{Deserialize, Serialize};

use crate::tile_order::{pmtiles_order, tile_of_order};

/// SV roads of fewer bytes are not worth a list: neighbouring tiles are fetched as one range over gaps of this size.
pub(crate) const LEAST_TAIL_BYTES: u32 = 4096;
/// The list is read before the first tile, so it stays small: some 6 kB compressed.
pub(crate) const MOST_TAILS: usize = 1000;

/// A tile whose payload ends with many SV roads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "[u32; 4]", try_from = "[u32; 4]")]
pub struct SvTail {
    /// The tile.
    pub tile: TileId,
    /// How many bytes at the end of its payload are the SV roads section.
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
        // A level beyond the last number is no level either.
        let tile = TileId::new(u8::try_from(z).unwrap_or(u8::MAX), x, y)?;
        Ok(Self { tile, bytes })
    }
}

/// Collects the list for a manifest, from the SV roads of all tiles in any order.
#[derive(Debug, Clone, Default)]
pub struct SvTails {
    /// The smallest first; of tiles with the same bytes, the one that comes last in a package.
    largest: BTreeSet<(u32, Reverse<u64>)>,
}

impl SvTails {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a tile whose payload ends with so many bytes of SV roads; 0 without any.
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

    /// The tiles that have most, in the order of tiles in a package.
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
