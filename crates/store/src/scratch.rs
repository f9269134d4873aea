//! The interface of scratch space: bytes that only the step that wrote them reads back.

use std::io;

/// Where something was put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// Bytes before it.
    pub offset: u64,
    /// Bytes of it.
    pub length: u64,
}

impl Span {
    /// The part of this span that starts `from` bytes in and is `length` long, cut at its end.
    #[must_use]
    pub fn part(self, from: u64, length: u64) -> Self {
        let from = from.min(self.length);
        Self { offset: self.offset + from, length: length.min(self.length - from) }
    }
}

/// Space for bytes that nobody needs after the step that wrote them: appended and read back, gone when it is dropped.
pub trait Scratch: Send + Sync {
    /// Keeps `bytes`.
    ///
    /// # Errors
    /// When there is no room or the device fails.
    fn append(&self, bytes: &[u8]) -> io::Result<Span>;

    /// Reads back what `append` kept.
    ///
    /// # Errors
    /// When the device fails or the span was never written.
    fn read(&self, span: Span) -> io::Result<Vec<u8>>;
}
