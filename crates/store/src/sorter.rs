//! Sorting more records than fit in memory.
//!
//! Source: Knuth 1998, *The Art of Computer Programming*, volume 3, section 5.4 (external sorting):
//! sorted runs, which are merged, in several passes if there are too many runs.

use std::{
    cmp::Reverse,
    collections::{BinaryHeap, VecDeque},
    io, mem,
};

use corniche_varints::{push_varint, take_number};
use serde::{Serialize, de::DeserializeOwned};

use crate::{ScratchRange, ScratchSpace, append_record, take_record};

/// A record that can be sorted outside memory. Records that compare equal are returned in any
/// order, so they must be equal.
pub trait SortRecord: Ord + Sized + Send {
    /// Appends the record's bytes.
    fn encode(&self, bytes: &mut Vec<u8>);

    /// Takes a record from the front of `bytes`; `None` if there is no record. `bytes` never end
    /// within a record.
    fn decode(bytes: &mut &[u8]) -> Option<Self>;

    /// The memory in bytes that the record takes in addition to its own size: its lists and texts.
    fn extra_bytes(&self) -> usize {
        0
    }
}

/// A record that can be sorted and that serde converts to bytes.
pub trait SerdeRecord: Ord + Send + Serialize + DeserializeOwned {
    /// See [`SortRecord::extra_bytes`].
    fn extra_bytes(&self) -> usize {
        0
    }
}

impl<T: SerdeRecord> SortRecord for T {
    fn encode(&self, bytes: &mut Vec<u8>) {
        append_record(bytes, self);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        take_record(bytes)
    }

    fn extra_bytes(&self) -> usize {
        SerdeRecord::extra_bytes(self)
    }
}

/// The largest number of runs that are merged at once: with more runs, pages become so short that
/// reading is mostly seeking.
const RUNS_AT_ONCE: usize = 64;
/// The largest length of pages: longer ones save no seeks.
const LONGEST_PAGE: usize = 1 << 20;
/// The smallest length of pages, unless the memory is too small for two of them.
const SHORTEST_PAGE: usize = 4096;

/// Sorts records. Records that do not fit in memory go to scratch space in sorted runs, which are
/// merged at the end.
pub struct Sorter<'a, T> {
    scratch: &'a dyn ScratchSpace,
    memory_bytes: usize,
    records: Vec<T>,
    extra_bytes: usize,
    runs: VecDeque<Run>,
    sort: Sort<'a, T>,
}

/// Sorts the records in memory.
type Sort<'a, T> = Box<dyn Fn(&mut [T]) + 'a>;

impl<'a, T: SortRecord> Sorter<'a, T> {
    /// Creates a sorter that keeps at most about `memory_bytes` in memory; a single record may be
    /// larger.
    pub fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        let memory_bytes = usize::try_from(memory_bytes).unwrap_or(usize::MAX);
        let sort = Box::new(|records: &mut [T]| records.sort_unstable());
        let (records, runs) = (Vec::new(), VecDeque::new());
        Self { scratch, memory_bytes, records, extra_bytes: 0, runs, sort }
    }

    /// Sorts records in memory with `sort`, for example in several threads. It must sort in place.
    #[must_use]
    pub fn sorted_by(self, sort: impl Fn(&mut [T]) + 'a) -> Self {
        Self { sort: Box::new(sort), ..self }
    }

    /// Adds a record.
    ///
    /// # Errors
    /// When the scratch space fails.
    pub fn push(&mut self, record: T) -> io::Result<()> {
        let extra_bytes = record.extra_bytes();
        let limit = self.memory_bytes - page_bytes(self.memory_bytes, 8);
        let taken = (self.records.len() + 1).saturating_mul(size_of::<T>().max(1));
        if taken.saturating_add(self.extra_bytes).saturating_add(extra_bytes) > limit
            && !self.records.is_empty()
        {
            self.spill()?;
        }
        self.grow(limit);
        self.extra_bytes += extra_bytes;
        self.records.push(record);
        Ok(())
    }

    /// Reserves memory for a record. Doubling, as `Vec` does it, would take up to twice the limit.
    fn grow(&mut self, limit: usize) {
        let length = self.records.len();
        if length == self.records.capacity() {
            let most = (limit / size_of::<T>().max(1)).saturating_sub(length);
            self.records.reserve_exact(length.max(64).min(most).max(1));
        }
    }

    /// Writes the records in memory as a run.
    fn spill(&mut self) -> io::Result<()> {
        (self.sort)(&mut self.records);
        let mut writer = RunWriter::new(self.scratch, page_bytes(self.memory_bytes, 8));
        // The next run gets a new list: the used memory pages of this one would remain in addition
        // to the content of the next records.
        for record in mem::take(&mut self.records) {
            writer.push(&record)?;
        }
        self.extra_bytes = 0;
        self.runs.push_back(writer.finish()?);
        Ok(())
    }

    /// Ends the adding of records.
    ///
    /// # Errors
    /// When the scratch space fails.
    pub fn finish(mut self) -> io::Result<Sorted<'a, T>> {
        if self.runs.is_empty() {
            (self.sort)(&mut self.records);
            return Ok(Sorted(Source::Memory(self.records.into_iter())));
        }
        if !self.records.is_empty() {
            self.spill()?;
        }
        let most = (self.memory_bytes / SHORTEST_PAGE).saturating_sub(1).clamp(2, RUNS_AT_ONCE);
        while self.runs.len() > most {
            // The oldest runs are the shortest; merge as many as needed, so that the last merge is
            // a full one.
            let count = (self.runs.len() - most + 1).min(most);
            let runs = self.runs.drain(..count).collect();
            let page = page_bytes(self.memory_bytes, count + 1);
            let mut writer = RunWriter::new(self.scratch, page);
            for record in Merge::<T>::new(self.scratch, runs, page)? {
                writer.push(&record?)?;
            }
            self.runs.push_back(writer.finish()?);
        }
        let page = page_bytes(self.memory_bytes, self.runs.len());
        Ok(Sorted(Source::Merge(Merge::new(self.scratch, self.runs.into(), page)?)))
    }
}

