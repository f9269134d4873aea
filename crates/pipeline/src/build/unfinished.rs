//! The package while it is written: a file beside the target, which gets the target's name when it is complete.

use std::{io, path::Path};

use corniche_store::Claim;
use tempfile::NamedTempFile;

use super::destination::Destination;
use crate::{BuildError, Observer, place_finished};

/// The right to write a package at its target: of two builds of one target one is refused.
pub(crate) struct Claimed<'a> {
    destination: &'a Destination,
    claim: Claim,
}

/// The file that becomes the package. It is removed when the build fails; what a killed build leaves is removed by the next one.
pub(crate) struct Unfinished<'a> {
    // Dropped before what claims it.
    file: NamedTempFile,
    claimed: Claimed<'a>,
}

impl<'a> Claimed<'a> {
    /// Tells the observer what lies beside the target from now on.
    pub(crate) fn take(
        destination: &'a Destination,
        observer: &dyn Observer,
    ) -> Result<Self, BuildError> {
        let Destination { target, folder, .. } = destination;
        match Claim::take(target) {
            Ok(claim) => {
                // The claim first, as it says whose the rest is; the rest may be there already, from a killed build.
                observer.temporary(claim.path());
                observer.temporary(&claim.unfinished());
                Ok(Self { destination, claim })
            }
            Err(error) if error.kind() == io::ErrorKind::ResourceBusy => {
                Err(BuildError::AtWork { path: target.clone() })
            }
            Err(source) => Err(BuildError::Target { folder: folder.clone(), source }),
        }
    }

    /// Makes the file, once nothing can be refused any more.
    pub(crate) fn begin(self) -> Result<Unfinished<'a>, BuildError> {
        let file = self.claim.begin_file().map_err(|source| BuildError::Target {
            folder: self.destination.folder.clone(),
            source,
        })?;
        Ok(Unfinished { file, claimed: self })
    }
}

impl Unfinished<'_> {
    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    /// Moves the finished package to its place, durably; the store is removed only after that. Returns its size.
    pub(crate) fn place(self) -> Result<u64, BuildError> {
        let Self { file, claimed } = self;
        let Destination { target, existing, .. } = claimed.destination;
        place_finished(file.into_temp_path(), target, *existing).map_err(|error| {
            match error.kind() {
                io::ErrorKind::AlreadyExists => BuildError::Exists { path: target.clone() },
                _ => BuildError::Rename { path: target.clone(), source: error },
            }
        })
    }
}
