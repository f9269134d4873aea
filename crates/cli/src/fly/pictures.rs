//! Images of a flight's frames, in a folder that appears when all of them are complete.

use std::{fs, path::Path};

use corniche_store::{Claim, UnfinishedFolder};
use corniche_viewer::Replay;

use crate::{
    failure::{CommandFailure, Result},
    interrupt, names,
    output::{self, png},
};

/// A folder of images that is moved to its target when it is complete.
pub(crate) struct Pictures {
    folder: UnfinishedFolder,
}

impl Pictures {
    pub(crate) fn create(target: &Path, used: &[&Path]) -> Result<Self> {
        let unusable = |reason: &dyn std::fmt::Display| {
            unusable!("cannot write images to {target:?}: {reason}")
        };
        names::refuse_what_is_no_file(target)?;
        if used.contains(&target) {
            return Err(unusable(&"the command already uses this file; choose another name"));
        }
        if target.metadata().is_ok_and(|found| !found.is_dir() && !found.is_file()) {
            return Err(unusable(&"it is a device or a pipe; pass the name of a new folder"));
        }
        if target.symlink_metadata().is_ok() {
            return Err(CommandFailure::exists(format!(
                "{target:?} already exists; pass the name of a new folder for the images"
            )));
        }
        let claim = Claim::take(target).map_err(|error| unusable(&error))?;
        let folder = claim.begin_folder().map_err(|error| unusable(&error))?;
        interrupt::remove_at_end(folder.claim().path());
        interrupt::remove_at_end(folder.path());
        Ok(Self { folder })
    }

    pub(crate) fn add(&self, name: &str, replay: &Replay<'_>) -> Result<()> {
        let path = self.folder.path().join(name);
        fs::write(&path, png(&replay.picture()?)?).map_err(|error| output::failed(&path, &error))
    }

    pub(crate) fn finish(self) -> Result<()> {
        let (folder, target) = (self.folder.path(), self.folder.claim().target());
        // An early end would leave half of them there.
        interrupt::spare(&[folder]);
        let opened = self.folder.open_to_others();
        opened.and_then(|()| fs::rename(folder, target)).map_err(|error| {
            CommandFailure::failed(format!("cannot move the images to {target:?}: {error}"))
        })
    }
}

#[cfg(test)]
#[path = "pictures_tests.rs"]
mod tests;
