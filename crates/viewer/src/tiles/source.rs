use corniche_geom::{Frame, TileId};

use super::TileGeometry;

/// Why a tile could not be had.
#[derive(Debug, thiserror::Error)]
#[error("tile {id} cannot be read")]
pub struct LoadTileError {
    /// Which tile.
    pub id: TileId,
    /// What went wrong.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// Where tiles come from.
pub trait TileSource {
    /// The grid.
    fn frame(&self) -> &Frame;
    /// Whether the tile or anything beneath it exists.
    fn exists(&self, id: TileId) -> bool;
    /// Reads and decodes a tile that exists.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError>;
}
