//! The interface of scratch space: bytes that only the step that wrote them reads back.

use std::io;

/// The location of bytes in scratch space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScratchRange {
    /// The offset of the first byte.
    pub offset: u64,
    /// The number of bytes.
    pub length: u64,
}

impl ScratchRange {
    /// The part of this range that starts after `from` bytes and has `length` bytes, cut at the end
    /// of the range.
    #[must_use]
    pub fn part(self, from: u64, length: u64) -> Self {
        let from = from.min(self.length);
        Self { offset: self.offset + from, length: length.min(self.length - from) }
    }
}

/// Space for bytes that are only needed by the step that wrote them: appended and read back, and
/// deleted when it is dropped.
pub trait ScratchSpace: Send + Sync {
    /// Appends `bytes`.
    ///
    /// # Errors
    /// When there is no space or the device fails.
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange>;

    /// Reads bytes that `append` wrote.
    ///
    /// # Errors
    /// When the device fails or the range was never written.
    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>>;
}
