//! Artifacts in memory, for tests and for small work.

use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
};

use crate::{Artifacts, Key, StoreError};

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
