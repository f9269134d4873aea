//! A file that a library writes by its name, in a folder beside its target, from which it gets to its place when it is
//! complete.
//!
//! ```text
//!   .NAME.unfinished        the claim of the target (corniche_store::Claim)
//!   .NAME.ID.unfinished/    what the library makes: the file, and others that go with it while it is written
//! ```

use std::path::{Path, PathBuf};

use corniche_store::UnfinishedFolder;

use super::{Existing, claim, leftovers, not_begun, not_placed};
use crate::failure::Failure;

/// A file that a library is to write at [`NamedOutput::path`].
#[derive(Debug)]
pub(crate) struct NamedOutput {
    existing: Existing,
    folder: UnfinishedFolder,
    name: String,
}

impl NamedOutput {
    /// Makes the folder. `name` is what the file is called in it. An unusable place is reported here, before any work is done.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        name: String,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let claim = claim(named, existing, others)?;
        leftovers::tell(claim.target());
        let folder = claim.begin_folder().map_err(|error| not_begun(named, &error))?;
        Ok(Self { existing, folder, name })
    }

    /// Where the library writes.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join(&self.name)
    }

    /// Makes the file durable and puts it in its place; returns its size in bytes.
    pub(crate) fn place(self) -> Result<u64, Failure> {
        let target = self.folder.claim().target().to_path_buf();
        let placed = self.folder.place_file(&self.name, self.existing);
        placed.map_err(|error| not_placed(&target, &error))
    }
}
