//! Records of several shares as one list.

use std::{
    cmp::{Ordering, Reverse},
    collections::BinaryHeap,
    io,
};

use super::blocks::{BlockReader, BlockRecord};

/// What is sorted by the id of a way or a node.
pub(crate) trait HasId {
    fn id(&self) -> i64;

    /// How old the record's extract is: among records with the same id, the smaller ones come first.
    fn age(&self) -> u32 {
        0
    }
}

/// The records of all shares in ascending order of id; those with the same id by age, then in the order of the shares, which is that of the file.
pub(crate) struct Merged<'a, T: BlockRecord> {
    readers: Vec<BlockReader<'a, T>>,
    heads: BinaryHeap<Reverse<Head<T>>>,
    /// What went wrong while the record after the last one handed out was read.
    failed: Option<io::Error>,
}

impl<'a, T: BlockRecord + HasId> Merged<'a, T> {
    /// Merges the records of one reader for each share, in the order of the shares.
    pub(crate) fn new(readers: Vec<BlockReader<'a, T>>) -> Self {
        let mut merged =
            Self { heads: BinaryHeap::with_capacity(readers.len()), readers, failed: None };
        (0..merged.readers.len()).for_each(|share| merged.refill(share));
        merged
    }

    /// Reads the next record of a share.
    fn refill(&mut self, share: usize) {
        match self.readers[share].next() {
            Some(Ok(record)) => {
                let place = (record.id(), record.age(), share);
                self.heads.push(Reverse(Head { place, record }));
            }
            Some(Err(error)) => self.failed = Some(error),
            None => {}
        }
    }
}

impl<T: BlockRecord + HasId> Iterator for Merged<'_, T> {
    type Item = io::Result<T>;

    fn next(&mut self) -> Option<io::Result<T>> {
        if let Some(error) = self.failed.take() {
            self.heads.clear();
            return Some(Err(error));
        }
        let Reverse(Head { place: (_, _, share), record }) = self.heads.pop()?;
        self.refill(share);
        Some(Ok(record))
    }
}

/// The next record of a share.
struct Head<T> {
    /// Id, age and share.
    place: (i64, u32, usize),
    record: T,
}

impl<T> PartialEq for Head<T> {
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

impl<T> Eq for Head<T> {}

impl<T> PartialOrd for Head<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Head<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.place.cmp(&other.place)
    }
}
