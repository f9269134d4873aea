//! An iterator over records whose next record can be seen before it is taken.

use std::io;

/// Records of which the next one can be seen before it is taken.
pub(crate) struct Ahead<I: Iterator> {
    records: I,
    next: Option<I::Item>,
}

impl<T, I: Iterator<Item = io::Result<T>>> Ahead<I> {
    pub(crate) fn new(records: I) -> Self {
        Self { records, next: None }
    }

    /// The next record; `None` after the last one.
    pub(crate) fn peek(&mut self) -> io::Result<Option<&T>> {
        if self.next.is_none() {
            self.next = self.records.next();
        }
        if let Some(Err(_)) = &self.next
            && let Some(Err(error)) = self.next.take()
        {
            return Err(error);
        }
        Ok(self.next.as_ref().and_then(|next| next.as_ref().ok()))
    }

    /// Passes over the record that was seen.
    pub(crate) fn take(&mut self) {
        self.next = None;
    }

    /// The record that was seen; `None` if none was.
    pub(crate) fn take_next(&mut self) -> Option<T> {
        self.next.take().and_then(Result::ok)
    }
}