/// The length of a page if `pages` of them share the memory.
fn page_bytes(memory_bytes: usize, pages: usize) -> usize {
    (memory_bytes / pages.max(1)).clamp(SHORTEST_PAGE.min(memory_bytes / 2), LONGEST_PAGE)
}

/// Records in ascending order.
pub struct Sorted<'a, T>(Source<'a, T>);

enum Source<'a, T> {
    Memory(std::vec::IntoIter<T>),
    Merge(Merge<'a, T>),
}

impl<T: SortRecord> Iterator for Sorted<'_, T> {
    type Item = io::Result<T>;

    fn next(&mut self) -> Option<Self::Item> {
        match &mut self.0 {
            Source::Memory(records) => records.next().map(Ok),
            Source::Merge(merge) => merge.next(),
        }
    }
}

/// A sorted run: the locations of its pages. Each record has its length before it; a record may
/// continue in the next page.
#[derive(Debug, Default)]
struct Run {
    pages: Vec<ScratchRange>,
}

/// Writes a run.
struct RunWriter<'a> {
    scratch: &'a dyn ScratchSpace,
    page_bytes: usize,
    page: Vec<u8>,
    record: Vec<u8>,
    run: Run,
}

impl<'a> RunWriter<'a> {
    fn new(scratch: &'a dyn ScratchSpace, page_bytes: usize) -> Self {
        let page = Vec::with_capacity(page_bytes);
        Self { scratch, page_bytes, page, record: Vec::new(), run: Run::default() }
    }

    fn push<T: SortRecord>(&mut self, record: &T) -> io::Result<()> {
        self.record.clear();
        record.encode(&mut self.record);
        if self.page.len() + self.record.len() + LONGEST_LENGTH > self.page_bytes {
            self.write_page()?;
        }
        push_varint(&mut self.page, self.record.len() as u64);
        self.page.extend(&self.record);
        Ok(())
    }

    fn write_page(&mut self) -> io::Result<()> {
        if !self.page.is_empty() {
            self.run.pages.push(self.scratch.append(&self.page)?);
            self.page.clear();
        }
        Ok(())
    }

    fn finish(mut self) -> io::Result<Run> {
        self.write_page()?;
        Ok(self.run)
    }
}

/// Reads a run with a buffer of one page, which may be shorter than the pages in which the run was
/// written.
struct RunReader<'a> {
    scratch: &'a dyn ScratchSpace,
    page_bytes: u64,
    pages: std::vec::IntoIter<ScratchRange>,
    /// The rest of the current page that has not been read yet.
    rest: ScratchRange,
    buffer: Vec<u8>,
    used: usize,
}

