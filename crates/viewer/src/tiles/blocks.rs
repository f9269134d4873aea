//! Long lists of a tile as blocks of bytes. A page takes decoded tiles from its workers: read element by element, a town would take longer than a frame.

use std::{fmt, marker::PhantomData};

use bytemuck::Pod;
use serde::{
    Deserializer, Serializer,
    de::{Error, Visitor},
};

/// What stands in a block as words of fixed length.
pub(crate) trait Recorded: Sized {
    /// Its words.
    type Words: Pod;

    /// All of it, as words.
    fn words(&self) -> Self::Words;

    /// What has these words; `None` if nothing has.
    fn of_words(words: &Self::Words) -> Option<Self>;
}

/// Lists of plain values.
pub(crate) mod plain {
    use super::{Block, Deserializer, Pod, Serializer};

    pub(crate) fn serialize<T: Pod, S: Serializer>(
        list: &[T],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(bytemuck::cast_slice(list))
    }

    pub(crate) fn deserialize<'de, T: Pod, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<T>, D::Error> {
        deserializer.deserialize_byte_buf(Block::new())
    }
}

/// Lists of what is [`Recorded`].
pub(crate) mod records {
    use super::{Deserializer, Recorded, Records, Serializer, plain};

    pub(crate) fn serialize<T: Recorded, S: Serializer>(
        list: &[T],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let words: Vec<T::Words> = list.iter().map(T::words).collect();
        plain::serialize(&words, serializer)
    }

    pub(crate) fn deserialize<'de, T: Recorded, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<T>, D::Error> {
        deserializer.deserialize_byte_buf(Records::new())
    }
}

/// Lists of indices: how many starts there are, the starts, the indices.
pub(crate) mod index_lists {
    use corniche_geom::IndexLists;

    use super::{Deserializer, Error, Serializer, plain};

    pub(crate) fn serialize<S: Serializer>(
        lists: &IndexLists,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let [starts, indices] = lists.parts();
        plain::serialize(&[&[starts.len() as u32], starts, indices].concat(), serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<IndexLists, D::Error> {
        let words: Vec<u32> = plain::deserialize(deserializer)?;
        let lists = words.split_first().and_then(|(count, rest)| {
            let (starts, indices) = rest.split_at_checked(*count as usize)?;
            IndexLists::of_parts(starts.to_vec(), indices.to_vec())
        });
        lists.ok_or_else(|| D::Error::custom("no lists of indices"))
    }
}

/// Reads a block of plain values.
struct Block<T>(PhantomData<T>);

impl<T> Block<T> {
    fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T: Pod> Visitor<'_> for Block<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "values of {} bytes each", size_of::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        // Bytes that lie where such values may lie are copied at once.
        Ok(match bytemuck::try_cast_slice(bytes) {
            Ok(list) => list.to_vec(),
            Err(_) => bytemuck::pod_collect_to_vec(bytes),
        })
    }
}

/// Reads a block of records.
struct Records<T>(PhantomData<T>);

impl<T> Records<T> {
    fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T: Recorded> Visitor<'_> for Records<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "records of {} bytes each", size_of::<T::Words>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        let length = size_of::<T::Words>();
        if !bytes.len().is_multiple_of(length) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        let mut list = Vec::with_capacity(bytes.len() / length);
        for record in bytes.chunks_exact(length) {
            let words = bytemuck::pod_read_unaligned(record);
            list.push(T::of_words(&words).ok_or_else(|| E::custom("a record of nothing"))?);
        }
        Ok(list)
    }
}
