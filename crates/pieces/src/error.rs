//! Errors of cutting an extract into pieces.

use std::{io, path::PathBuf};

use corniche_geom::Bounds;
use corniche_gis::listed_files;
use corniche_spec::artifacts::ArtifactError;
use corniche_store::{LackOfRoom, StoreError};

/// Why an extract could not be read, cut or draped on the ground.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ExtractError {
    #[error(transparent)]
    Osm(#[from] corniche_osm::ReadOsmError),
    #[error("{} has no road: {why}", listed_files(.osm))]
    NoRoads { osm: Vec<PathBuf>, why: String },
    #[error(
        "{} and the elevation data do not overlap: the roads are within {}, the heights within {}; pass files of the same region",
        listed_files(.osm), .roads_and_heights_deg[0].degrees_text(), .roads_and_heights_deg[1].degrees_text()
    )]
    NoOverlap { osm: Vec<PathBuf>, roads_and_heights_deg: Box<[Bounds; 2]> },
    #[error("the roads could not be projected into the working CRS")]
    Project(#[source] corniche_geom::ProjectError),
    #[error(
        "roads could not be sorted on disk{}",
        LackOfRoom::advice(LackOfRoom::from_io_error(.0))
    )]
    Storage(#[from] io::Error),
    #[error("cannot start: {0}")]
    Pool(#[from] rayon::ThreadPoolBuildError),
    #[error(transparent)]
    Artifact(#[from] ArtifactError),
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error("tile {id} could not be triangulated")]
    Triangulate { id: corniche_geom::TileId, source: corniche_tin::TriangulateError },
    #[error("a tile could not be encoded")]
    Encode(#[from] corniche_tileset::EncodeError),
    #[error("interrupted; no package was written")]
    Interrupted,
}

corniche_dem::from_dem_errors!(ExtractError);

corniche_work::from_interrupted!(ExtractError);

impl From<StoreError> for ExtractError {
    fn from(error: StoreError) -> Self {
        Self::Artifact(error.into())
    }
}

impl ExtractError {
    /// Whether the cause is an unusable input, rather than a failure while it was read or stored.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Artifact(error) => error.is_unusable_input(),
            Self::Triangulate { source, .. } => source.is_unusable_input(),
            Self::Osm(_) | Self::NoRoads { .. } | Self::NoOverlap { .. } | Self::Dem(_) => true,
            Self::Pool(_)
            | Self::Project(_)
            | Self::Storage(_)
            | Self::Encode(_)
            | Self::Interrupted => false,
        }
    }
}
