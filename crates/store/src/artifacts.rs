//! Artifacts: immutable bytes by key, and the interface of the stores that hold them.

use crate::StoreError;

/// The name of an artifact. Keys sort by kind first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ArtifactKey {
    /// The kind of the artifact; the caller defines the kinds.
    pub kind: u8,
    /// The number of the artifact within its kind: a tile, a partition, an ordinal.
    pub item: u64,
}

/// A store of immutable artifacts by key.
///
/// The key, and the plan to which the store is bound, determine the bytes of an artifact. So it
/// does not matter who computed it, or how often.
pub trait Artifacts: Send + Sync {
    /// Stores `bytes` under `key`. If the key already exists, nothing changes.
    ///
    /// # Errors
    /// When there is no space or the device fails.
    fn put(&self, key: ArtifactKey, bytes: &[u8]) -> Result<(), StoreError>;

    /// Returns the artifact under `key` after verifying its checksum; `None` if there is none.
    ///
    /// # Errors
    /// When the device fails, or the bytes are not those that were stored.
    fn get(&self, key: ArtifactKey) -> Result<Option<Vec<u8>>, StoreError>;

    /// Returns the number of bytes under `key`; `None` if there is no artifact. The bytes need not
    /// be read for this.
    ///
    /// # Errors
    /// Same as [`Self::get`], if the implementation calls it.
    fn length(&self, key: ArtifactKey) -> Result<Option<u64>, StoreError> {
        Ok(self.get(key)?.map(|bytes| bytes.len() as u64))
    }

    /// Whether there is an artifact under `key`.
    fn has(&self, key: ArtifactKey) -> bool;

    /// Returns the existing items of a kind, in ascending order.
    fn items(&self, kind: u8) -> Vec<u64>;
}
