//! Artifacts and scratch space in memory, for tests and for small work.

use std::{
    collections::BTreeMap,
    io,
    sync::{Mutex, PoisonError},
};

use crate::{Artifacts, Key, Scratch, Span, StoreError};

/// Artifacts in memory.
#[derive(Debug, Default)]
pub struct MemoryStore {
    artifacts: Mutex<BTreeMap<Key, Vec<u8>>>,
}

impl Artifacts for MemoryStore {
    fn put(&self, key: Key, bytes: &[u8]) -> Result<(), StoreError> {
        let mut artifacts = self.artifacts.lock().unwrap_or_else(PoisonError::into_inner);
        artifacts.entry(key).or_insert_with(|| bytes.to_vec());
        Ok(())
    }

    fn get(&self, key: Key) -> Result<Option<Vec<u8>>, StoreError> {
        Ok(self.artifacts.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned())
    }

    fn has(&self, key: Key) -> bool {
        self.artifacts.lock().unwrap_or_else(PoisonError::into_inner).contains_key(&key)
    }

    fn items(&self, kind: u8) -> Vec<u64> {
        let artifacts = self.artifacts.lock().unwrap_or_else(PoisonError::into_inner);
        let all = Key { kind, item: 0 }..=Key { kind, item: u64::MAX };
        artifacts.range(all).map(|(key, _)| key.item).collect()
    }
}

/// Scratch space in memory.
#[derive(Debug, Default)]
pub struct MemoryScratch {
    bytes: Mutex<Vec<u8>>,
}

impl Scratch for MemoryScratch {
    fn append(&self, bytes: &[u8]) -> io::Result<Span> {
        let mut all = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let offset = all.len() as u64;
        all.extend(bytes);
        Ok(Span { offset, length: bytes.len() as u64 })
    }

    fn read(&self, span: Span) -> io::Result<Vec<u8>> {
        let all = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        let from = usize::try_from(span.offset).unwrap_or(usize::MAX);
        let to = from.saturating_add(usize::try_from(span.length).unwrap_or(usize::MAX));
        all.get(from..to).map(<[u8]>::to_vec).ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }
}
