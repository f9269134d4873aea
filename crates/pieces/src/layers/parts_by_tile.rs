//! Sorts the parts of a layer's objects by tile.

use corniche_geom::TileId;
use corniche_spec::BuildObserver;
use corniche_store::{
    Groups, ScratchSpace, SortRecord, Sorted, Sorter, append_record, take_record,
};
use corniche_tileset::pmtiles_order;
use serde::{Serialize, de::DeserializeOwned};

use crate::ExtractError;

/// The order of the parts of a tile. No two parts of a tile have equal keys.
pub(crate) trait PartKey: Ord + Send + Serialize + DeserializeOwned {}

impl<K: Ord + Send + Serialize + DeserializeOwned> PartKey for K {}

/// Sorts parts by tile, and within a tile by their keys; parts that do not fit in memory go to
/// scratch space.
pub(crate) struct PartsByTile<'a, K: PartKey>(Sorter<'a, EncodedPart<K>>);

impl<'a, K: PartKey> PartsByTile<'a, K> {
    /// Creates the sorter; `memory_bytes` is all the memory for the extract.
    pub(crate) fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        // The reader needs a third of the memory while it delivers roads.
        Self(Sorter::new(scratch, memory_bytes / 3 * 2))
    }

    pub(crate) fn push(&mut self, id: TileId, key: K, bytes: Vec<u8>) -> Result<(), ExtractError> {
        let part = EncodedPart { tile: pmtiles_order(id), key, bytes };
        Ok(self.0.push(part)?)
    }

    /// All parts, sorted.
    pub(crate) fn sorted(self) -> Result<Sorted<'a, EncodedPart<K>>, ExtractError> {
        Ok(self.0.finish()?)
    }

    /// Passes the parts of each tile to `put`, in the order of the package.
    pub(crate) fn for_each_tile(
        self,
        observer: &dyn BuildObserver,
        mut put: impl FnMut(u64, Vec<Vec<u8>>) -> Result<(), ExtractError>,
    ) -> Result<(), ExtractError> {
        let mut tiles = Groups::from_sorted(self.sorted()?);
        while let Some(parts) = tiles.next_by(|part| part.tile)? {
            observer.check()?;
            let tile = parts[0].tile;
            put(tile, parts.into_iter().map(|part| part.bytes).collect())?;
        }
        Ok(())
    }
}

/// Joins parts, each of which is dropped once it is copied.
pub(crate) fn joined_parts(parts: Vec<Vec<u8>>) -> Vec<u8> {
    let join = |mut all: Vec<u8>, part: Vec<u8>| {
        all.extend(part);
        all
    };
    parts.into_iter().reduce(join).unwrap_or_default()
}

/// An encoded part of an object.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EncodedPart<K> {
    /// The tile's position in the order of the package.
    tile: u64,
    pub key: K,
    pub bytes: Vec<u8>,
}

impl<K: PartKey> SortRecord for EncodedPart<K> {
    fn encode(&self, bytes: &mut Vec<u8>) {
        let Self { tile, key, bytes: own } = self;
        append_record(bytes, (tile, key, own.len() as u64));
        bytes.extend(own);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (tile, key, length): (u64, K, u64) = take_record(bytes)?;
        let (own, rest) = bytes.split_at_checked(usize::try_from(length).ok()?)?;
        *bytes = rest;
        Some(Self { tile, key, bytes: own.to_vec() })
    }

    fn extra_bytes(&self) -> usize {
        self.bytes.capacity()
    }
}
