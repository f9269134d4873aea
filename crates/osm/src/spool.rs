//! Records in the order in which they were added, to be read once from first to last.

use std::io;

use corniche_store::{ScratchRange, ScratchSpace};

/// The approximate maximum size of a page, bytes. With little memory, a page is smaller.
const MOST_PAGE_BYTES: usize = 256 << 10;

/// Writes records one after another. Records that do not fit in memory go to scratch space, in
/// pages.
///
/// ```text
///  ┌ page: records ┐┌ page ┐┌ page ┐ …  ┌ open page ┐      no record crosses a page's end
///    in memory while they fit, then in scratch space
/// ```
pub(crate) struct Spool<'a> {
    scratch: &'a dyn ScratchSpace,
    /// The memory limit without the open page, bytes.
    memory_bytes: usize,
    page_bytes: usize,
    held_bytes: usize,
    pages: Vec<Page>,
    open: Vec<u8>,
}

enum Page {
    Held(Vec<u8>),
    Kept(ScratchRange),
}

impl<'a> Spool<'a> {
    /// Creates a spool that keeps at most about `memory_bytes` in memory.
    pub(crate) fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        let memory_bytes = usize::try_from(memory_bytes).unwrap_or(usize::MAX);
        let page_bytes = (memory_bytes / 4).min(MOST_PAGE_BYTES);
        let pages = Vec::new();
        Self { scratch, memory_bytes, page_bytes, held_bytes: 0, pages, open: Vec::new() }
    }

    /// Adds one record: the bytes that `write` appends.
    pub(crate) fn push(&mut self, write: impl FnOnce(&mut Vec<u8>)) -> io::Result<()> {
        write(&mut self.open);
        if self.open.len() < self.page_bytes {
            return Ok(());
        }
        // The last record of a page extends a little beyond the page's end, so this reserve avoids
        // that the list grows.
        let room = Vec::with_capacity(self.page_bytes + self.page_bytes / 8);
        let page = std::mem::replace(&mut self.open, room);
        if self.held_bytes + page.capacity() + self.open.capacity() > self.memory_bytes {
            self.pages.push(Page::Kept(self.scratch.append(&page)?));
        } else {
            self.held_bytes += page.capacity();
            self.pages.push(Page::Held(page));
        }
        Ok(())
    }

    /// Returns a reader that starts at the first record.
    pub(crate) fn read(mut self) -> SpoolReader<'a> {
        self.pages.push(Page::Held(self.open));
        SpoolReader {
            scratch: self.scratch,
            pages: self.pages.into_iter(),
            page: Vec::new(),
            at: 0,
        }
    }
}

/// Reads the records of a [`Spool`].
pub(crate) struct SpoolReader<'a> {
    scratch: &'a dyn ScratchSpace,
    pages: std::vec::IntoIter<Page>,
    page: Vec<u8>,
    /// The position of the next record in the page.
    at: usize,
}

impl SpoolReader<'_> {
    /// Returns a reader of these records and of those of `later`.
    pub(crate) fn followed_by(mut self, later: Self) -> Self {
        self.pages = self.pages.chain(later.pages).collect::<Vec<_>>().into_iter();
        self
    }

    /// Returns the next record, which `decode` takes from the front of the bytes; `None` after the
    /// last one.
    pub(crate) fn next<T>(
        &mut self,
        decode: impl FnOnce(&mut &[u8]) -> Option<T>,
    ) -> io::Result<Option<T>> {
        while self.at == self.page.len() {
            let page = match self.pages.next() {
                Some(Page::Held(page)) => page,
                Some(Page::Kept(span)) => self.scratch.read(span)?,
                None => return Ok(None),
            };
            (self.page, self.at) = (page, 0);
        }
        let mut rest = &self.page[self.at..];
        let record = decode(&mut rest).ok_or_else(damaged)?;
        self.at = self.page.len() - rest.len();
        Ok(Some(record))
    }
}

/// Returns the error for data that differs from the data that was written.
pub(crate) fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "the data read back differs from the data written")
}

#[cfg(test)]
#[path = "spool_tests.rs"]
mod tests;
