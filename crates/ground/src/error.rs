//! Errors of reading the ground.

use std::path::PathBuf;

use corniche_spec::artifacts::ArtifactError;
use corniche_store::StoreError;

/// Why heights or photos could not be read or stored.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
pub enum GroundError {
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(transparent)]
    Photo(#[from] corniche_photo::PhotoError),
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    #[error("a tile could not be encoded")]
    Encode(#[from] corniche_tileset::EncodeError),
    #[error("interrupted; no package was written")]
    Interrupted,
}

corniche_dem::from_dem_errors!(GroundError);

corniche_work::from_interrupted!(GroundError);

impl From<StoreError> for GroundError {
    fn from(error: StoreError) -> Self {
        Self::Artifact(error.into())
    }
}

/// Why the terrain of a package cannot be reused.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum TerrainError {
    #[error(transparent)]
    Open(#[from] corniche_tileset::OpenError),
    #[error(
        "the terrain of {path:?} cannot be reused: {differences}; use the same settings, or build from the elevation files with --dem"
    )]
    Other { path: PathBuf, differences: String },
    #[error("{path:?} is damaged: {what}; build from the elevation files with --dem")]
    Damaged { path: PathBuf, what: String },
    #[error("{path:?} cannot be used; build from the elevation files with --dem")]
    Tile { path: PathBuf, source: corniche_tileset::ReadError },
}

impl GroundError {
    /// Whether the cause is an unusable input, rather than a failure while it was read or stored.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Artifact(error) => error.is_unusable_input(),
            Self::Dem(_) | Self::Photo(_) | Self::Terrain(_) => true,
            Self::Encode(_) | Self::Interrupted => false,
        }
    }
}
