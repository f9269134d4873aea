//! Why a package could not be verified.

use std::path::PathBuf;

use corniche_gis::listed_files;
use corniche_ground::GroundError;
use corniche_pieces::ExtractError;
use corniche_spec::{
    artifacts::ArtifactError,
    inputs::{InputError, Inputs},
};
use corniche_store::{LackOfRoom, StoreError};
use corniche_tileset::{OpenError, SourceError};

/// Why a package could not be verified.
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
        "{}: not the elevation files that the package was made from; give {}, the same files in the same order",
        listed_files(.given), listed_files(.expected)
    )]
    OtherDem { given: Vec<PathBuf>, expected: Vec<String> },
    #[error(
        "the elevation files do not give the package's grid or heights; corniche verify PACKAGE --dem FILE... says what differs"
    )]
    OtherGrid,
    #[error("the name of {path:?} is not UTF-8; rename the file")]
    InputName { path: PathBuf },
    #[error(
        "{path:?} changed while it was read; run the same command again when no program writes to the file"
    )]
    Changed { path: PathBuf },
    #[error(
        "{} is not what the package was made from; give {}, the same files",
        listed_files(.paths), listed_files(.expected)
    )]
    OtherOsm { paths: Vec<PathBuf>, expected: Vec<String> },
    #[error(
        "the FRC table {given:?} is not the one that the package was made with; give {expected:?} with --frc-table"
    )]
    OtherTable { given: String, expected: String },
    #[error("{}", other_area_table(given.as_deref(), expected))]
    OtherAreaTable { given: Option<String>, expected: String },
    #[error(
        "the package was cut with the polygon {expected:?}; give the same polygon with --polygon"
    )]
    PolygonMissing { expected: String },
    #[error(
        "{path:?} is not the polygon that the package was cut with; give {expected:?}, the same coordinate system and corners"
    )]
    OtherPolygon { path: PathBuf, expected: String },
    #[error("the package was made without a polygon; leave --polygon out")]
    NoPolygon,
    #[error(
        "{} are not the photos that the package was made from; give {}, the same files in the same order",
        listed_files(.paths), listed_files(.expected)
    )]
    OtherPhotos { paths: Vec<PathBuf>, expected: Vec<String> },
    #[error("the package was made without photos; leave --photo out")]
    NoPhotos,
    #[error(transparent)]
    Photo(#[from] corniche_photo::PhotoError),
    #[error("the package was made without an extract; leave --osm out")]
    NoExtract,
    #[error(
        "the package was made with another FRC table that is called {name:?}, too, read from a file; give that file with \
         --frc-table"
    )]
    OtherTableOfThatName { name: String },
    #[error("the extract could not be laid on the package's tiles")]
    Extract(#[source] ExtractError),
    #[error("the ground of the package could not be compared")]
    Ground(#[source] GroundError),
    #[error("intermediate results could not be kept in the folder for temporary files")]
    Kept(#[source] ArtifactError),
    #[error(transparent)]
    Setup(InputError),
    #[error(
        "intermediate results could not be kept in the folder for temporary files{}",
        LackOfRoom::advice(LackOfRoom::of(.0))
    )]
    Work(#[source] std::io::Error),
    #[error("interrupted")]
    Interrupted,
}

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

impl From<ArtifactError> for VerifyError {
    fn from(error: ArtifactError) -> Self {
        Self::Kept(error)
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

/// A name may be that of two tables.
fn other_area_table(given: Option<&str>, expected: &str) -> String {
    match given {
        Some(given) if given == expected => format!(
            "the package was made with another table of areas that is called {expected:?}, too, read from a file; give that file with --areas"
        ),
        Some(given) => format!(
            "the table of areas {given:?} is not the one that the package was made with; give {expected:?} with --areas"
        ),
        None => format!("the package has areas; give their table, {expected:?}, with --areas"),
    }
}

impl VerifyError {
    /// What came of a comparison with these files. A changed file may be the cause of any other error, so it is reported instead.
    pub(crate) fn unless_changed<T>(inputs: &Inputs, compared: Result<T, Self>) -> Result<T, Self> {
        match &compared {
            Err(Self::Interrupted) => compared,
            _ => inputs.check_unchanged().map_err(Self::from).and(compared),
        }
    }
}
