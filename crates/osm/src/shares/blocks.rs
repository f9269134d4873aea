//! The records of a share in blocks of bytes; each block is an artifact.
//!
//! ```text
//!  ┌ block: record, record, … ┐┌ block ┐┌ block ┐ …      no record crosses a block's end
//! ```

use std::io;

use super::kept::{ShareStore, key};
use crate::{kept_error::KeptError, share::Share};

/// The size of a block, bytes; a block ends with the record that reaches it. It is large enough
/// that a store on a server gets few requests, and small enough that blocks of all shares fit in
/// memory. It determines the bytes of parts, so it must not depend on the memory of a process.
pub(crate) const BLOCK_BYTES: usize = 256 << 10;

/// A record that blocks can contain.
pub(crate) trait BlockRecord: Sized {
    /// The state that a record's bytes depend on, which comes from the record before it in the
    /// block.
    type Before: Default;

    /// Appends the record's bytes.
    fn write(&self, before: &mut Self::Before, bytes: &mut Vec<u8>);

    /// Takes a record from the front of `bytes`; `None` if they do not contain one.
    fn take(before: &mut Self::Before, bytes: &mut &[u8]) -> Option<Self>;
}

/// Writes the blocks of a share.
pub(crate) struct ShareBlockWriter<'a, T: BlockRecord> {
    kept: ShareStore<'a>,
    kind: u8,
    share: Share,
    blocks: u32,
    bytes: Vec<u8>,
    before: T::Before,
}

impl<'a, T: BlockRecord> ShareBlockWriter<'a, T> {
    pub(crate) fn new(kept: ShareStore<'a>, kind: u8, share: Share) -> Self {
        let (bytes, before) = (Vec::new(), T::Before::default());
        Self { kept, kind, share, blocks: 0, bytes, before }
    }

    pub(crate) fn push(&mut self, record: &T) -> Result<(), KeptError> {
        record.write(&mut self.before, &mut self.bytes);
        if self.bytes.len() < BLOCK_BYTES { Ok(()) } else { self.put() }
    }

    /// Ends the last block, and returns the number of blocks.
    pub(crate) fn finish(mut self) -> Result<u32, KeptError> {
        if !self.bytes.is_empty() {
            self.put()?;
        }
        Ok(self.blocks)
    }

    fn put(&mut self) -> Result<(), KeptError> {
        self.kept.store.put(key(self.kind, self.share, self.blocks), &self.bytes)?;
        self.blocks += 1;
        self.bytes.clear();
        self.before = T::Before::default();
        Ok(())
    }
}

/// Reads the records of a share, one block at a time. An error ends the reading.
pub(crate) struct BlockReader<'a, T: BlockRecord> {
    kept: ShareStore<'a>,
    kind: u8,
    share: Share,
    blocks: std::ops::Range<u32>,
    bytes: Vec<u8>,
    at: usize,
    before: T::Before,
}

impl<'a, T: BlockRecord> BlockReader<'a, T> {
    /// Creates a reader of `blocks` blocks.
    pub(crate) fn new(kept: ShareStore<'a>, kind: u8, share: Share, blocks: u32) -> Self {
        let (bytes, before) = (Vec::new(), T::Before::default());
        Self { kept, kind, share, blocks: 0..blocks, bytes, at: 0, before }
    }

    fn read(&mut self) -> Result<Option<T>, KeptError> {
        let damaged = |share, what| KeptError::Damaged { share, what };
        while self.at == self.bytes.len() {
            let Some(block) = self.blocks.next() else { return Ok(None) };
            let bytes = self.kept.store.get(key(self.kind, self.share, block))?;
            self.bytes =
                bytes.ok_or_else(|| damaged(self.share, "one of its blocks is missing"))?;
            (self.at, self.before) = (0, T::Before::default());
        }
        let mut rest = &self.bytes[self.at..];
        let record = T::take(&mut self.before, &mut rest);
        let record = record.ok_or_else(|| damaged(self.share, "one of its blocks is invalid"))?;
        self.at = self.bytes.len() - rest.len();
        Ok(Some(record))
    }
}

impl<T: BlockRecord> Iterator for BlockReader<'_, T> {
    type Item = io::Result<T>;

    fn next(&mut self) -> Option<io::Result<T>> {
        let read = self.read();
        if read.is_err() {
            self.blocks = 0..0;
            (self.bytes, self.at) = (Vec::new(), 0);
        }
        read.map_err(io::Error::from).transpose()
    }
}
