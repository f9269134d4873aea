//! Sorted records that belong to one object are taken together.

use std::io;

use crate::{SortRecord, Sorted};

/// Takes together what follows each other in sorted records and belongs to one object.
pub struct Groups<'a, R: SortRecord> {
    sorted: Sorted<'a, R>,
    next: Option<R>,
}

impl<'a, R: SortRecord> Groups<'a, R> {
    /// The groups of sorted records.
    #[must_use]
    pub const fn of(sorted: Sorted<'a, R>) -> Self {
        Self { sorted, next: None }
    }

    /// All records of the next object, in their order; `None` after the last.
    ///
    /// # Errors
    /// When what was sorted cannot be read back.
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
