//! Where a package goes.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::{BuildError, Existing, PlanSettings, file_target, folder_of};

/// The place of a package: looked at before any work is done.
pub(crate) struct Destination {
    /// The file: where a link leads, if there is one.
    pub(crate) target: PathBuf,
    /// The folder around it.
    pub(crate) folder: PathBuf,
    pub(crate) existing: Existing,
}

impl Destination {
    /// Fails where no file may be written, or where one is that is to be kept.
    pub(crate) fn of(output: &Path, existing: Existing) -> Result<Self, BuildError> {
        let target = file_target(output)?;
        let folder = folder_of(&target).to_path_buf();
        if existing == Existing::Keep && fs::symlink_metadata(&target).is_ok() {
            return Err(BuildError::Exists { path: target });
        }
        Ok(Self { target, folder, existing })
    }

    /// Fails if it is one of the inputs.
    pub(crate) fn refuse_inputs(&self, settings: &PlanSettings) -> Result<(), BuildError> {
        let Ok(target) = fs::canonicalize(&self.target) else { return Ok(()) };
        let polygon =
            settings.terrain.plan.polygon.as_ref().map(|polygon| polygon.path().to_owned());
        for input in settings.terrain_files().into_iter().chain(settings.osm.clone()).chain(polygon)
        {
            if fs::canonicalize(&input).is_ok_and(|input| input == target) {
                return Err(BuildError::TargetIsInput { path: input });
            }
        }
        Ok(())
    }
}
