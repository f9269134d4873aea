//! The folders of stores that a part or a merge works with.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use corniche_store::{Disk, LocalStore, OwnPart, SYNC_INTERVAL, StoredPlan, SystemDisk};

use crate::{
    BuildError, BuildPlan,
    build::work_store::{differences, stored},
};

/// Folders of stores that are all of one plan.
pub(crate) struct Stores<'a> {
    disk: Arc<dyn Disk>,
    /// Each once; the first is written, too.
    folders: Vec<&'a Path>,
    plan: StoredPlan,
}

impl<'a> Stores<'a> {
    /// Looks which plans the folders are of. The first need not be there yet if it `may_be_new`.
    pub(crate) fn look(
        folders: &'a [PathBuf],
        plan: &BuildPlan,
        may_be_new: bool,
    ) -> Result<Self, BuildError> {
        let disk: Arc<dyn Disk> = Arc::new(SystemDisk);
        let wanted = stored(plan)?;
        let mut once: Vec<(Option<PathBuf>, &Path)> = Vec::new();
        for (index, folder) in folders.iter().enumerate() {
            match LocalStore::stored_plan(Arc::clone(&disk), folder)? {
                Some(there) if there.hash == wanted.hash => {}
                Some(there) => {
                    return Err(BuildError::OtherPlan {
                        store: folder.clone(),
                        differences: differences(plan, &there),
                    });
                }
                None if index == 0 && may_be_new => {}
                None => return Err(BuildError::NoStore { folder: folder.clone() }),
            }
            let place = fs::canonicalize(folder).ok();
            if place.is_none() || once.iter().all(|(other, _)| *other != place) {
                once.push((place, folder));
            }
        }
        if once.is_empty() {
            return Err(BuildError::Start { what: "no store is given".to_owned() });
        }
        Ok(Self {
            disk,
            folders: once.into_iter().map(|(_, folder)| folder).collect(),
            plan: wanted,
        })
    }

    /// Opens those of their parts whose names, without the digest, are `wanted`, and a part of this name to write in the first.
    pub(crate) fn open(
        &self,
        name: &str,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Result<LocalStore, BuildError> {
        let &[folder, ref others @ ..] = self.folders.as_slice() else {
            return Err(BuildError::Start { what: "no store is given".to_owned() });
        };
        let own = OwnPart { folder, name, plan: &self.plan, interval: SYNC_INTERVAL };
        let disk = Arc::clone(&self.disk);
        Ok(LocalStore::open_some_parts(disk, others, &self.plan.hash, Some(own), wanted)?)
    }

    /// Opens those that are there, to be read alone, as [`Self::open`] does; `None` if none is.
    pub(crate) fn open_to_read(
        &self,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Result<Option<LocalStore>, BuildError> {
        let mut there = Vec::new();
        for &folder in &self.folders {
            if LocalStore::stored_plan(Arc::clone(&self.disk), folder)?.is_some() {
                there.push(folder);
            }
        }
        if there.is_empty() {
            return Ok(None);
        }
        let disk = Arc::clone(&self.disk);
        Ok(Some(LocalStore::open_some_parts(disk, &there, &self.plan.hash, None, wanted)?))
    }
}
