//! Where each artifact is, in 24 bytes and little more.

use std::{collections::BTreeMap, mem};

use crate::Key;

/// Where an artifact is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Location {
    /// Which file it is in, below [`PART_LIMIT`].
    pub(crate) part: u32,
    /// Bytes before it, below [`OFFSET_LIMIT`].
    pub(crate) offset: u64,
    /// Bytes of it.
    pub(crate) length: u32,
    /// Its CRC-32.
    pub(crate) crc: u32,
}

/// Offsets are below this: 16 TiB.
pub(crate) const OFFSET_LIMIT: u64 = 1 << OFFSET_BITS;
/// Numbers of parts are below this, a million.
pub(crate) const PART_LIMIT: u32 = 1 << (u64::BITS - OFFSET_BITS);
/// How many of the 64 bits of a place are the offset; the others are the part's number.
const OFFSET_BITS: u32 = 44;

/// Where the artifacts of all kinds are.
///
/// Per kind a sorted list, and a small map of what was added out of order since; the map is merged into the list when it holds
/// a sixteenth of it. So an artifact takes 24 to 30 bytes, and adding one moves some 16 entries on average.
#[derive(Debug, Default)]
pub(crate) struct Index {
    kinds: Vec<OneKind>,
}

#[derive(Debug, Default)]
struct OneKind {
    sorted: Vec<Entry>,
    recent: BTreeMap<u64, Entry>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    item: u64,
    /// Offset in the low [`OFFSET_BITS`], part in the others.
    place: u64,
    length: u32,
    crc: u32,
}

/// The map holds at least this many before it is merged.
const FEWEST_RECENT: usize = 256;

impl Index {
    /// Adds an artifact. `false`, and nothing changes, if there is one under this key.
    pub(crate) fn insert(&mut self, key: Key, place: Location) -> bool {
        let kind = usize::from(key.kind);
        if kind >= self.kinds.len() {
            self.kinds.resize_with(kind + 1, OneKind::default);
        }
        self.kinds[kind].insert(Entry {
            item: key.item,
            place: place.offset | u64::from(place.part) << OFFSET_BITS,
            length: place.length,
            crc: place.crc,
        })
    }

    pub(crate) fn get(&self, key: Key) -> Option<Location> {
        Some(self.kinds.get(usize::from(key.kind))?.get(key.item)?.place())
    }

    /// The items of a kind, ascending.
    pub(crate) fn items(&self, kind: u8) -> Vec<u64> {
        let kind = self.kinds.get(usize::from(kind));
        kind.map_or_else(Vec::new, |kind| kind.entries().map(|entry| entry.item).collect())
    }

    /// All artifacts, by key.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Key, Location)> {
        self.kinds.iter().enumerate().flat_map(|(number, kind)| {
            kind.entries()
                .map(move |entry| (Key { kind: number as u8, item: entry.item }, entry.place()))
        })
    }
}

impl Entry {
    fn place(self) -> Location {
        Location {
            part: (self.place >> OFFSET_BITS) as u32,
            offset: self.place & (OFFSET_LIMIT - 1),
            length: self.length,
            crc: self.crc,
        }
    }
}

impl OneKind {
    fn insert(&mut self, entry: Entry) -> bool {
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

    /// Makes room in steps of an eighth: doubling would take up to twice the memory.
    fn reserve(&mut self, more: usize) {
        if self.sorted.capacity() - self.sorted.len() < more {
            self.sorted.reserve_exact(more.max(self.sorted.len() / 8).max(16));
        }
    }

    /// Merges the map into the list from behind, so that no second list is needed.
    fn merge(&mut self) {
        let recent = mem::take(&mut self.recent);
        let (mut read, mut write) = (self.sorted.len(), self.sorted.len() + recent.len());
        self.reserve(recent.len());
        self.sorted.resize(write, Entry { item: 0, place: 0, length: 0, crc: 0 });
        for (item, entry) in recent.into_iter().rev() {
            while read > 0 && self.sorted[read - 1].item > item {
                (read, write) = (read - 1, write - 1);
                self.sorted[write] = self.sorted[read];
            }
            write -= 1;
            self.sorted[write] = entry;
        }
    }

    fn get(&self, item: u64) -> Option<Entry> {
        match self.sorted.binary_search_by_key(&item, |entry| entry.item) {
            Ok(at) => Some(self.sorted[at]),
            Err(_) => self.recent.get(&item).copied(),
        }
    }

    /// The entries by item.
    fn entries(&self) -> impl Iterator<Item = Entry> {
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
