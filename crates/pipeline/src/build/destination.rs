//! The target path of a package, and the unfinished file next to it that becomes the package.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use corniche_spec::{BuildObserver, PlanSettings};
use corniche_store::{Claim, Existing, UnfinishedFile, file_target, folder_of, is_same_file};

use crate::BuildError;

/// The target of a package, checked before any work is done.
pub(crate) struct Destination {
    /// The path of the file, with a symbolic link resolved.
    pub target: PathBuf,
    /// The folder of the file.
    pub folder: PathBuf,
    pub existing: Existing,
}

impl Destination {
    /// Fails if no file may be written there, or if the existing file must be kept.
    pub(crate) fn resolve(output: &Path, existing: Existing) -> Result<Self, BuildError> {
        let target = file_target(output)?;
        let folder = folder_of(&target).to_path_buf();
        if existing == Existing::Keep && fs::symlink_metadata(&target).is_ok() {
            return Err(BuildError::Exists { path: target });
        }
        Ok(Self { target, folder, existing })
    }

    /// Fails if the target is one of the inputs.
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

    /// Claims the right to write the target. The observer learns which temporary files exist next
    /// to the target from now on.
    pub(crate) fn claim(&self, observer: &dyn BuildObserver) -> Result<Claim, BuildError> {
        let claim = claim(&self.target, &self.target, &self.folder)?;
        // The claim comes first, because it identifies the owner of the other files, which may
        // already exist after a killed build.
        observer.temporary(claim.path());
        observer.temporary(&claim.unfinished());
        Ok(claim)
    }

    /// Creates the file that becomes the package, once nothing can be rejected any more. It is
    /// deleted when the build fails; the leftover of a killed build is deleted by the next build.
    pub(crate) fn begin(&self, claim: Claim) -> Result<UnfinishedFile, BuildError> {
        let failed = |source| BuildError::Target { folder: self.folder.clone(), source };
        claim.begin_file(self.existing).map_err(failed)
    }
}

/// Claims `path` in `folder` for writing `named`: of two builds with the same target, one is
/// rejected.
pub(crate) fn claim(path: &Path, named: &Path, folder: &Path) -> Result<Claim, BuildError> {
    Claim::take(path).map_err(|source| match source.kind() {
        io::ErrorKind::ResourceBusy => BuildError::AtWork { path: named.to_path_buf() },
        _ => BuildError::Target { folder: folder.to_path_buf(), source },
    })
}

/// Moves the finished package to its path, durably; the store is deleted only afterwards. Returns
/// the size of the package.
pub(crate) fn place(file: UnfinishedFile) -> Result<u64, BuildError> {
    let path = file.target().to_path_buf();
    file.place().map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => BuildError::Exists { path },
        _ => BuildError::Rename { path, source },
    })
}
