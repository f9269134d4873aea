//! Errors that prevent the verification of a package.

use std::path::PathBuf;

use corniche_gis::listed_files;
use corniche_ground::GroundError;
use corniche_pieces::ExtractError;
use corniche_spec::{
    artifacts::ArtifactError,
    inputs::{InputError, InputFiles},
};
use corniche_store::{LackOfRoom, StoreError};
use corniche_tileset::{OpenError, SourceError};

/// An error that prevents the verification of a package.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum VerifyError {
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error("the package could not be read to its end")]
    Read(#[source] SourceError),
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(
        "{}: not the elevation files that the package was built from; pass {}, the same files in the same order",
        listed_files(.given), listed_files(.expected)
    )]
    OtherDem { given: Vec<PathBuf>, expected: Vec<String> },
    #[error(
        "the elevation files do not result in the package's grid or heights; corniche verify PACKAGE --dem FILE... lists the differences"
    )]
    OtherGrid,
    #[error("the name of {path:?} is not UTF-8; rename the file")]
    InputName { path: PathBuf },
    #[error(
        "{path:?} changed while it was read; run the command again when no program is writing to the file"
    )]
    Changed { path: PathBuf },
    #[error(
        "{} is not what the package was built from; pass {}, the same files",
        listed_files(.paths), listed_files(.expected)
    )]
    OtherOsm { paths: Vec<PathBuf>, expected: Vec<String> },
    #[error(
        "the FRC table {given:?} is not the one that the package was built with; pass {expected:?} with --frc-table"
    )]
    OtherTable { given: String, expected: String },
    #[error(
        "the package was clipped to the polygon {expected:?}; pass the same polygon with --polygon"
    )]
    PolygonMissing { expected: String },
    #[error(
        "{path:?} is not the polygon that the package was clipped to; pass {expected:?}, with the same coordinate system and corners"
    )]
    OtherPolygon { path: PathBuf, expected: String },
    #[error("the package was built without a polygon; omit --polygon")]
    NoPolygon,
    #[error(
        "{} are not the photos that the package was built from; pass {}, the same files in the same order",
        listed_files(.paths), listed_files(.expected)
    )]
    OtherPhotos { paths: Vec<PathBuf>, expected: Vec<String> },
    #[error("the package was built without photos; omit --photo")]
    NoPhotos,
    #[error(transparent)]
    Photo(#[from] corniche_photo::PhotoError),
    #[error("the package was built without an extract; omit --osm")]
    NoExtract,
    #[error(
        "the package was built with another FRC table, read from a file and also called {name:?}; pass that file with \
         --frc-table"
    )]
    OtherTableOfThatName { name: String },
    #[error("the roads of the extract could not be clipped and draped on the package's tiles")]
    Extract(#[source] ExtractError),
    #[error("the ground of the package could not be compared")]
    Ground(#[source] GroundError),
    #[error("intermediate results could not be stored in the folder for temporary files")]
    Kept(#[from] ArtifactError),
    #[error(transparent)]
    Setup(InputError),
    #[error(
        "intermediate results could not be stored in the folder for temporary files{}",
        LackOfRoom::advice(LackOfRoom::from_io_error(.0))
    )]
    Work(#[source] std::io::Error),
    #[error("interrupted")]
    Interrupted,
}

/// What checks return.
pub(crate) type Result<T, E = VerifyError> = std::result::Result<T, E>;

corniche_dem::from_dem_errors!(VerifyError);

corniche_work::from_interrupted!(VerifyError);

impl From<GroundError> for VerifyError {
    fn from(error: GroundError) -> Self {
        match error {
            GroundError::Interrupted => Self::Interrupted,
            GroundError::Dem(error) => Self::Dem(error),
            GroundError::Photo(error) => Self::Photo(error),
            GroundError::Artifact(error) => Self::Kept(error),
            other => Self::Ground(other),
        }
    }
}

impl From<ExtractError> for VerifyError {
    fn from(error: ExtractError) -> Self {
        match error {
            ExtractError::Interrupted => Self::Interrupted,
            ExtractError::Dem(error) => Self::Dem(error),
            ExtractError::Storage(source) => Self::Work(source),
            ExtractError::Artifact(error) => Self::Kept(error),
            other => Self::Extract(other),
        }
    }
}

impl From<StoreError> for VerifyError {
    fn from(error: StoreError) -> Self {
        Self::Kept(error.into())
    }
}

impl From<InputError> for VerifyError {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Name { path } => Self::InputName { path },
            InputError::Changed { path } => Self::Changed { path },
            InputError::Dem(error) => Self::Dem(error),
            InputError::Interrupted => Self::Interrupted,
            other => Self::Setup(other),
        }
    }
}

impl VerifyError {
    /// Returns `result`, unless one of these files has changed: a changed file may be the cause of
    /// any other error, so it is reported instead.
    pub(crate) fn unless_changed<T>(
        inputs: &InputFiles,
        compared: Result<T, Self>,
    ) -> Result<T, Self> {
        match &compared {
            Err(Self::Interrupted) => compared,
            _ => inputs.check_unchanged().map_err(Self::from).and(compared),
        }
    }
}
