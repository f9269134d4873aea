//! Errors of building a package.

use std::{io, path::PathBuf};

use corniche_gis::listed_files;
use corniche_ground::{GroundError, TerrainError};
use corniche_pieces::ExtractError;
use corniche_plan::{PlanError, PlanFileError};
use corniche_spec::{artifacts::ArtifactError, inputs::InputError};
use corniche_store::{LackOfRoom, StoreError, TargetError};
use corniche_tileset::{OpenError, WriteError};

/// Why a package could not be built.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum BuildError {
    #[error("{path:?} already exists; pass -O to overwrite it")]
    Exists { path: PathBuf },
    #[error("the package cannot be written")]
    NoTarget(#[from] TargetError),
    #[error("cannot write in {folder:?}; choose another folder for the package")]
    Target { folder: PathBuf, source: io::Error },
    #[error(
        "{path:?} is both an input and the package to write; choose another name for the package"
    )]
    TargetIsInput { path: PathBuf },
    #[error(transparent)]
    Input(InputError),
    #[error(transparent)]
    Plan(PlanError),
    #[error(transparent)]
    PlanFile(#[from] PlanFileError),
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(transparent)]
    Photo(#[from] corniche_photo::PhotoError),
    #[error(transparent)]
    Extract(ExtractError),
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    #[error("no node of {} has a height: every node is void, or outside --polygon; pass other files, or check --nodata and --polygon", listed_files(.dem))]
    NoHeights { dem: Vec<PathBuf> },
    #[error(
        "{} hold heights at {nodes} nodes, but no cell has a height at each of its four corners, so there is no ground; pass rasters with heights at adjacent nodes",
        listed_files(.dem)
    )]
    NoCell { dem: Vec<PathBuf>, nodes: u64 },
    #[error(
        "no {what} of {} is on ground: all are outside the elevation data, over its voids, or outside --bounds or --polygon; omit --osm to build terrain alone",
        listed_files(.osm)
    )]
    NoGround { osm: Vec<PathBuf>, what: &'static str },
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    #[error("cannot start: {what}")]
    Start { what: String },
    #[error(
        "an earlier build of this package ended early and left {store:?}; pass --resume to continue it, or -O to start again"
    )]
    Leftovers { store: PathBuf },
    #[error(
        "{store:?} belongs to another build: {differences}; use the inputs and settings of that build, or pass -O to start again"
    )]
    OtherBuild { store: PathBuf, differences: String },
    #[error(
        "{store:?} belongs to another plan: {differences}; pass the plan that it was created with, or another --store"
    )]
    OtherPlan { store: PathBuf, differences: String },
    #[error(
        "{folder:?} contains no store; check the path, or compute the parts first with corniche part"
    )]
    NoStore { folder: PathBuf },
    #[error("--subtree {subtree}: {why}")]
    Subtree { subtree: corniche_geom::TileId, why: String },
    #[error("--share {share}: {why}")]
    Share { share: corniche_osm::Share, why: String },
    #[error(
        "{folder:?} contains {kept:?}, which was not created by Corniche; move it away or choose another --tmp"
    )]
    NotOurs { folder: PathBuf, kept: PathBuf },
    #[error("{path:?} is being built by another process; wait until that process has ended")]
    AtWork { path: PathBuf },
    #[error(transparent)]
    Objects(#[from] corniche_objects::ObjectError),
    #[error("tile {id} could not be triangulated")]
    Triangulate { id: corniche_geom::TileId, source: corniche_tin::TriangulateError },
    #[error("a tile could not be encoded")]
    Encode(#[from] corniche_tileset::EncodeError),
    #[error("cannot write {path:?}{}", room_of(.source))]
    Write { path: PathBuf, source: WriteError },
    #[error("the finished file could not be moved to {path:?}")]
    Rename { path: PathBuf, source: io::Error },
    #[error("interrupted; no package was written")]
    Interrupted,
}

corniche_dem::from_dem_errors!(BuildError);

/// The advice about missing space for a package that could not be written.
fn room_of(error: &WriteError) -> String {
    LackOfRoom::advice(match error {
        WriteError::Io(error) => LackOfRoom::from_io_error(error),
        _ => None,
    })
}

corniche_work::from_interrupted!(BuildError);

impl From<StoreError> for BuildError {
    fn from(error: StoreError) -> Self {
        Self::Artifact(error.into())
    }
}

impl From<OpenError> for BuildError {
    fn from(error: OpenError) -> Self {
        Self::Terrain(error.into())
    }
}

// A cause that several of these errors can have is one variant here, so that no cause has two
// forms.

impl From<InputError> for BuildError {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Dem(error) => Self::Dem(error),
            InputError::Address(error) => Self::Objects(error),
            InputError::Interrupted => Self::Interrupted,
            other => Self::Input(other),
        }
    }
}

impl From<GroundError> for BuildError {
    fn from(error: GroundError) -> Self {
        match error {
            GroundError::Dem(error) => Self::Dem(error),
            GroundError::Photo(error) => Self::Photo(error),
            GroundError::Terrain(error) => Self::Terrain(error),
            GroundError::Artifact(error) => Self::Artifact(error),
            GroundError::Encode(error) => Self::Encode(error),
            GroundError::Interrupted => Self::Interrupted,
        }
    }
}

impl From<PlanError> for BuildError {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Input(error) => error.into(),
            PlanError::Dem(error) => Self::Dem(error),
            PlanError::Ground(error) => error.into(),
            PlanError::Terrain(error) => Self::Terrain(error),
            PlanError::Triangulate { id, source } => Self::Triangulate { id, source },
            PlanError::Interrupted => Self::Interrupted,
            other => Self::Plan(other),
        }
    }
}

impl From<ExtractError> for BuildError {
    fn from(error: ExtractError) -> Self {
        match error {
            ExtractError::Dem(error) => Self::Dem(error),
            ExtractError::Artifact(error) => Self::Artifact(error),
            ExtractError::Triangulate { id, source } => Self::Triangulate { id, source },
            ExtractError::Encode(error) => Self::Encode(error),
            ExtractError::Interrupted => Self::Interrupted,
            other => Self::Extract(other),
        }
    }
}

impl BuildError {
    /// Whether the cause is an unusable input or setting, rather than a failure during the build.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Input(error) => error.is_unusable_input(),
            Self::Plan(error) => error.is_unusable_input(),
            Self::Extract(error) => error.is_unusable_input(),
            Self::Artifact(error) => error.is_unusable_input(),
            Self::Objects(error) => error.is_unusable(),
            Self::Triangulate { source, .. } => source.is_unusable_input(),
            Self::Target { .. }
            | Self::NoTarget(_)
            | Self::TargetIsInput { .. }
            | Self::Dem(_)
            | Self::Photo(_)
            | Self::NoHeights { .. }
            | Self::NoCell { .. }
            | Self::NoGround { .. }
            | Self::PlanFile(_)
            | Self::OtherPlan { .. }
            | Self::NoStore { .. }
            | Self::Subtree { .. }
            | Self::Share { .. }
            | Self::Terrain(_) => true,
            _ => false,
        }
    }
}

#[cfg(test)]
#[path = "error_tests.rs"]
mod tests;
