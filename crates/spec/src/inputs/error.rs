//! Errors of finding, naming and hashing input files.

use std::{io, path::PathBuf};

use corniche_dem::DemError;

/// Why inputs cannot be used.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum InputError {
    #[error("cannot read {path:?}")]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "the name of {path:?} is not UTF-8, and a package records the names of its inputs as text; rename the file"
    )]
    Name { path: PathBuf },
    #[error(
        "{path:?} is a pipe or a device; inputs are read more than once, so save it to a file first"
    )]
    Stream { path: PathBuf },
    #[error(transparent)]
    Dem(#[from] DemError),
    #[error(transparent)]
    Address(#[from] corniche_objects::ObjectError),
    #[error("cannot start: {what}")]
    Setting { what: String },
    #[error(
        "{path:?} changed while it was read, so nothing was written (a package could mix old and new content); run the command again when no program writes to the file"
    )]
    Changed { path: PathBuf },
    #[error("interrupted; no package was written")]
    Interrupted,
}

corniche_dem::from_dem_errors!(InputError);

impl InputError {
    /// Whether the cause is an input or a setting, rather than a failure during the run.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Address(error) => error.is_unusable(),
            Self::Setting { .. } | Self::Changed { .. } | Self::Interrupted => false,
            _ => true,
        }
    }
}
