//! Rasters of the levels above the finest: every second node of the level below.
//!
//! The raster of a tile has its own 257 × 257 nodes, borders included, so that a tile without halo
//! needs no neighbour.

use corniche_geom::{HeightGrid, TILE_CELLS, TILE_NODES, TileId};
use corniche_spec::{
    artifacts::{ArtifactError, ArtifactKind, damaged},
    data_tiles::DataTiles,
};
use corniche_store::Artifacts;

use super::finest::{FinestHeights, grid_of, height_bytes};
use crate::GroundError;

/// Stores a tile's raster. A raster without any height is stored without bytes, because a missing
/// artifact means "not computed".
///
/// # Errors
/// See [`GroundError`].
pub fn put(store: &dyn Artifacts, id: TileId, raster: &HeightGrid) -> Result<(), GroundError> {
    let bytes = if raster.count_heights() == 0 { Vec::new() } else { height_bytes(raster) };
    Ok(store.put(ArtifactKind::Raster.of_tile(id), &bytes)?)
}

/// Reads the raster of a tile above the finest level; `None` if it has no height or is outside the
/// data.
///
/// # Errors
/// See [`GroundError`].
pub fn get(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
) -> Result<Option<HeightGrid>, GroundError> {
    if !data.above(id.z()).contains(id) {
        return Ok(None);
    }
    let key = ArtifactKind::Raster.of_tile(id);
    let missing =
        || ArtifactError::Missing { what: format!("the heights of tile {id}"), step: "top" };
    let bytes = store.get(key)?.ok_or_else(missing)?;
    match bytes.len() {
        0 => Ok(None),
        length if length == TILE_NODES * TILE_NODES * 4 => Ok(Some(grid_of(&bytes, TILE_NODES))),
        _ => Err(damaged(key, &"it has the wrong size").into()),
    }
}

/// Creates a tile's raster from the heights of its children.
///
/// # Errors
/// See [`GroundError`].
pub fn put_from_children(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
) -> Result<(), GroundError> {
    let half = TILE_CELLS as usize / 2;
    let mut heights_m = vec![f32::NAN; TILE_NODES * TILE_NODES];
    for child in id.children() {
        let Some(raster) = of_any_level(store, data, child, 0)? else { continue };
        let (left, top) = ((child.x() % 2) as usize * half, (child.y() % 2) as usize * half);
        for row in 0..=half {
            for column in 0..=half {
                // Nodes on the border between two children are in both rasters. One of the children
                // may have no raster.
                if let Some(height_m) = raster.height(2 * column, 2 * row) {
                    heights_m[(top + row) * TILE_NODES + left + column] = height_m;
                }
            }
        }
    }
    put(store, id, &HeightGrid::new(TILE_NODES, TILE_NODES, heights_m))
}

/// The heights of a tile above the finest level, with `halo` nodes on every side, at least one.
/// `None` if the tile itself has no height.
///
/// # Errors
/// See [`GroundError`].
pub fn with_halo(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
    halo: usize,
) -> Result<Option<HeightGrid>, GroundError> {
    let side = TILE_NODES + 2 * halo;
    let Some(own) = get(store, data, id)? else { return Ok(None) };
    let mut heights_m = vec![f32::NAN; side * side];
    let mut fill = |raster: &HeightGrid, dx: i32, dy: i32| {
        // The part of the window that a neighbour fills, and its start in the neighbour. Borders
        // are the same in both.
        let span = |d: i32| match d {
            -1 => (0..halo, TILE_NODES - 1 - halo),
            0 => (halo..side - halo, 0),
            _ => (side - halo..side, 1),
        };
        let ((columns, left), (rows, top)) = (span(dx), span(dy));
        for (r, row) in rows.enumerate() {
            for (c, column) in columns.clone().enumerate() {
                heights_m[row * side + column] = raster.raw()[(top + r) * TILE_NODES + left + c];
            }
        }
    };
    fill(&own, 0, 0);
    for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
        let Some(neighbour) = id.neighbour(dx, dy) else { continue };
        if let Some(raster) = get(store, data, neighbour)? {
            fill(&raster, dx, dy);
        }
    }
    Ok(Some(HeightGrid::new(side, side, heights_m)))
}

/// The heights of any tile with `halo` nodes on every side; `None` if the tile has no height or is
/// outside the data.
pub(crate) fn of_any_level(
    store: &dyn Artifacts,
    data: &DataTiles,
    id: TileId,
    halo: usize,
) -> Result<Option<HeightGrid>, GroundError> {
    match halo {
        _ if data.contains(id) => {
            Ok(FinestHeights::get(store, id)?.map(|heights| heights.with_halo(halo)))
        }
        0 => get(store, data, id),
        _ => with_halo(store, data, id, halo),
    }
}
