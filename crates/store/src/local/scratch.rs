//! Scratch space in a file of a store, which is deleted when it is no longer needed.

use std::{
    io,
    sync::atomic::{AtomicU64, Ordering},
};

use crate::{PartFile as _, ScratchRange, ScratchSpace, files::OpenFile};

/// Scratch space in a file of a store, which is deleted when this value is dropped. Files of killed
/// processes are deleted when their store is opened the next time.
#[derive(Debug)]
pub struct LocalScratch {
    file: OpenFile,
    end: AtomicU64,
}

impl LocalScratch {
    /// Creates scratch space in a file that is empty and owned by this process.
    pub(crate) fn new(file: OpenFile) -> Self {
        Self { file, end: AtomicU64::new(0) }
    }
}

impl ScratchSpace for LocalScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let length = bytes.len() as u64;
        // Reserve space first, so that writers do not wait for each other's disk writes.
        let offset = self.end.fetch_add(length, Ordering::Relaxed);
        self.file.write_all_at(bytes, offset)?;
        Ok(ScratchRange { offset, length })
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        if span
            .offset
            .checked_add(span.length)
            .is_none_or(|end| end > self.end.load(Ordering::Relaxed))
        {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        let mut bytes = vec![0; span.length as usize];
        self.file.read_exact_at(&mut bytes, span.offset)?;
        Ok(bytes)
    }
}

impl Drop for LocalScratch {
    fn drop(&mut self) {
        // If the file cannot be deleted now, it is deleted when the store is opened the next time.
        let _ = self.file.files().remove(self.file.path());
    }
}
