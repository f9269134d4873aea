//! Pictures of a flight's frames, written to a folder that appears when all of them are complete.

use std::{fs, path::Path};

use corniche_store::{Claim, UnfinishedFolder};
use corniche_viewer::Replay;

use crate::{
    failure::Failure,
    interrupt, names,
    output::{self, png},
};

/// A folder of pictures that takes its place when it is complete.
pub(crate) struct Pictures {
    folder: UnfinishedFolder,
}

impl Pictures {
    pub(crate) fn create(target: &Path, used: &[&Path]) -> Result<Self, Failure> {
        let unusable = |reason: &dyn std::fmt::Display| {
            Failure::unusable(format!("cannot write pictures to {}: {reason}", target.display()))
        };
        names::refuse_what_is_no_file(target)?;
        if used.contains(&target) {
            return Err(unusable(&"the command uses that file itself; choose another name"));
        }
        if target.metadata().is_ok_and(|found| !found.is_dir() && !found.is_file()) {
            return Err(unusable(&"it is a device or a pipe; give the name of a new folder"));
        }
        if target.symlink_metadata().is_ok() {
            return Err(Failure::exists(format!(
                "{} exists already; give the name of a new folder for the pictures",
                target.display()
            )));
        }
        let claim = Claim::take(target).map_err(|error| unusable(&error))?;
        let folder = claim.begin_folder().map_err(|error| unusable(&error))?;
        interrupt::remove_at_end(folder.claim().path());
        interrupt::remove_at_end(folder.path());
        Ok(Self { folder })
    }

    pub(crate) fn add(&self, name: &str, replay: &Replay<'_>) -> Result<(), Failure> {
        let path = self.folder.path().join(name);
        fs::write(&path, png(&replay.picture()?)?).map_err(|error| output::failed(&path, &error))
    }

    pub(crate) fn finish(self) -> Result<(), Failure> {
        let (folder, target) = (self.folder.path(), self.folder.claim().target());
        // An early end would leave half of them there.
        interrupt::spare(&[folder]);
        let opened = self.folder.open_to_others();
        opened.and_then(|()| fs::rename(folder, target)).map_err(|error| {
            Failure::failed(format!("cannot move the pictures to {}: {error}", target.display()))
        })
    }
}

#[cfg(test)]
#[path = "pictures_tests.rs"]
mod tests;
