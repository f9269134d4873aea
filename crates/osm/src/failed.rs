//! Why a step of a reading fails, before it is said of which extract.

use std::{io, path::Path};

use crate::{ReadOsmError, kept_error::KeptError};

/// Why a step of a reading fails.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failed {
    #[error(transparent)]
    Osm(#[from] ReadOsmError),
    /// The scratch space failed, or what shares kept could not be read.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl Failed {
    /// The error, which names the extract.
    pub(crate) fn of(self, path: &Path) -> ReadOsmError {
        let path = path.to_path_buf();
        match self {
            Self::Osm(error) => error,
            Self::Io(source) => match source.downcast::<KeptError>() {
                Ok(source) => ReadOsmError::Kept { path, source },
                Err(source) => ReadOsmError::Scratch { path, source },
            },
        }
    }
}
