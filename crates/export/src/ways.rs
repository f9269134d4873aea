use std::io;

use corniche_store::Sorted;

use crate::piece::{Piece, SortedPiece};

/// The pieces of one way after the other.
pub(crate) struct Ways<'a> {
    sorted: Sorted<'a, SortedPiece>,
    /// The first piece of the next way.
    next: Option<Piece>,
}

impl<'a> Ways<'a> {
    pub(crate) fn new(sorted: Sorted<'a, SortedPiece>) -> Self {
        Self { sorted, next: None }
    }

    /// All pieces of the next way, in the order of their keys; `None` after the last way.
    pub(crate) fn next_way(&mut self) -> io::Result<Option<Vec<Piece>>> {
        let first = match self.next.take() {
            Some(first) => first,
            None => match self.sorted.next().transpose()? {
                Some(SortedPiece(first)) => first,
                None => return Ok(None),
            },
        };
        let way_id = first.key.way_id;
        let mut pieces = vec![first];
        while let Some(SortedPiece(piece)) = self.sorted.next().transpose()? {
            if piece.key.way_id != way_id {
                self.next = Some(piece);
                break;
            }
            pieces.push(piece);
        }
        Ok(Some(pieces))
    }
}