impl<'a> RunReader<'a> {
    fn new(scratch: &'a dyn ScratchSpace, run: Run, page_bytes: usize) -> Self {
        Self {
            scratch,
            page_bytes: page_bytes.max(1) as u64,
            pages: run.pages.into_iter(),
            rest: ScratchRange { offset: 0, length: 0 },
            buffer: Vec::new(),
            used: 0,
        }
    }

    fn next<T: SortRecord>(&mut self) -> io::Result<Option<T>> {
        loop {
            let mut unread = &self.buffer[self.used..];
            let start = unread.len();
            if let Some(length) = take_number::<usize>(&mut unread)
                && let Some(mut record) = unread.get(..length)
            {
                let decoded = T::decode(&mut record).filter(|_| record.is_empty());
                self.used += start - unread.len() + length;
                return decoded.map(Some).ok_or_else(|| broken("a record cannot be decoded"));
            }
            if !self.read_more()? {
                return if start == 0 {
                    Ok(None)
                } else {
                    Err(broken("a run ends within a record"))
                };
            }
        }
    }

    /// Reads the next bytes after the unread ones; `false` at the end of the run.
    fn read_more(&mut self) -> io::Result<bool> {
        if self.rest.length == 0 {
            match self.pages.next() {
                Some(page) => self.rest = page,
                None => return Ok(false),
            }
        }
        let piece = self.rest.part(0, self.page_bytes);
        self.rest = self.rest.part(piece.length, u64::MAX);
        let bytes = self.scratch.read(piece)?;
        if self.used == self.buffer.len() {
            self.buffer = bytes;
        } else {
            self.buffer.drain(..self.used);
            self.buffer.extend(bytes);
        }
        self.used = 0;
        Ok(true)
    }
}

/// Merges runs.
struct Merge<'a, T> {
    readers: Vec<RunReader<'a>>,
    /// The next record of each run, with the number of the run.
    heads: BinaryHeap<Reverse<(T, usize)>>,
}

impl<'a, T: SortRecord> Merge<'a, T> {
    fn new(scratch: &'a dyn ScratchSpace, runs: Vec<Run>, page_bytes: usize) -> io::Result<Self> {
        let mut readers: Vec<_> =
            runs.into_iter().map(|run| RunReader::new(scratch, run, page_bytes)).collect();
        let mut heads = BinaryHeap::with_capacity(readers.len());
        for (number, reader) in readers.iter_mut().enumerate() {
            if let Some(record) = reader.next()? {
                heads.push(Reverse((record, number)));
            }
        }
        Ok(Self { readers, heads })
    }
}

impl<T: SortRecord> Iterator for Merge<'_, T> {
    type Item = io::Result<T>;

    /// After an error the iteration ends.
    fn next(&mut self) -> Option<Self::Item> {
        let Reverse((record, number)) = self.heads.pop()?;
        match self.readers[number].next() {
            Ok(Some(following)) => self.heads.push(Reverse((following, number))),
            Ok(None) => {}
            Err(error) => {
                self.heads.clear();
                return Some(Err(error));
            }
        }
        Some(Ok(record))
    }
}

/// The largest number of bytes of an encoded length.
const LONGEST_LENGTH: usize = 10;

fn broken(what: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidData,
        format!(
            "scratch space is damaged: {what}; run the same command again (build: with --resume)"
        ),
    )
}

/// Groups successive sorted records that belong to one object.
pub struct Groups<'a, R: SortRecord> {
    sorted: Sorted<'a, R>,
    next: Option<R>,
}

impl<'a, R: SortRecord> Groups<'a, R> {
    /// Creates the groups of sorted records.
    #[must_use]
    pub const fn from_sorted(sorted: Sorted<'a, R>) -> Self {
        Self { sorted, next: None }
    }

    /// Returns all records of the next object, in their order; `None` after the last object.
    ///
    /// # Errors
    /// When the sorted records cannot be read back.
    pub fn next_by<K: PartialEq>(
        &mut self,
        object_of: impl Fn(&R) -> K,
    ) -> io::Result<Option<Vec<R>>> {
        let first = match self.next.take() {
            Some(first) => first,
            None => match self.sorted.next().transpose()? {
                Some(first) => first,
                None => return Ok(None),
            },
        };
        let object = object_of(&first);
        let mut records = vec![first];
        while let Some(record) = self.sorted.next().transpose()? {
            if object_of(&record) != object {
                self.next = Some(record);
                break;
            }
            records.push(record);
        }
        Ok(Some(records))
    }
}

#[cfg(test)]
#[path = "sorter_tests.rs"]
mod tests;
