//! The order of tiles in a package: PMTiles' tile ids along a Hilbert curve.

use corniche_geom::TileId;

/// Position of a tile in a package: PMTiles' tile id, which counts tiles level by level along a
/// Hilbert curve.
///
/// Source: PMTiles version 3 specification, section 4.1.
#[must_use]
pub fn pmtiles_order(id: TileId) -> u64 {
    // A tile id is valid from construction, and PMTiles has more levels than this format.
    pmtiles::TileCoord::new(id.z(), id.x(), id.y())
        .map_or(u64::MAX, |coord| pmtiles::TileId::from(coord).value())
}

/// Returns the tile at a position; `None` for positions beyond the deepest level.
#[must_use]
pub fn tile_of_order(order: u64) -> Option<TileId> {
    let coord = pmtiles::TileCoord::from(pmtiles::TileId::new(order).ok()?);
    TileId::new(coord.z(), coord.x(), coord.y()).ok()
}
