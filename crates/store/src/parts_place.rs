//! Places of sealed parts: folders, or other places. The store needs few operations of a place, so
//! object storage can be one.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use crate::{StoreError, StoredPlan};

/// Sealed parts that belong to one plan. A part never changes, and exists as a whole or not at all.
pub trait PartsPlace: fmt::Debug + Send + Sync {
    /// The name of the place: its folder, or its address.
    fn name(&self) -> &Path;

    /// Returns the plan to which the place is bound; `None` if it is not bound. Changes nothing.
    ///
    /// # Errors
    /// When the place contains something else, is damaged, or cannot be read.
    fn stored_plan(&self) -> Result<Option<StoredPlan>, StoreError>;

    /// Returns the file names of its sealed parts (`NAME.DIGEST.part`), in ascending order.
    ///
    /// # Errors
    /// When the place cannot be listed.
    fn parts(&self) -> Result<Vec<String>, StoreError>;

    /// Opens a part that [`Self::parts`] listed.
    ///
    /// # Errors
    /// When the part does not exist any more or cannot be read.
    fn open(&self, file_name: &str) -> Result<Box<dyn PartFile>, StoreError>;
}

/// A place to which sealed parts can be sent.
pub trait Publish: PartsPlace {
    /// Binds the place to a plan, unless it is bound already. If two processes do so at once, one
    /// of them comes first. Returns the plan to which the place is bound now; if it is another
    /// plan, nothing was changed.
    ///
    /// # Errors
    /// When the place contains something else, or cannot be written.
    fn bind(&self, plan: &StoredPlan) -> Result<StoredPlan, StoreError>;

    /// Sends a sealed part from a file; returns its new location. If the same part already exists,
    /// nothing is sent. If sending is interrupted, the place holds the whole part or nothing of it.
    /// Fails when `should_stop` returns true.
    ///
    /// # Errors
    /// When the file cannot be read or the place cannot be written.
    fn publish(&self, sealed: &Path, should_stop: &dyn Fn() -> bool)
    -> Result<PathBuf, StoreError>;
}

/// A sealed part that is open for reading. Many threads may use it at once.
pub trait PartFile: fmt::Debug + Send + Sync {
    /// The name of the part: its path, or its address.
    fn path(&self) -> &Path;

    /// Returns the length of the part in bytes.
    ///
    /// # Errors
    /// When the length cannot be determined.
    fn length(&self) -> Result<u64, StoreError>;

    /// Reads the bytes at `offset`.
    ///
    /// # Errors
    /// When the part is too short, has changed, or cannot be read.
    fn read_exact_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError>;

    /// Reads bytes whose neighbours are unlikely to be requested: a cache does not read ahead.
    ///
    /// # Errors
    /// Same as [`Self::read_exact_at`].
    fn read_alone_at(&self, bytes: &mut [u8], offset: u64) -> Result<(), StoreError> {
        self.read_exact_at(bytes, offset)
    }
}
