//! Sorts the parts of a layer's objects by tile.

use corniche_geom::TileId;
use corniche_spec::BuildObserver;
use corniche_store::{ScratchSpace, SortRecord, Sorter, append_record, take_record};
use corniche_tileset::pmtiles_order;
use serde::{Serialize, de::DeserializeOwned};

use crate::ExtractError;

/// The order of the parts of a tile. No two parts of a tile have equal keys.
pub(crate) trait PartKey: Ord + Send + Serialize + DeserializeOwned {}

impl<K: Ord + Send + Serialize + DeserializeOwned> PartKey for K {}

/// Sorts parts by tile, and within a tile by their keys; parts that do not fit in memory go to
/// scratch space.
pub(crate) struct PartsByTile<'a, K: PartKey>(Sorter<'a, ObjectPart<K>>);

impl<'a, K: PartKey> PartsByTile<'a, K> {
    /// Creates the sorter; `memory_bytes` is all the memory for the extract.
    pub(crate) fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        // The reader needs a third of the memory while it delivers roads.
        Self(Sorter::new(scratch, memory_bytes / 3 * 2))
    }

    pub(crate) fn push(&mut self, id: TileId, key: K, bytes: Vec<u8>) -> Result<(), ExtractError> {
        let part = ObjectPart { tile: pmtiles_order(id), key, bytes };
        Ok(self.0.push(part)?)
    }

    /// Gathers the parts of each tile with `add`, in their order, and passes the results to `put`,
    /// in the order of the package.
    pub(crate) fn for_each_tile<T: Default>(
        self,
        observer: &dyn BuildObserver,
        mut add: impl FnMut(&mut T, u64, K, Vec<u8>) -> Result<(), ExtractError>,
        mut put: impl FnMut(u64, T) -> Result<(), ExtractError>,
    ) -> Result<(), ExtractError> {
        let mut put = |(tile, parts): (u64, T)| {
            observer.check()?;
            put(tile, parts)
        };
        let mut current: Option<(u64, T)> = None;
        for part in self.0.finish()? {
            let ObjectPart { tile, key, bytes } = part?;
            if let Some(done) = current.take_if(|(own, _)| *own != tile) {
                put(done)?;
            }
            let (_, own) = current.get_or_insert_with(|| (tile, T::default()));
            add(own, tile, key, bytes)?;
        }
        current.map_or(Ok(()), put)
    }
}

/// An encoded part of an object.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct ObjectPart<K> {
    /// The tile's position in the order of the package.
    tile: u64,
    key: K,
    bytes: Vec<u8>,
}

impl<K: PartKey> SortRecord for ObjectPart<K> {
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
