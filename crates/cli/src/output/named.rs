//! A file that a library writes by name, in a temporary folder next to its target, and that is
//! moved there when it is complete.
//!
//! ```text
//!   .NAME.unfinished        the claim of the target (corniche_store::Claim)
//!   .NAME.ID.unfinished/    the files of the library: the output, and temporary files next to it
//! ```

use std::path::{Path, PathBuf};

use corniche_store::UnfinishedFolder;

use super::{Existing, claim, leftovers, not_begun, not_placed};
use crate::failure::Result;

/// A file that a library writes at [`NamedOutput::path`].
#[derive(Debug)]
pub(crate) struct NamedOutput {
    existing: Existing,
    folder: UnfinishedFolder,
    name: String,
}

impl NamedOutput {
    /// Creates the folder. `name` is the name of the file in it. An unwritable target is reported
    /// here, before any work is done.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        name: String,
        others: &[&Path],
    ) -> Result<Self> {
        let claim = claim(named, existing, others)?;
        leftovers::tell(claim.target());
        let folder = claim.begin_folder().map_err(|error| not_begun(named, &error))?;
        Ok(Self { existing, folder, name })
    }

    /// The path for the library.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path().join(&self.name)
    }

    /// Syncs the file to disk and moves it to its target; returns its size in bytes.
    pub(crate) fn place(self) -> Result<u64> {
        let target = self.folder.claim().target().to_path_buf();
        let placed = self.folder.place_file(&self.name, self.existing);
        placed.map_err(|error| not_placed(&target, &error))
    }
}
