//! Interfaces of tile sources: which tiles exist, and how threads load them.

use corniche_geom::{Bounds, GridFrame, TileId};
use corniche_tileset::Manifest;

use super::TileGeometry;
use crate::lod::{GroundSummary, TileTree, TreeNode};

/// Why a tile could not be loaded.
#[derive(Debug, thiserror::Error)]
#[error("tile {id} cannot be read")]
pub struct LoadTileError {
    /// Id of the tile.
    pub id: TileId,
    /// Cause of the error.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

impl LoadTileError {
    /// Wraps the cause of a tile's error, for `map_err`.
    pub fn for_tile<E: Into<Box<dyn std::error::Error + Send + Sync>>>(
        id: TileId,
    ) -> impl Fn(E) -> Self {
        move |error| Self { id, source: error.into() }
    }
}

/// Which tiles exist. Tile selection needs nothing else from a package; the answers are available
/// at once.
pub trait TileCatalog {
    /// Grid of the tiles.
    fn frame(&self) -> &GridFrame;
    /// Whether the tile or any descendant exists.
    fn exists(&self, id: TileId) -> bool;

    /// The existing tiles at a position in the working CRS, from the root down to the finest.
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

/// The tiles of a catalog as a tree for tile selection.
pub struct CatalogTree<'a, C: ?Sized, F> {
    /// The catalog of existing tiles.
    pub catalog: &'a C,
    /// Returns the ground of a tile, if it is known; the inner `None` means a tile without ground.
    pub ground_of: F,
}

impl<C: TileCatalog + ?Sized, F> TileTree for CatalogTree<'_, C, F>
where
    F: Fn(TileId) -> Option<Option<GroundSummary>>,
{
    fn node(&self, id: TileId) -> TreeNode {
        match (self.ground_of)(id) {
            Some(ground) => TreeNode::Loaded(ground),
            None if self.catalog.exists(id) => TreeNode::Listed,
            None => TreeNode::Absent,
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.catalog.frame().tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.catalog.frame().max_level()
    }
}

/// Tiles for threads that may wait for them. If no thread may wait, as in a browser,
/// [`PackageTiles`](super::PackageTiles) is a [`TileCatalog`] whose tiles are awaited.
pub trait TileSource: TileCatalog {
    /// Reads and decodes an existing tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError>;

    /// Reads errors and heights of an existing tile; `None` without ground. Tile selection needs
    /// nothing else from a tile.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        Ok(self.load(id)?.summary)
    }

    /// Reads the slopes of an existing tile, and more only if that costs nothing: slopes are all
    /// that is drawn of a tile if its descendants are drawn instead.
    ///
    /// # Errors
    /// When the tile cannot be read or is damaged.
    fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.load(id)
    }

    /// Whether any tile may have roads.
    fn may_have_roads(&self) -> bool {
        true
    }
}

/// A package before any of its tiles is loaded: its tile catalog and its manifest.
pub trait MapPackage: TileCatalog {
    /// Manifest of the package.
    fn manifest(&self) -> &Manifest;
}

/// A package whose tiles any thread can wait for, as pictures, flights and windows need it.
pub trait BlockingPackage: MapPackage + TileSource + Sync {}

impl<P: MapPackage + TileSource + Sync + ?Sized> BlockingPackage for P {}
