//! Errors of comparing roads with an image.

use corniche_drape::BadLine;
use corniche_geom::TileId;
use corniche_photo::PhotoError;
use corniche_tileset::{OpenError, ReadError};

/// Errors of comparing roads with an image.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum MatchError {
    #[error(transparent)]
    Package(#[from] OpenError),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(transparent)]
    Photo(#[from] PhotoError),
    #[error("a road of tile {tile} does not match its ground; run corniche verify for details")]
    Line { tile: TileId, source: BadLine },
    #[error("the package has no roads of these classes, or was built without --osm")]
    NoRoads,
    #[error(
        "the package has no relief, which is needed to compute slopes; build it again without --relief off, or compare with --photo"
    )]
    NoRelief,
    #[error("interrupted")]
    Interrupted,
}

corniche_work::from_interrupted!(MatchError);
