//! Artifacts: immutable bytes by key, and the interface of what keeps them.

use crate::StoreError;

/// The name of an artifact. Keys sort by kind first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key {
    /// What the artifact holds; the list of kinds is the caller's.
    pub kind: u8,
    /// Which one of its kind: a tile, a partition, an ordinal.
    pub item: u64,
}

/// Immutable artifacts by key.
///
/// What is stored under a key is decided by the key and by what the store is bound to (a plan), so it does not matter who made it,
/// or how often.
pub trait Artifacts: Send + Sync {
    /// Keeps `bytes` under `key`. If the key is there already, nothing changes.
    ///
    /// # Errors
    /// When there is no room or the device fails.
    fn put(&self, key: Key, bytes: &[u8]) -> Result<(), StoreError>;

    /// What is kept under `key`, its checksum compared; `None` if there is nothing.
    ///
    /// # Errors
    /// When the device fails, or the bytes are not those that were kept.
    fn get(&self, key: Key) -> Result<Option<Vec<u8>>, StoreError>;

    /// How many bytes are kept under `key`; `None` if there is nothing. They need not be read for it.
    ///
    /// # Errors
    /// As [`Self::get`], where it is made with that.
    fn length(&self, key: Key) -> Result<Option<u64>, StoreError> {
        Ok(self.get(key)?.map(|bytes| bytes.len() as u64))
    }

    /// Whether there is something under `key`.
    fn has(&self, key: Key) -> bool;

    /// The items of a kind that are there, ascending.
    fn items(&self, kind: u8) -> Vec<u64>;
}
