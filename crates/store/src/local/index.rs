//! The location of each artifact, in little more than 24 bytes.

use std::{collections::BTreeMap, mem};

use crate::ArtifactKey;

/// The location of an artifact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ArtifactLocation {
    /// The number of its file, below [`PART_LIMIT`].
    pub part: u32,
    /// The offset of its first byte, below [`OFFSET_LIMIT`].
    pub offset: u64,
    /// Its number of bytes.
    pub length: u32,
    /// Its CRC-32.
    pub crc: u32,
}

/// The limit of offsets: 16 TiB.
pub(crate) const OFFSET_LIMIT: u64 = 1 << OFFSET_BITS;
/// The limit of the numbers of parts, about a million.
pub(crate) const PART_LIMIT: u32 = 1 << (u64::BITS - OFFSET_BITS);
/// The number of bits of a location that hold the offset, of 64; the others hold the part's number.
const OFFSET_BITS: u32 = 44;

/// The locations of the artifacts of all kinds.
///
/// Each kind has a sorted list, and a small map of artifacts that were added out of order; the map
/// is merged into the list when it holds a sixteenth of it. So an artifact takes 24 to 30 bytes,
/// and adding one moves about 16 entries on average.
#[derive(Debug, Default)]
pub(crate) struct Index {
    kinds: Vec<OneKind>,
}

#[derive(Debug, Default)]
struct OneKind {
    sorted: Vec<IndexEntry>,
    recent: BTreeMap<u64, IndexEntry>,
}

#[derive(Debug, Clone, Copy)]
struct IndexEntry {
    item: u64,
    /// The offset in the low [`OFFSET_BITS`] bits, the part in the others.
    place: u64,
    length: u32,
    crc: u32,
}

/// The smallest number of artifacts in the map before it is merged.
const FEWEST_RECENT: usize = 256;

impl Index {
    /// Adds an artifact. Returns `false`, and changes nothing, if the key already exists.
    pub(crate) fn insert(&mut self, key: ArtifactKey, place: ArtifactLocation) -> bool {
        let kind = usize::from(key.kind);
        if kind >= self.kinds.len() {
            self.kinds.resize_with(kind + 1, OneKind::default);
        }
        self.kinds[kind].insert(IndexEntry {
            item: key.item,
            place: place.offset | u64::from(place.part) << OFFSET_BITS,
            length: place.length,
            crc: place.crc,
        })
    }

    pub(crate) fn get(&self, key: ArtifactKey) -> Option<ArtifactLocation> {
        Some(self.kinds.get(usize::from(key.kind))?.get(key.item)?.place())
    }

    /// Returns the items of a kind, in ascending order.
    pub(crate) fn items(&self, kind: u8) -> Vec<u64> {
        let kind = self.kinds.get(usize::from(kind));
        kind.map_or_else(Vec::new, |kind| kind.entries().map(|entry| entry.item).collect())
    }

    /// Iterates over all artifacts, by key.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (ArtifactKey, ArtifactLocation)> {
        self.kinds.iter().enumerate().flat_map(|(number, kind)| {
            kind.entries().map(move |entry| {
                (ArtifactKey { kind: number as u8, item: entry.item }, entry.place())
            })
        })
    }
}

impl IndexEntry {
    fn place(self) -> ArtifactLocation {
        ArtifactLocation {
            part: (self.place >> OFFSET_BITS) as u32,
            offset: self.place & (OFFSET_LIMIT - 1),
            length: self.length,
            crc: self.crc,
        }
    }
}

impl OneKind {
    fn insert(&mut self, entry: IndexEntry) -> bool {
        let follows = self.sorted.last().is_none_or(|last| last.item < entry.item);
        if follows && self.recent.is_empty() {
            self.reserve(1);
            self.sorted.push(entry);
            return true;
        }
        if self.get(entry.item).is_some() {
            return false;
        }
        self.recent.insert(entry.item, entry);
        if self.recent.len() >= FEWEST_RECENT.max(self.sorted.len() / 16) {
            self.merge();
        }
        true
    }

    /// Reserves memory in steps of an eighth: doubling would take up to twice the memory.
    fn reserve(&mut self, more: usize) {
        if self.sorted.capacity() - self.sorted.len() < more {
            self.sorted.reserve_exact(more.max(self.sorted.len() / 8).max(16));
        }
    }

    /// Merges the map into the list from the end, so that no second list is needed.
    fn merge(&mut self) {
        let recent = mem::take(&mut self.recent);
        let (mut read, mut write) = (self.sorted.len(), self.sorted.len() + recent.len());
        self.reserve(recent.len());
        self.sorted.resize(write, IndexEntry { item: 0, place: 0, length: 0, crc: 0 });
        for (item, entry) in recent.into_iter().rev() {
            while read > 0 && self.sorted[read - 1].item > item {
                (read, write) = (read - 1, write - 1);
                self.sorted[write] = self.sorted[read];
            }
            write -= 1;
            self.sorted[write] = entry;
        }
    }

    fn get(&self, item: u64) -> Option<IndexEntry> {
        match self.sorted.binary_search_by_key(&item, |entry| entry.item) {
            Ok(at) => Some(self.sorted[at]),
            Err(_) => self.recent.get(&item).copied(),
        }
    }

    /// Iterates over the entries by item.
    fn entries(&self) -> impl Iterator<Item = IndexEntry> {
        let mut sorted = self.sorted.iter().copied().peekable();
        let mut recent = self.recent.values().copied().peekable();
        std::iter::from_fn(move || match (sorted.peek(), recent.peek()) {
            (Some(old), Some(new)) if new.item < old.item => recent.next(),
            (Some(_), _) => sorted.next(),
            (None, _) => recent.next(),
        })
    }
}

#[cfg(test)]
#[path = "index_tests.rs"]
mod tests;
