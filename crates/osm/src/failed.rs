//! The reason why a step of a reading fails, before the extract is named.

use std::{io, path::Path};

use crate::{ReadOsmError, kept_error::KeptError};

/// The reason why a step of a reading fails.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failed {
    #[error(transparent)]
    Osm(#[from] ReadOsmError),
    /// The scratch space failed, or the results of shares could not be read.
    #[error(transparent)]
    Io(#[from] io::Error),
}

impl From<KeptError> for Failed {
    fn from(error: KeptError) -> Self {
        Self::Io(error.into())
    }
}

impl Failed {
    /// Returns the error with the name of the extract.
    pub(crate) fn at_path(self, path: &Path) -> ReadOsmError {
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
