//! The interface by which a live map asks for tiles and takes them when they have come.

use corniche_geom::TileId;
use corniche_viewer::tiles::{LoadTileError, TileGeometry};

/// The answer to a request for a tile.
pub struct Loaded {
    /// The tile that was asked for.
    pub id: TileId,
    /// The decoded tile, or why there is none.
    pub tile: Result<TileGeometry, LoadTileError>,
}

/// Loads tiles while the window goes on drawing. Nothing here waits: tiles are requested in one frame and taken in a later
/// one.
pub trait TileLoader {
    /// Asks for tiles, in order, after those asked for before.
    fn request(&mut self, ids: &[TileId]);
    /// Drops the requests on which no work has begun.
    fn forget(&mut self);
    /// Stops loading tiles that nobody wants any more, as far as it can. Returns those that will not arrive.
    fn abandon(&mut self, ids: &[TileId]) -> Vec<TileId> {
        let _ = ids;
        Vec::new()
    }
    /// The tiles that have arrived since this was called last.
    fn arrivals(&mut self) -> Vec<Loaded>;
}
