//! A folder that a command writes: beside its target, from where it gets to its place as a whole when it is complete.
//!
//! ```text
//!   .NAME.unfinished        the claim of the target (corniche_store::Claim)
//!   .NAME.ID.unfinished/    what is made
//!   .NAME.ID.replaced/      the export that was there, for as long as the new one takes its place
//! ```
//!
//! A finished folder holds a marker. Only a folder with it is ever replaced.

use std::{
    fs,
    io::{self, Read as _},
    path::Path,
};

use corniche_store::{
    Claim, OpenMode, UnfinishedFolder, folder_of, is_same_file, open_own, sync_folder, sync_tree,
};

use super::{Existing, exists, failed, leftovers, not_begun, unusable};
use crate::{failure::Failure, interrupt};

/// The marker of a folder that an export wrote.
pub(crate) const MARKER: &str = "corniche-export.txt";
/// What the marker says between what the folder holds and the version that wrote it.
const WRITTEN_BY: &str = ", written by corniche ";
/// What the marker says at its end.
const IS_REPLACED: &str = "corniche replaces this folder when it is asked to (-O).\n";
/// Longer is no marker.
const MARKER_BYTES: u64 = 1000;

/// A folder to be written at [`FolderOutput::path`].
#[derive(Debug)]
pub(crate) struct FolderOutput {
    existing: Existing,
    folder: UnfinishedFolder,
}

impl FolderOutput {
    /// Makes the folder. An unusable place is reported here, before any work is done. `used` are files of the command, which a replaced folder must not
    /// hold.
    pub(crate) fn create(
        named: &Path,
        existing: Existing,
        used: &[&Path],
    ) -> Result<Self, Failure> {
        let unusable = |reason: &dyn std::fmt::Display| unusable(named, reason);
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
        if target.file_name().is_none() {
            return Err(unusable(&"that is no name"));
        }
        let claim = Claim::take(&target).map_err(|error| not_begun(named, &error))?;
        put_back(&target, &claim.replaced()).map_err(|error| unusable(&error))?;
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
        leftovers::tell(&target);
        let folder = claim.begin_folder().map_err(|error| not_begun(named, &error))?;
        // Not before: what a killed run left, perhaps an export that was replaced, is known by the claim alone until it is removed.
        interrupt::remove_at_end(folder.claim().path());
        interrupt::remove_at_end(folder.path());
        Ok(Self { existing, folder })
    }

    /// Where to write.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Adds the marker, makes all files durable and puts the folder in its place; returns its size in bytes.
    pub(crate) fn place(self, what: &str) -> Result<u64, Failure> {
        let (folder, claim) = (self.folder.path(), self.folder.claim());
        let target = claim.target();
        let not_written = |error: io::Error| failed(target, &error);
        let version = env!("CARGO_PKG_VERSION");
        let marker = format!("{what}{WRITTEN_BY}{version}. {IS_REPLACED}");
        fs::write(folder.join(MARKER), marker).map_err(not_written)?;
        self.folder.open_to_others().map_err(not_written)?;
        let bytes = sync_tree(folder).map_err(not_written)?;
        // What an early end removes while it takes its place would be half a new export, or the claim by which the old one is known.
        interrupt::spare(&[claim.path(), folder]);
        let replaced = claim.replaced();
        match kind_of(target).map_err(not_written)? {
            Kind::Free => {}
            // Someone else was faster.
            Kind::Export if self.existing == Existing::Keep => return Err(exists(target)),
            Kind::Export => {
                // What the old one is called now is known by the claim alone.
                claim.sync().map_err(not_written)?;
                fs::rename(target, &replaced).map_err(not_written)?;
            }
            Kind::File | Kind::Other => return Err(exists(target)),
        }
        // An empty folder is replaced by a rename, at least on Unix.
        if let Err(error) = fs::rename(folder, target) {
            if replaced.exists() {
                fs::rename(&replaced, target).map_err(not_written)?;
            }
            return Err(not_written(error));
        }
        // The new export is there; what is left of the old one is removed by the next run if not now.
        let _ = fs::remove_dir_all(&replaced);
        sync_folder(folder_of(target)).map_err(not_written)?;
        Ok(bytes)
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
        Ok(_) if is_marked(target) => Ok(Kind::Export),
        Ok(_) if fs::read_dir(target)?.next().is_none() => Ok(Kind::Free),
        Ok(_) => Ok(Kind::Other),
    }
}

/// Whether a folder has the marker: a file with its words. One that is empty, or a link, proves nothing.
fn is_marked(folder: &Path) -> bool {
    let mut text = String::new();
    let read = open_own(&folder.join(MARKER), OpenMode::Read)
        .and_then(|file| file.take(MARKER_BYTES).read_to_string(&mut text));
    read.is_ok() && text.contains(WRITTEN_BY) && text.ends_with(IS_REPLACED)
}

/// Gives an export its place back that a program had moved aside when it was killed. Where the new one is there already, the old one is
/// removed later, once nothing can be refused any more.
fn put_back(target: &Path, replaced: &Path) -> io::Result<()> {
    let is_there = replaced.symlink_metadata().is_ok_and(|found| found.is_dir());
    if is_there && matches!(kind_of(target)?, Kind::Free) {
        fs::rename(replaced, target)?;
    }
    Ok(())
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
