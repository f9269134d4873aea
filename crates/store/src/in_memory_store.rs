//! Artifacts in memory, for tests and for small work.

use std::{collections::BTreeMap, sync::Mutex};

use corniche_work::locked;

use crate::{ArtifactKey, Artifacts, StoreError};

/// Artifacts in memory.
#[derive(Debug, Default)]
pub struct MemoryStore {
    artifacts: Mutex<BTreeMap<ArtifactKey, Vec<u8>>>,
}

impl Artifacts for MemoryStore {
    fn put(&self, key: ArtifactKey, bytes: &[u8]) -> Result<(), StoreError> {
        locked(&self.artifacts).entry(key).or_insert_with(|| bytes.to_vec());
        Ok(())
    }

    fn get(&self, key: ArtifactKey) -> Result<Option<Vec<u8>>, StoreError> {
        Ok(locked(&self.artifacts).get(&key).cloned())
    }

    fn has(&self, key: ArtifactKey) -> bool {
        locked(&self.artifacts).contains_key(&key)
    }

    fn items(&self, kind: u8) -> Vec<u64> {
        let artifacts = locked(&self.artifacts);
        let all = ArtifactKey { kind, item: 0 }..=ArtifactKey { kind, item: u64::MAX };
        artifacts.range(all).map(|(key, _)| key.item).collect()
    }
}
