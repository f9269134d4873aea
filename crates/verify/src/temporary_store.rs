//! The temporary store for data of `verify` that does not fit into memory.

use std::{io, sync::Arc, time::Duration};

use corniche_spec::BuildObserver;
use corniche_store::{LocalScratch, LocalStore, StoreError, StoredPlan, SystemDisk};
use tempfile::TempDir;

use super::error::{Result, VerifyError};

/// A store in a temporary folder, which is removed with the store.
pub(crate) struct TemporaryStore {
    pub store: LocalStore,
    _folder: TempDir,
}

impl TemporaryStore {
    pub(crate) fn new(observer: &dyn BuildObserver) -> Result<Self> {
        let folder = private_folder().map_err(VerifyError::Work)?;
        observer.temporary(folder.path());
        // The store is never resumed, so it belongs to no plan, and nothing has to be durable.
        let plan = StoredPlan { hash: [0; 32], bytes: Vec::new() };
        let store = LocalStore::create(Arc::new(SystemDisk), folder.path(), &plan, Duration::MAX)
            .map_err(failed)?;
        Ok(Self { store, _folder: folder })
    }

    pub(crate) fn scratch(&self) -> Result<LocalScratch> {
        self.store.scratch().map_err(failed)
    }
}

/// Creates a folder that only its owner can read.
fn private_folder() -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    builder.tempdir()
}

impl Drop for TemporaryStore {
    /// Pending writes need not reach the disk any more.
    fn drop(&mut self) {
        self.store.give_up();
    }
}

fn failed(error: StoreError) -> VerifyError {
    VerifyError::Work(error.into())
}

#[cfg(all(test, unix))]
#[path = "temporary_store_tests.rs"]
mod tests;
