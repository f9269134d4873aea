//! Where a package goes, and the file beside it that it is while it is written.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use corniche_spec::{Observer, PlanSettings};
use corniche_store::{Claim, Existing, UnfinishedFile, file_target, folder_of, is_same_file};

use crate::BuildError;

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
        let polygon =
            settings.terrain.plan.polygon.as_ref().map(|polygon| polygon.path().to_owned());
        let mut inputs =
            settings.terrain_files().into_iter().chain(settings.osm.clone()).chain(polygon);
        match inputs.find(|input| is_same_file(input, &self.target)) {
            Some(path) => Err(BuildError::TargetIsInput { path }),
            None => Ok(()),
        }
    }

    /// The right to write there. The observer is told what lies beside the target from now on.
    pub(crate) fn claim(&self, observer: &dyn Observer) -> Result<Claim, BuildError> {
        let claim = claim(&self.target, &self.target, &self.folder)?;
        // The claim first, as it says whose the rest is; the rest may be there already, from a killed build.
        observer.temporary(claim.path());
        observer.temporary(&claim.unfinished());
        Ok(claim)
    }

    /// Makes the file that becomes the package, once nothing can be refused any more. It is removed when the build fails; what a killed build leaves
    /// is removed by the next one.
    pub(crate) fn begin(&self, claim: Claim) -> Result<UnfinishedFile, BuildError> {
        let failed = |source| BuildError::Target { folder: self.folder.clone(), source };
        claim.begin_file(self.existing).map_err(failed)
    }
}

/// Claims `path` in `folder` for what is written as `named`: of two builds of one target one is refused.
pub(crate) fn claim(path: &Path, named: &Path, folder: &Path) -> Result<Claim, BuildError> {
    Claim::take(path).map_err(|source| match source.kind() {
        io::ErrorKind::ResourceBusy => BuildError::AtWork { path: named.to_path_buf() },
        _ => BuildError::Target { folder: folder.to_path_buf(), source },
    })
}

/// Moves the finished package to its place, durably; the store is removed only after that. Returns its size.
pub(crate) fn place(file: UnfinishedFile) -> Result<u64, BuildError> {
    let path = file.target().to_path_buf();
    file.place().map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => BuildError::Exists { path },
        _ => BuildError::Rename { path, source },
    })
}
