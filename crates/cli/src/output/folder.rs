//! An output folder: written next to its target, and moved there as a whole when it is
//! complete.
//!
//! ```text
//!   .NAME.unfinished        the claim of the target (corniche_store::Claim)
//!   .NAME.ID.unfinished/    the new export
//!   .NAME.ID.replaced/      the old export, while the new one is moved to the target
//! ```
//!
//! A finished folder contains a marker file. Only a folder with the marker is ever overwritten.

use std::{
    fs,
    io::{self, Read as _},
    path::Path,
};

use corniche_store::{
    Claim, OpenMode, UnfinishedFolder, folder_of, is_same_file, open_own, sync_folder, sync_tree,
};

use super::{Existing, exists, failed, leftovers, not_begun, unusable};
use crate::{failure::Result, interrupt};

/// The marker file of an exported folder.
pub(crate) const MARKER: &str = "corniche-export.txt";
/// The marker's text between the contents of the folder and the version of the program.
const WRITTEN_BY: &str = ", written by corniche ";
/// The end of the marker's text.
const IS_REPLACED: &str = "corniche replaces this folder when it is asked to (-O).\n";
/// The largest size of a marker file.
const MARKER_BYTES: u64 = 1000;

/// A folder to be written at [`FolderOutput::path`].
#[derive(Debug)]
pub(crate) struct FolderOutput {
    existing: Existing,
    folder: UnfinishedFolder,
}

impl FolderOutput {
    /// Creates the folder. An unwritable target is reported here, before any work is done. `used`
    /// are files of the command, which an overwritten folder must not contain.
    pub(crate) fn create(named: &Path, existing: Existing, used: &[&Path]) -> Result<Self> {
        let unusable = |reason: &dyn std::fmt::Display| unusable(named, reason);
        // Links are followed, and a name that ends in a slash or in ".." is resolved to one that
        // has siblings.
        let target = match named.canonicalize() {
            Ok(found) => found,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if named.symlink_metadata().is_ok() {
                    return Err(unusable(&"it is a broken link; remove it"));
                }
                let name =
                    named.file_name().ok_or_else(|| unusable(&"the path has no file name"))?;
                let parent = folder_of(named).canonicalize();
                parent
                    .map_err(|error| unusable(&format_args!("its parent folder: {error}")))?
                    .join(name)
            }
            Err(error) => return Err(unusable(&error)),
        };
        if target.file_name().is_none() {
            return Err(unusable(&"the path has no file name"));
        }
        let claim = Claim::take(&target).map_err(|error| not_begun(named, &error))?;
        put_back(&target, &claim.replaced()).map_err(|error| unusable(&error))?;
        match kind_of(&target).map_err(|error| unusable(&error))? {
            OutputKind::Export if existing == Existing::Keep => return Err(exists(named)),
            OutputKind::Free | OutputKind::Export => {}
            OutputKind::File => {
                return Err(unusable(&"it is a file; pass the name of a folder"));
            }
            OutputKind::Other => {
                return Err(unusable(
                    &"the folder contains other files, which are never overwritten; choose another name",
                ));
            }
        }
        let holds = |used: &&&Path| {
            used.canonicalize().is_ok_and(|place| place.starts_with(&target))
                || is_same_file(used, &target)
        };
        if let Some(used) = used.iter().find(holds) {
            return Err(unusable(&format_args!(
                "the folder contains {used:?}, which the command uses; choose another folder"
            )));
        }
        leftovers::tell(&target);
        let folder = claim.begin_folder().map_err(|error| not_begun(named, &error))?;
        // Not earlier: until it is removed, only the claim identifies what a killed run left, which
        // may be an overwritten export.
        interrupt::remove_at_end(folder.claim().path());
        interrupt::remove_at_end(folder.path());
        Ok(Self { existing, folder })
    }

    /// The folder to write to.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Adds the marker, syncs all files to disk and moves the folder to its target; returns its
    /// size in bytes.
    pub(crate) fn place(self, what: &str) -> Result<u64> {
        let (folder, claim) = (self.folder.path(), self.folder.claim());
        let target = claim.target();
        let not_written = |error: io::Error| failed(target, &error);
        let version = env!("CARGO_PKG_VERSION");
        let marker = format!("{what}{WRITTEN_BY}{version}. {IS_REPLACED}");
        fs::write(folder.join(MARKER), marker).map_err(not_written)?;
        self.folder.open_to_others().map_err(not_written)?;
        let bytes = sync_tree(folder).map_err(not_written)?;
        // If the program ended early during the move, it would remove half a new export, or the
        // claim that identifies the old one.
        interrupt::spare(&[claim.path(), folder]);
        let replaced = claim.replaced();
        match kind_of(target).map_err(not_written)? {
            OutputKind::Free => {}
            // Another process was faster.
            OutputKind::Export if self.existing == Existing::Keep => return Err(exists(target)),
            OutputKind::Export => {
                // Only the claim knows the temporary name of the old export.
                claim.sync().map_err(not_written)?;
                fs::rename(target, &replaced).map_err(not_written)?;
            }
            OutputKind::File | OutputKind::Other => return Err(exists(target)),
        }
        // A rename replaces an empty folder, at least on Unix.
        if let Err(error) = fs::rename(folder, target) {
            if replaced.exists() {
                fs::rename(&replaced, target).map_err(not_written)?;
            }
            return Err(not_written(error));
        }
        // The new export is in place; if the old one cannot be removed now, the next run removes
        // it.
        let _ = fs::remove_dir_all(&replaced);
        sync_folder(folder_of(target)).map_err(not_written)?;
        Ok(bytes)
    }
}

/// What exists at a target.
enum OutputKind {
    /// Nothing, or an empty folder.
    Free,
    /// A folder with the marker.
    Export,
    /// Another folder.
    Other,
    File,
}

fn kind_of(target: &Path) -> io::Result<OutputKind> {
    match fs::metadata(target) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(OutputKind::Free),
        Err(error) => Err(error),
        Ok(found) if !found.is_dir() => Ok(OutputKind::File),
        Ok(_) if is_marked(target) => Ok(OutputKind::Export),
        Ok(_) if fs::read_dir(target)?.next().is_none() => Ok(OutputKind::Free),
        Ok(_) => Ok(OutputKind::Other),
    }
}

/// Whether a folder has the marker: a file with its text. An empty file, or a link, proves nothing.
fn is_marked(folder: &Path) -> bool {
    let mut text = String::new();
    let read = open_own(&folder.join(MARKER), OpenMode::Read)
        .and_then(|file| file.take(MARKER_BYTES).read_to_string(&mut text));
    read.is_ok() && text.contains(WRITTEN_BY) && text.ends_with(IS_REPLACED)
}

/// Restores an export that a killed program had moved aside. If the new export is already in place,
/// the old one is removed later, when nothing can fail any more.
fn put_back(target: &Path, replaced: &Path) -> io::Result<()> {
    let is_there = replaced.symlink_metadata().is_ok_and(|found| found.is_dir());
    if is_there && matches!(kind_of(target)?, OutputKind::Free) {
        fs::rename(replaced, target)?;
    }
    Ok(())
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
