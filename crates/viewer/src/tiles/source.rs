//! Interfaces of what has tiles: which tiles there are, and how threads load them.

use corniche_geom::{GridFrame, TileId};
use corniche_tileset::Manifest;

use super::TileGeometry;
use crate::lod::GroundSummary;

/// Why a tile could not be had.
#[derive(Debug, thiserror::Error)]
#[error("tile {id} cannot be read")]
pub struct LoadTileError {
    /// Which tile.
    pub id: TileId,
    /// What went wrong.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// Which tiles there are. This is all that choosing tiles asks of a package; the answers are there at once.
pub trait TileCatalog {
    /// The grid.
    fn frame(&self) -> &GridFrame;
    /// Whether the tile or anything beneath it exists.
    fn exists(&self, id: TileId) -> bool;

    /// The tiles that exist at a position in the working CRS, from the root down to the finest.
    fn tiles_at(&self, at: [f64; 2]) -> Vec<TileId> {
        let (frame, mut there) = (self.frame(), Vec::new());
        let mut next = self.exists(TileId::ROOT).then_some(TileId::ROOT);
        while let Some(id) = next {
            there.push(id);
            next = (id.z() < frame.max_level())
                .then(|| id.children().find(|child| frame.tile_bounds(*child).contains(at)))
                .flatten()
                .filter(|child| self.exists(*child));
        }
        there
    }
}

/// Tiles for threads that may wait for them. Where nothing may wait, as in a browser, [`PackageTiles`](super::PackageTiles)
/// is a [`TileCatalog`] whose tiles are awaited.
pub trait TileSource: TileCatalog {
    /// Reads and decodes a tile that exists.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError>;

    /// Errors and heights of a tile that exists; `None` without ground. This is all that is asked of a tile while tiles are chosen.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        Ok(self.load(id)?.summary)
    }

    /// Reads of a tile that exists its slopes, and more only if that costs nothing: they are all that is drawn of a tile where finer
    /// tiles take its place.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.load(id)
    }

    /// Whether some of its tiles may have roads.
    fn may_have_roads(&self) -> bool {
        true
    }
}

/// A package before any of its tiles is loaded: which tiles there are, and its table of contents.
pub trait MapPackage: TileCatalog {
    /// The package's table of contents.
    fn manifest(&self) -> &Manifest;
}

/// A package whose tiles can be waited for, by any thread, as pictures, flights and windows need it.
pub trait BlockingPackage: MapPackage + TileSource + Sync {}

impl<P: MapPackage + TileSource + Sync + ?Sized> BlockingPackage for P {}
