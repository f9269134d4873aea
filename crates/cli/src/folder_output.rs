//! A folder that a command writes: beside its target, from where it gets to its place as a whole when it is complete.
//!
//! ```text
//!   .NAME.unfinished           empty; its lock tells whether someone writes
//!   .NAME.unfinished.files/    what is made
//!   .NAME.replaced/            the export that was there, for as long as the new one takes its place
//! ```
//!
//! A finished folder holds a marker. Only a folder with it is ever replaced.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

use corniche_pipeline::folder_of;
use tempfile::NamedTempFile;

use crate::{
    failure::Failure,
    interrupt,
    output::{Existing, exists, failed, is_same_file},
};

/// The marker of a folder that an export wrote.
pub(crate) const MARKER: &str = "corniche-export.txt";

/// A folder to be written at [`FolderOutput::path`].
#[derive(Debug)]
pub(crate) struct FolderOutput {
    target: PathBuf,
    existing: Existing,
    folder: PathBuf,
    /// Held as long as the folder is in use.
    _lock: NamedTempFile,
}

impl FolderOutput {
    /// Makes the folder. An unusable place is reported here, before any work is done. `used` are files of the command, which a replaced folder must not
    /// hold.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        used: &[&Path],
    ) -> Result<Self, Failure> {
        let unusable = |reason: &dyn std::fmt::Display| {
            Failure::unusable(format!("cannot write {}: {reason}", named.display()))
        };
        // A link is followed, and a name that ends in a slash or in ".." becomes one that has siblings.
        let target = match named.canonicalize() {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if named.symlink_metadata().is_ok() {
                    return Err(unusable(&"it is a link that leads nowhere; remove it"));
                }
                let name = named.file_name().ok_or_else(|| unusable(&"that is no name"))?;
                let parent = folder_of(named).canonicalize();
                parent.map_err(|error| unusable(&format_args!("its folder: {error}")))?.join(name)
            }
            Err(error) => return Err(unusable(&error)),
        };
        let own_name = target.file_name().ok_or_else(|| unusable(&"that is no name"))?;
        let beside =
            |end: &str| target.with_file_name(format!(".{}.{end}", own_name.to_string_lossy()));
        let lock = corniche_pipeline::unfinished_file(&target).map_err(|error| unusable(&error))?;
        interrupt::remove_at_end(lock.path());
        put_right(&target, &beside("replaced")).map_err(|error| unusable(&error))?;
        match kind_of(&target).map_err(|error| unusable(&error))? {
            Kind::Export if existing == Existing::Keep => return Err(exists(named)),
            Kind::Free | Kind::Export => {}
            Kind::File => return Err(unusable(&"it is a file; give the name of a folder")),
            Kind::Other => {
                return Err(unusable(
                    &"it is a folder with other things in it, which are never replaced; give another name",
                ));
            }
        }
        let holds = |used: &&&Path| {
            used.canonicalize().is_ok_and(|place| place.starts_with(&target))
                || is_same_file(used, &target)
        };
        if let Some(used) = used.iter().find(holds) {
            return Err(unusable(&format_args!("{} is in it", used.display())));
        }
        let folder = beside("unfinished.files");
        // What a killed program left: the lock says that nobody writes there.
        match fs::remove_dir_all(&folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(unusable(&error)),
            _ => {}
        }
        interrupt::remove_at_end(&folder);
        fs::create_dir(&folder).map_err(|error| unusable(&error))?;
        Ok(Self { target, existing, folder, _lock: lock })
    }

    /// Where to write.
    pub(crate) fn path(&self) -> &Path {
        &self.folder
    }

    /// Adds the marker, makes all files durable and puts the folder in its place; returns its size in bytes.
    pub(crate) fn place(self, what: &str) -> Result<u64, Failure> {
        let not_written = |error: io::Error| failed(&self.target, &error);
        let version = env!("CARGO_PKG_VERSION");
        let marker = format!(
            "{what}, written by corniche {version}. corniche replaces this folder when it is asked to (-O).\n"
        );
        fs::write(self.folder.join(MARKER), marker).map_err(not_written)?;
        let bytes = sync(&self.folder).map_err(not_written)?;
        let own_name = self.target.file_name().unwrap_or_default().to_string_lossy();
        let replaced = self.target.with_file_name(format!(".{own_name}.replaced"));
        match kind_of(&self.target).map_err(not_written)? {
            Kind::Free => {}
            // Someone else was faster.
            Kind::Export if self.existing == Existing::Keep => return Err(exists(&self.target)),
            Kind::Export => fs::rename(&self.target, &replaced).map_err(not_written)?,
            Kind::File | Kind::Other => return Err(exists(&self.target)),
        }
        // An empty folder is replaced by a rename, at least on Unix.
        if let Err(error) = fs::rename(&self.folder, &self.target) {
            if replaced.exists() {
                fs::rename(&replaced, &self.target).map_err(not_written)?;
            }
            return Err(not_written(error));
        }
        // The new export is there; what is left of the old one is removed by the next run if not now.
        let _ = fs::remove_dir_all(&replaced);
        sync_folder(folder_of(&self.target)).map_err(not_written)?;
        Ok(bytes)
    }
}

impl Drop for FolderOutput {
    fn drop(&mut self) {
        // What cannot be removed now is removed by the next export to this target.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// What is at a target.
enum Kind {
    /// Nothing, or an empty folder.
    Free,
    /// A folder with the marker.
    Export,
    /// Another folder.
    Other,
    File,
}

fn kind_of(target: &Path) -> io::Result<Kind> {
    match fs::metadata(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Kind::Free),
        Err(error) => Err(error),
        Ok(found) if !found.is_dir() => Ok(Kind::File),
        Ok(_) if target.join(MARKER).is_file() => Ok(Kind::Export),
        Ok(_) if fs::read_dir(target)?.next().is_none() => Ok(Kind::Free),
        Ok(_) => Ok(Kind::Other),
    }
}

/// Puts right what a program left that was killed between two renames: the old export gets back to its place, or is removed where the new one is there.
fn put_right(target: &Path, replaced: &Path) -> io::Result<()> {
    if !replaced.join(MARKER).is_file() {
        return Ok(());
    }
    if matches!(kind_of(target)?, Kind::Free) {
        fs::rename(replaced, target)
    } else {
        fs::remove_dir_all(replaced)
    }
}

/// Writes all files below a folder to the disk; returns how many bytes they have.
fn sync(folder: &Path) -> io::Result<u64> {
    let mut bytes = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            bytes += sync(&entry.path())?;
        } else {
            let file = File::open(entry.path())?;
            file.sync_all()?;
            bytes += file.metadata()?.len();
        }
    }
    sync_folder(folder)?;
    Ok(bytes)
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
#[path = "folder_output_tests.rs"]
mod tests;
