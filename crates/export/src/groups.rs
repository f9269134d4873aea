//! Sorted pieces by the object that they belong to.

use std::io;

use corniche_store::{SortRecord, Sorted};

/// Takes together what follows each other in sorted pieces and belongs to one object.
pub(crate) struct Groups<'a, P: SortRecord> {
    sorted: Sorted<'a, P>,
    next: Option<P>,
}

impl<'a, P: SortRecord> Groups<'a, P> {
    pub(crate) const fn of(sorted: Sorted<'a, P>) -> Self {
        Self { sorted, next: None }
    }

    /// All pieces of the next object, in their order; `None` after the last.
    pub(crate) fn next_by<K: PartialEq>(
        &mut self,
        object_of: impl Fn(&P) -> K,
    ) -> io::Result<Option<Vec<P>>> {
        let first = match self.next.take() {
            Some(first) => first,
            None => match self.sorted.next().transpose()? {
                Some(first) => first,
                None => return Ok(None),
            },
        };
        let object = object_of(&first);
        let mut pieces = vec![first];
        while let Some(piece) = self.sorted.next().transpose()? {
            if object_of(&piece) != object {
                self.next = Some(piece);
                break;
            }
            pieces.push(piece);
        }
        Ok(Some(pieces))
    }
}
