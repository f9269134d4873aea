//! Scratch space in a file of a store, removed when it is no longer needed.

use std::{
    io,
    sync::atomic::{AtomicU64, Ordering},
};

use crate::{PartFile as _, Scratch, Span, files::OpenFile};

/// Scratch space in a file of a store, which is removed when this is dropped. What a killed process leaves is removed when its store is opened
/// the next time.
#[derive(Debug)]
pub struct LocalScratch {
    file: OpenFile,
    end: AtomicU64,
}

impl LocalScratch {
    /// Scratch space in a file that is empty and owned.
    pub(crate) fn new(file: OpenFile) -> Self {
        Self { file, end: AtomicU64::new(0) }
    }
}

impl Scratch for LocalScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<Span> {
        let length = bytes.len() as u64;
        // Reserve first, so that writers do not wait for each other's disk.
        let offset = self.end.fetch_add(length, Ordering::Relaxed);
        self.file.write_all_at(bytes, offset)?;
        Ok(Span { offset, length })
    }

    fn read(&self, span: Span) -> io::Result<Vec<u8>> {
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
        // If it cannot be removed now, it is removed when the store is opened the next time.
        let _ = self.file.files().remove(self.file.path());
    }
}
