use std::io;

use crate::Scratch;

/// A record that can be sorted outside memory. Records that compare equal come back in any order, so they must be the same.
pub trait SortRecord: Ord + Sized + Send {
    /// Appends the record's bytes.
    fn encode(&self, bytes: &mut Vec<u8>);

    /// Takes a record from the front of `bytes`; `None` where they hold none.
    fn decode(bytes: &mut &[u8]) -> Option<Self>;

    /// The memory that it takes, bytes, beside its own size: that of its lists and texts.
    fn extra_bytes(&self) -> usize {
        0
    }
}

/// Sorts records. What does not fit in memory goes to scratch space in sorted runs, which are merged at the end.
pub struct Sorter<'a, T> {
    scratch: &'a dyn Scratch,
    memory_bytes: u64,
    records: Vec<T>,
}

impl<'a, T: SortRecord> Sorter<'a, T> {
    /// Keeps at most about `memory_bytes` in memory.
    pub fn new(scratch: &'a dyn Scratch, memory_bytes: u64) -> Self {
        Self { scratch, memory_bytes, records: Vec::new() }
    }

    /// Adds a record.
    ///
    /// # Errors
    /// When the scratch space fails.
    pub fn push(&mut self, record: T) -> io::Result<()> {
        let _ = (self.scratch, self.memory_bytes);
        self.records.push(record);
        Ok(())
    }

    /// Ends the adding.
    ///
    /// # Errors
    /// When the scratch space fails.
    pub fn finish(mut self) -> io::Result<Sorted<'a, T>> {
        self.records.sort_unstable();
        Ok(Sorted { scratch: self.scratch, records: self.records.into_iter() })
    }
}

/// Records in ascending order.
pub struct Sorted<'a, T> {
    #[expect(dead_code, reason = "runs follow")]
    scratch: &'a dyn Scratch,
    records: std::vec::IntoIter<T>,
}

impl<T: SortRecord> Iterator for Sorted<'_, T> {
    type Item = io::Result<T>;

    fn next(&mut self) -> Option<Self::Item> {
        self.records.next().map(Ok)
    }
}
