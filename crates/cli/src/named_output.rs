//! A file that a library writes by its name, in a folder beside its target, from which it gets to its place when it is
//! complete.
//!
//! ```text
//!   .NAME.unfinished           empty; its lock tells whether someone writes
//!   .NAME.unfinished.files/    what the library makes: the file, and others that go with it while it is written
//! ```

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use tempfile::{NamedTempFile, TempPath};

use crate::{
    failure::Failure,
    interrupt,
    output::{Existing, exists, failed, is_same_file, writable},
};

/// A file that a library is to write at [`NamedOutput::path`].
#[derive(Debug)]
pub(crate) struct NamedOutput {
    target: PathBuf,
    existing: Existing,
    folder: PathBuf,
    name: String,
    /// Held as long as the folder is in use.
    _lock: NamedTempFile,
}

impl NamedOutput {
    /// Makes the folder. `name` is what the file is called in it. An unusable place is reported here, before any work is done.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        name: String,
        others: &[&Path],
    ) -> Result<Self, Failure> {
        let target = writable(named)?;
        let unusable = |reason: &dyn std::fmt::Display| {
            Failure::unusable(format!("cannot write {}: {reason}", named.display()))
        };
        if others.iter().any(|other| is_same_file(other, &target)) {
            return Err(unusable(&"the command uses that file itself; choose another name"));
        }
        if existing == Existing::Keep && named.symlink_metadata().is_ok() {
            return Err(exists(named));
        }
        let lock = corniche_pipeline::unfinished_file(&target).map_err(|error| unusable(&error))?;
        interrupt::remove_at_end(lock.path());
        let own_name = target.file_name().unwrap_or_default().to_string_lossy();
        let folder = target.with_file_name(format!(".{own_name}.unfinished.files"));
        // What a killed program left: the lock says that nobody writes there.
        match fs::remove_dir_all(&folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(unusable(&error)),
            _ => {}
        }
        interrupt::remove_at_end(&folder);
        fs::create_dir(&folder).map_err(|error| unusable(&error))?;
        Ok(Self { target, existing, folder, name, _lock: lock })
    }

    /// Where the library writes.
    pub(crate) fn path(&self) -> PathBuf {
        self.folder.join(&self.name)
    }

    /// Makes the file durable and puts it in its place; returns its size in bytes.
    pub(crate) fn place(self) -> Result<u64, Failure> {
        let path = self.path();
        let place = || {
            let file = fs::File::open(&path)?;
            file.sync_all()?;
            let bytes = file.metadata()?.len();
            let written = TempPath::try_from_path(&path)?;
            let placed = match self.existing {
                Existing::Keep => written.persist_noclobber(&self.target),
                Existing::Replace => written.persist(&self.target),
            };
            placed.map(|()| bytes).map_err(|refused| refused.error)
        };
        place().map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => exists(&self.target),
            _ => failed(&self.target, &error),
        })
    }
}

impl Drop for NamedOutput {
    fn drop(&mut self) {
        // What cannot be removed now is removed by the next export to this target.
        let _ = fs::remove_dir_all(&self.folder);
    }
}
