//! An iterator over records with a lookahead of one record.

use std::io;

/// An iterator over records with a lookahead of one record.
pub(crate) struct Ahead<I: Iterator> {
    records: I,
    next: Option<I::Item>,
}

impl<T, I: Iterator<Item = io::Result<T>>> Ahead<I> {
    pub(crate) fn new(records: I) -> Self {
        Self { records, next: None }
    }

    /// Returns the next record without consuming it; `None` after the last one.
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

    /// Skips the record that `peek` returned.
    pub(crate) fn take(&mut self) {
        self.next = None;
    }

    /// Takes the record that `peek` returned; `None` if there is none.
    pub(crate) fn take_next(&mut self) -> Option<T> {
        self.next.take().and_then(Result::ok)
    }
}
