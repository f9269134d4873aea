//! Detects nodes of level water.

use corniche_geom::HeightGrid;

use super::wavelet::SIDE;

/// The smallest number of neighbours that is conclusive.
const LEAST_NEIGHBOURS: usize = 3;

/// Returns for each of the tile's own nodes whether it is water: it is at or below 0 m, and its
/// neighbours (all eight, or those that have a height) have exactly the same height. All tiles that
/// have a node see the same neighbours.
pub(crate) fn of_raster(with_halo: &HeightGrid) -> Vec<bool> {
    let mut water = Vec::with_capacity(SIDE * SIDE);
    for row in 1..=SIDE {
        for column in 1..=SIDE {
            let own_m = with_halo.height(column, row).filter(|height_m| *height_m <= 0.0);
            water.push(own_m.is_some_and(|own_m| is_level(with_halo, [column, row], own_m)));
        }
    }
    water
}

#[expect(clippy::float_cmp, reason = "heights must be exactly equal")]
fn is_level(with_halo: &HeightGrid, [column, row]: [usize; 2], own_m: f32) -> bool {
    let mut neighbours = 0;
    for (east, south) in [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2)] {
        match with_halo.height(column + east - 1, row + south - 1) {
            Some(height_m) if height_m == own_m => neighbours += 1,
            Some(_) => return false,
            None => {}
        }
    }
    neighbours >= LEAST_NEIGHBOURS
}
