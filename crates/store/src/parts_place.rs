//! Where sealed parts lie: in a folder, or elsewhere. The store needs little of such a place, so object storage can be one.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use crate::{StoreError, StoredPlan};

/// Sealed parts that belong to one plan. A part never changes, and is there as a whole or not at all.
pub trait PartsPlace: fmt::Debug + Send + Sync {
    /// What the place is called: its folder, or its address.
    fn name(&self) -> &Path;

    /// The plan that the place is bound to; `None` if it is bound to none. Changes nothing.
    ///
    /// # Errors
    /// Where the place holds something else, is damaged, or cannot be read.
    fn stored_plan(&self) -> Result<Option<StoredPlan>, StoreError>;

    /// The file names of its sealed parts (`NAME.DIGEST.part`), ascending.
    ///
    /// # Errors
    /// Where it cannot be listed.
    fn parts(&self) -> Result<Vec<String>, StoreError>;

    /// Opens a part that [`Self::parts`] named.
    ///
    /// # Errors
    /// Where it is gone or cannot be read.
    fn open(&self, file_name: &str) -> Result<Box<dyn PartFile>, StoreError>;
}

/// A place that sealed parts can be sent to.
pub trait Publish: PartsPlace {
    /// Binds the place to a plan, unless it is bound already. Of two processes that do so at once one comes first. Returns the plan that it is
    /// bound to now, which may be another: then nothing was changed.
    ///
    /// # Errors
    /// Where the place holds something else, or cannot be written.
    fn bind(&self, plan: &StoredPlan) -> Result<StoredPlan, StoreError>;

    /// Sends a sealed part that lies in a file; returns where it is then. If the same part is there already, nothing is sent. Whatever ends
    /// it early, the place holds the whole part or nothing of it. Stops with an error when `should_stop` says so.
    ///
    /// # Errors
    /// Where the file cannot be read or the place cannot be written.
    fn publish(&self, sealed: &Path, should_stop: &dyn Fn() -> bool)
    -> Result<PathBuf, StoreError>;
}

/// A sealed part that is open for reading. Many threads may use it at once.
pub trait PartFile: fmt::Debug + Send + Sync {
    /// What it is called: its path, or its address.
    fn path(&self) -> &Path;

    /// Its length, bytes.
    ///
    /// # Errors
    /// Where it cannot be looked at.
    fn length(&self) -> Result<u64, StoreError>;

    /// Reads the bytes at `offset`.
    ///
    /// # Errors
    /// Where it is too short, has changed, or cannot be read.
    fn read_exact_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError>;

    /// The same for bytes whose neighbours will hardly be asked for: a cache does not read on.
    ///
    /// # Errors
    /// As [`Self::read_exact_at`].
    fn read_alone_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.read_exact_at(bytes, offset)
    }
}
