//! Stores long lists of a tile as blocks of bytes. A web page receives decoded tiles from its
//! workers: reading the tile of a town element by element would take longer than a frame.

use std::{fmt, marker::PhantomData};

use bytemuck::{Pod, Zeroable as _};
use serde::{
    Deserializer, Serializer,
    de::{Error, Visitor},
};

/// A value that is stored in a block as words of fixed length.
pub(crate) trait Recorded: Copy + Default {
    /// The words of a value.
    type Words: Pod + AsMut<[u32]>;

    /// Passes all fields through words; `None` if the words are not valid.
    fn pass(&mut self, through: &mut Passage<'_>) -> Option<()>;

    /// Returns the value as words.
    fn words(&self) -> Self::Words {
        let mut words = Self::Words::zeroed();
        let mut piece = *self;
        let _ = piece.pass(&mut Passage::new(words.as_mut(), false));
        words
    }

    /// Returns the value with these words; `None` if they are not valid.
    fn of_words(mut words: Self::Words) -> Option<Self> {
        let mut read = Self::default();
        read.pass(&mut Passage::new(words.as_mut(), true))?;
        Some(read)
    }
}

/// Words into which fields are written, or from which they are read, one after the other. The last
/// word holds bits.
pub(crate) struct Passage<'a> {
    words: &'a mut [u32],
    is_read: bool,
    used_words: usize,
    used_bits: u32,
}

impl<'a> Passage<'a> {
    fn new(words: &'a mut [u32], is_read: bool) -> Self {
        Self { words, is_read, used_words: 0, used_bits: 0 }
    }

    /// Writes a word, or reads one.
    pub(crate) fn word(&mut self, word: u32) -> u32 {
        let place = &mut self.words[self.used_words];
        self.used_words += 1;
        if !self.is_read {
            *place = word;
        }
        *place
    }

    /// Writes or reads `count` bits of the last word.
    pub(crate) fn bits(&mut self, bits: u32, count: u32) -> u32 {
        let [.., last] = &mut *self.words else { return bits };
        if !self.is_read {
            *last |= bits << self.used_bits;
        }
        let passed = *last >> self.used_bits & ((1 << count) - 1);
        self.used_bits += count;
        passed
    }

    pub(crate) fn flags(&mut self, flags: &mut [bool]) {
        for flag in flags {
            *flag = self.bits(u32::from(*flag), 1) == 1;
        }
    }

    pub(crate) fn numbers(&mut self, numbers: &mut [f32]) {
        for number in numbers {
            *number = f32::from_bits(self.word(number.to_bits()));
        }
    }
}

/// Lists of plain values.
pub(crate) mod plain {
    use super::{Deserializer, PhantomData, Pod, Serializer, ValueBlock};

    pub(crate) fn serialize<T: Pod, S: Serializer>(
        list: &[T],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(bytemuck::cast_slice(list))
    }

    pub(crate) fn deserialize<'de, T: Pod, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<T>, D::Error> {
        deserializer.deserialize_byte_buf(ValueBlock(PhantomData))
    }
}

/// Lists of [`Recorded`] values.
pub(crate) mod records {
    use super::{Deserializer, Error, Recorded, Serializer, plain};

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
        let words: Vec<T::Words> = plain::deserialize(deserializer)?;
        let list: Option<Vec<T>> = words.into_iter().map(T::of_words).collect();
        list.ok_or_else(|| D::Error::custom("a record with invalid values"))
    }
}

/// Lists of indices: the number of starts, the starts, the indices.
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
        lists.ok_or_else(|| D::Error::custom("the lists of indices are invalid"))
    }
}

/// Reads a block of plain values.
struct ValueBlock<T>(PhantomData<T>);

impl<T: Pod> Visitor<'_> for ValueBlock<T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "values of {} bytes each", size_of::<T>())
    }

    fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<T>, E> {
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(E::invalid_length(bytes.len(), &self));
        }
        // Bytes with the alignment of the values are copied at once.
        Ok(match bytemuck::try_cast_slice(bytes) {
            Ok(list) => list.to_vec(),
            Err(_) => bytemuck::pod_collect_to_vec(bytes),
        })
    }
}
