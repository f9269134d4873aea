//! A file that a library writes by its name, in a folder beside its target, from which it gets to its place when it is
//! complete.
//!
//! ```text
//!   .NAME.unfinished        the claim of the target (corniche_store::Claim)
//!   .NAME.ID.unfinished/    what the library makes: the file, and others that go with it while it is written
//! ```

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use corniche_export::ExportError;
use corniche_pipeline::Claim;
use tempfile::TempPath;

use crate::{
    exit::ExitCode,
    failure::Failure,
    leftovers,
    output::{Existing, claim, failed, place},
};

/// A file that a library is to write at [`NamedOutput::path`].
#[derive(Debug)]
pub(crate) struct NamedOutput {
    target: PathBuf,
    existing: Existing,
    folder: PathBuf,
    name: String,
    /// Held as long as the folder is in use.
    _claim: Claim,
}

impl NamedOutput {
    /// Makes the folder. `name` is what the file is called in it. An unusable place is reported here, before any work is done.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        name: String,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let (target, claim) = claim(named, existing, others)?;
        let unusable = |error: io::Error| {
            Failure::unusable(format!("cannot write {}: {error}", named.display()))
        };
        leftovers::tell(&target);
        let folder = claim.begin_folder().map_err(unusable)?;
        Ok(Self { target, existing, folder, name, _claim: claim })
    }

    /// Where the library writes.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder.join(&self.name)
    }

    /// Makes the file durable and puts it in its place; returns its size in bytes.
    pub(crate) fn place(self) -> Result<u64, Failure> {
        let written =
            TempPath::try_from_path(self.path()).map_err(|error| failed(&self.target, &error))?;
        place(written, &self.target, self.existing)
    }
}

impl Drop for NamedOutput {
    fn drop(&mut self) {
        // What cannot be removed now is removed by the next export to this target.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// What could not be written is known to people by the name of the target, not of the file that becomes it.
pub(crate) fn named(error: ExportError, target: &Path) -> Failure {
    let is_unwritten = !error.is_unusable_input();
    let failure = Failure::from(error);
    if is_unwritten && failure.code() == ExitCode::Failed { failure.about(target) } else { failure }
}
