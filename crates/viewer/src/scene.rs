//! What one picture shows: the tiles of a selection, all loaded.

use crate::{
    camera::Camera,
    lod::{self, Drawn, Quality},
    tiles::{LoadTileError, TileGeometry, TileStore},
};

/// How roads are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoadMethod {
    /// As geometry lying on the TIN of their level (GEO).
    Geometry,
    /// Not at all.
    None,
}

/// Loads what `camera` needs, level by level, until nothing is missing, and says what to draw.
///
/// # Errors
/// When a tile cannot be had.
pub fn settle(
    store: &mut TileStore<'_>,
    camera: &Camera,
    quality: Quality,
) -> Result<Vec<Drawn>, LoadTileError> {
    loop {
        let selection = lod::select(store, camera, quality);
        if selection.requests.is_empty() {
            return Ok(selection.drawn);
        }
        store.load(&selection.requests)?;
    }
}

/// The tiles to draw with the depths of their skirts. Tiles that are not loaded are left out.
pub fn draw_list<'a>(
    store: &'a TileStore<'_>,
    drawn: &'a [Drawn],
) -> impl Iterator<Item = (&'a TileGeometry, f64)> {
    drawn.iter().filter_map(|drawn| Some((store.get(drawn.id)?, drawn.skirt_depth_m)))
}
