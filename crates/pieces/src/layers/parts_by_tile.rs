//! Parts of a layer's objects on their way to their tiles.

use corniche_geom::TileId;
use corniche_spec::Observer;
use corniche_store::{Scratch, SortRecord, Sorter, append_record, take_record};
use corniche_tileset::pmtiles_order;
use serde::{Serialize, de::DeserializeOwned};

use crate::ExtractError;

/// The order of the parts of a tile. No two parts of a tile have the same.
pub(crate) trait PartKey: Ord + Send + Serialize + DeserializeOwned {}

impl<K: Ord + Send + Serialize + DeserializeOwned> PartKey for K {}

/// Sorts parts by tile, and within a tile by their keys; what does not fit in memory goes to scratch space.
pub(crate) struct PartsByTile<'a, K: PartKey>(Sorter<'a, ObjectPart<K>>);

impl<'a, K: PartKey> PartsByTile<'a, K> {
    /// `memory_bytes` is all that there is for the extract.
    pub(crate) fn new(scratch: &'a dyn Scratch, memory_bytes: u64) -> Self {
        // The reader keeps a third of it while it hands out roads.
        Self(Sorter::new(scratch, memory_bytes / 3 * 2))
    }

    pub(crate) fn push(&mut self, id: TileId, key: K, bytes: Vec<u8>) -> Result<(), ExtractError> {
        let part = ObjectPart { tile: pmtiles_order(id), key, bytes };
        self.0.push(part).map_err(ExtractError::Storage)
    }

    /// Gathers the parts of each tile with `add`, in their order, and hands what they make to `put`, in the order of the package.
    pub(crate) fn for_each_tile<T: Default>(
        self,
        observer: &dyn Observer,
        mut add: impl FnMut(&mut T, u64, K, Vec<u8>) -> Result<(), ExtractError>,
        mut put: impl FnMut(u64, T) -> Result<(), ExtractError>,
    ) -> Result<(), ExtractError> {
        let mut put = |(tile, parts): (u64, T)| {
            observer.check()?;
            put(tile, parts)
        };
        let mut current: Option<(u64, T)> = None;
        for part in self.0.finish().map_err(ExtractError::Storage)? {
            let ObjectPart { tile, key, bytes } = part.map_err(ExtractError::Storage)?;
            if let Some(done) = current.take_if(|(own, _)| *own != tile) {
                put(done)?;
            }
            let (_, own) = current.get_or_insert_with(|| (tile, T::default()));
            add(own, tile, key, bytes)?;
        }
        current.map_or(Ok(()), put)
    }
}

/// A part, encoded.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct ObjectPart<K> {
    /// The tile's place in the order of the package.
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
