//! Scratch space in memory, which never fails.

use std::{
    io,
    sync::{Mutex, PoisonError},
};

use corniche_store::{ScratchRange, ScratchSpace};

/// Scratch space in memory.
#[derive(Debug, Default)]
pub struct MemoryScratch {
    bytes: Mutex<Vec<u8>>,
}

impl ScratchSpace for MemoryScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<ScratchRange> {
        let mut all = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let offset = all.len() as u64;
        all.extend(bytes);
        Ok(ScratchRange { offset, length: bytes.len() as u64 })
    }

    fn read(&self, span: ScratchRange) -> io::Result<Vec<u8>> {
        let all = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let from = usize::try_from(span.offset).unwrap_or(usize::MAX);
        let to = from.saturating_add(usize::try_from(span.length).unwrap_or(usize::MAX));
        all.get(from..to).map(<[u8]>::to_vec).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }
}
