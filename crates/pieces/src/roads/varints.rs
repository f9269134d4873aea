//! Numbers and texts of variable length, put one after the other and taken again.

use corniche_varints::{push_varint, to_zigzag, varint, zigzag};

/// Appends a number that may be below 0.
pub(crate) fn put_signed(bytes: &mut Vec<u8>, number: i64) {
    push_varint(bytes, to_zigzag(number));
}

/// Appends a text, its length first.
pub(crate) fn put_text(bytes: &mut Vec<u8>, text: &str) {
    push_varint(bytes, text.len() as u64);
    bytes.extend(text.as_bytes());
}

/// Takes what was put, from the front; `None` where the bytes hold something else.
pub(crate) struct Take<'a> {
    rest: &'a [u8],
}

impl<'a> Take<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    pub(crate) fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.rest.split_at_checked(count)?;
        self.rest = tail;
        Some(head)
    }

    pub(crate) fn unsigned(&mut self) -> Option<u64> {
        varint(&mut self.rest).ok()
    }

    pub(crate) fn signed(&mut self) -> Option<i64> {
        self.unsigned().map(zigzag)
    }

    /// How many things follow that take a byte each at least: never more than there are bytes.
    pub(crate) fn count(&mut self) -> Option<usize> {
        let count = usize::try_from(self.unsigned()?).ok()?;
        (count <= self.rest.len()).then_some(count)
    }

    pub(crate) fn text(&mut self) -> Option<String> {
        let length = self.count()?;
        String::from_utf8(self.bytes(length)?.to_vec()).ok()
    }
}

#[cfg(test)]
#[path = "varints_tests.rs"]
mod tests;
