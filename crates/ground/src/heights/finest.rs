//! The heights of a finest tile, as one artifact.

use corniche_dem::DemWindow;
use corniche_geom::{HeightGrid, TILE_NODES, TileId};
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_store::Artifacts;

use crate::GroundError;

/// The number of halo nodes on every side of a tile's heights: one for slopes at the border, and
/// one for the low-pass filter of the heights from which slopes are computed.
pub(crate) const HALO: usize = 2;

/// Columns and rows of the nodes that belong to a tile. Nodes on the east and south border belong
/// to the next tile, if there can be one.
#[must_use]
pub fn own_size(id: TileId) -> [usize; 2] {
    let last = (1_u32 << id.z()) - 1;
    [id.x(), id.y()].map(|at| TILE_NODES - usize::from(at < last))
}

/// Heights of a finest tile.
#[derive(Debug, Clone, PartialEq)]
pub struct FinestHeights {
    /// 261 × 261 nodes: the tile's own, borders included, and two more on every side.
    with_halo: HeightGrid,
    /// The tile's own nodes (257 × 257, row by row from the north) that are filled voids;
    /// ascending.
    pub filled: Vec<usize>,
}

impl FinestHeights {
    /// Cuts a tile out of a window in which its own north-west node is in column `left` and row
    /// `top`, both at least `HALO`. `None` if the tile itself has no height.
    #[must_use]
    pub fn cut(window: &DemWindow, left: usize, top: usize) -> Option<Self> {
        let own = |column: usize, row: usize| (left + column, top + row);
        let has_height = (0..TILE_NODES).any(|row| {
            (0..TILE_NODES).any(|column| {
                let (column, row) = own(column, row);
                window.heights.has_height(column, row)
            })
        });
        if !has_height {
            return None;
        }
        let is_filled = |&node: &usize| {
            let (column, row) = own(node % TILE_NODES, node / TILE_NODES);
            window.is_filled[row * window.heights.columns() + column]
        };
        let filled = if window.is_filled.is_empty() {
            Vec::new()
        } else {
            (0..TILE_NODES * TILE_NODES).filter(is_filled).collect()
        };
        let side = TILE_NODES + 2 * HALO;
        let with_halo = window.heights.window(left - HALO, top - HALO, side, side);
        Some(Self { with_halo, filled })
    }

    /// The tile's own nodes, borders included, and `halo` more nodes on every side, at most `HALO`.
    #[must_use]
    pub fn with_halo(&self, halo: usize) -> HeightGrid {
        self.with_halo.inner(HALO - halo)
    }

    /// Stores the heights of a tile.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn put(&self, store: &dyn Artifacts, id: TileId) -> Result<(), GroundError> {
        let mut bytes = height_bytes(&self.with_halo);
        bytes.extend(self.filled.iter().flat_map(|&node| (node as u32).to_le_bytes()));
        Ok(store.put(ArtifactKind::Heights.of_tile(id), &bytes)?)
    }

    /// Records that a tile has no height, because a missing artifact means "not computed".
    pub(crate) fn put_none(store: &dyn Artifacts, id: TileId) -> Result<(), GroundError> {
        Ok(store.put(ArtifactKind::Heights.of_tile(id), &[])?)
    }

    /// Reads the heights of a tile; `None` if it has none. The tile must be one of the data's
    /// tiles.
    ///
    /// # Errors
    /// See [`GroundError`].
    pub fn get(store: &dyn Artifacts, id: TileId) -> Result<Option<Self>, GroundError> {
        let key = ArtifactKind::Heights.of_tile(id);
        let missing = || ArtifactError::Missing {
            what: format!("the heights of tile {id}"),
            step: "heights",
        };
        let bytes = store.get(key)?.ok_or_else(missing)?;
        if bytes.is_empty() {
            return Ok(None);
        }
        let (heights, filled) = bytes
            .split_at_checked((TILE_NODES + 2 * HALO).pow(2) * 4)
            .ok_or_else(|| damaged(key, &"its data end early"))?;
        let filled = filled.as_chunks().0.iter();
        let filled = filled.map(|&node| u32::from_le_bytes(node) as usize).collect();
        Ok(Some(Self { with_halo: grid_of(heights, TILE_NODES + 2 * HALO), filled }))
    }
}

/// Encodes a grid's heights, little-endian, row by row.
pub(crate) fn height_bytes(grid: &HeightGrid) -> Vec<u8> {
    grid.raw().iter().flat_map(|height_m| height_m.to_le_bytes()).collect()
}

/// The square grid with `side` nodes a side that `height_bytes` encoded.
#[must_use]
pub fn grid_of(bytes: &[u8], side: usize) -> HeightGrid {
    let heights_m = bytes.as_chunks().0.iter().map(|&height_m| f32::from_le_bytes(height_m));
    HeightGrid::new(side, side, heights_m.collect())
}
