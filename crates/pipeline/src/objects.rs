//! Access to object storage for a run: one client for all names, within the memory that the run may
//! use.

use std::{path::Path, sync::Arc};

use corniche_objects::{
    BlockCache, Bucket, ObjectAddress, ObjectError, ObjectPlace, Storage, StorageRequests,
    StorageSettings, block_cache,
};
use corniche_spec::{Resources, memory_shares::MemoryShares};

/// Parses a name as an address; `None` for names of files.
pub(crate) fn address(name: &Path) -> Result<Option<ObjectAddress>, ObjectError> {
    match name.to_str() {
        Some(text) => ObjectAddress::parse(text),
        None => Ok(None),
    }
}

/// Whether a name begins like an address in object storage, which is not a file.
#[must_use]
pub fn is_in_object_storage(name: &Path) -> bool {
    !matches!(address(name), Ok(None))
}

/// Access to object storage, opened when it is first needed: without it, no thread is started.
pub(crate) struct ObjectAccess {
    storage: Option<Storage>,
    blocks: Arc<BlockCache>,
}

impl ObjectAccess {
    pub(crate) fn new(resources: Resources) -> Self {
        let blocks = MemoryShares::from_memory(resources.memory_bytes).blocks;
        Self { storage: None, blocks: Arc::new(block_cache(blocks)) }
    }

    /// The store at an address.
    pub(crate) fn place(&mut self, address: &ObjectAddress) -> Result<ObjectPlace, ObjectError> {
        let blocks = Arc::clone(&self.blocks);
        ObjectPlace::new(self.storage()?, address, &blocks)
    }

    pub(crate) fn bucket(&mut self, name: &str) -> Result<Bucket, ObjectError> {
        self.storage()?.bucket(name)
    }

    /// The number of requests so far; `None` if object storage is not used.
    pub(crate) fn requests(&self) -> Option<StorageRequests> {
        self.storage.as_ref().map(Storage::requests)
    }

    fn storage(&mut self) -> Result<&Storage, ObjectError> {
        let storage = match self.storage.take() {
            Some(storage) => storage,
            None => Storage::new(StorageSettings::of_environment())?,
        };
        Ok(self.storage.insert(storage))
    }
}
