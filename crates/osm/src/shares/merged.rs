//! The records of several shares as one list.

use std::{cmp::Reverse, collections::BinaryHeap, io};

use super::blocks::{BlockReader, BlockRecord};

/// The records of all shares in ascending order of ids. Records with the same id are in the order
/// of age, then in the order of the shares, which is the order of the file.
pub(crate) struct Merged<'a, T: BlockRecord> {
    readers: Vec<BlockReader<'a, T>>,
    /// Returns the id of a record, and the age of its extract: among records with the same id,
    /// smaller ages come first.
    place: fn(&T) -> (i64, u32),
    /// The next record of each share.
    heads: Vec<Option<T>>,
    /// The id and age of each of these records, and its share.
    places: BinaryHeap<Reverse<(i64, u32, usize)>>,
    /// The error that occurred while the record after the last one delivered was read.
    failed: Option<io::Error>,
}

impl<'a, T: BlockRecord> Merged<'a, T> {
    /// Merges the records of one reader per share, in the order of the shares.
    pub(crate) fn new(readers: Vec<BlockReader<'a, T>>, place: fn(&T) -> (i64, u32)) -> Self {
        let heads = readers.iter().map(|_| None).collect();
        let places = BinaryHeap::with_capacity(readers.len());
        let mut merged = Self { readers, place, heads, places, failed: None };
        (0..merged.readers.len()).for_each(|share| merged.refill(share));
        merged
    }

    /// Reads the next record of a share.
    fn refill(&mut self, share: usize) {
        match self.readers[share].next() {
            Some(Ok(record)) => {
                let (id, age) = (self.place)(&record);
                self.places.push(Reverse((id, age, share)));
                self.heads[share] = Some(record);
            }
            Some(Err(error)) => self.failed = Some(error),
            None => {}
        }
    }
}

impl<T: BlockRecord> Iterator for Merged<'_, T> {
    type Item = io::Result<T>;

    fn next(&mut self) -> Option<io::Result<T>> {
        if let Some(error) = self.failed.take() {
            self.places.clear();
            return Some(Err(error));
        }
        let Reverse((_, _, share)) = self.places.pop()?;
        let record = self.heads[share].take()?;
        self.refill(share);
        Some(Ok(record))
    }
}
