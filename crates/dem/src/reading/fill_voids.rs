//! Fills voids from the data around them.

use corniche_geom::Cell;

/// The eight directions in a fixed order, clockwise from north: columns east, rows south.
const DIRECTIONS: [[i64; 2]; 8] =
    [[0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1]];

/// Fills void nodes (NaN) of the inside of a window from data within `reach` cells.
///
/// ```text
///   ·   ·   8       A void is filled if and only if data is found within `reach` cells
///     ·     |   /   in each of the eight directions. Its height is the mean of those eight,
///   7 ─ ─ ─ ? ─ 3   weighted by inverse distance in working metres: a step east is as long
///     /   / | ·     as the cell's east side. Only data count, never filled nodes, so the
///   6   ·   5   4   result does not depend on the window that is read.
/// ```
///
/// `heights_m` has `columns` nodes per row, with `reach` nodes of halo on every side. Returns the
/// indices of the filled nodes within it, and their heights.
pub(crate) fn fill(
    heights_m: &[f32],
    columns: usize,
    reach: usize,
    cell: Cell,
) -> Vec<(usize, f32)> {
    let rows = heights_m.len() / columns.max(1);
    let mut filled = Vec::new();
    for row in reach..rows.saturating_sub(reach) {
        for column in reach..columns.saturating_sub(reach) {
            let at = row * columns + column;
            if heights_m[at].is_nan() {
                filled.extend(
                    fill_node(heights_m, columns, at, reach, cell).map(|height_m| (at, height_m)),
                );
            }
        }
    }
    filled
}

fn fill_node(
    heights_m: &[f32],
    columns: usize,
    at: usize,
    reach: usize,
    cell: Cell,
) -> Option<f32> {
    let (mut weights, mut sum) = (0.0, 0.0);
    for [east, south] in DIRECTIONS {
        let stride = south * columns as i64 + east;
        // In units of the cell's north side: only the ratios of weights matter.
        let length = (east as f64 * (cell.east_m / cell.north_m)).hypot(south as f64);
        let found = (1..=reach as i64).find_map(|cells| {
            let height_m = heights_m[(at as i64 + cells * stride) as usize];
            (!height_m.is_nan()).then_some((cells, height_m))
        });
        let (cells, height_m) = found?;
        let weight = 1.0 / (cells as f64 * length);
        weights += weight;
        sum += weight * f64::from(height_m);
    }
    Some((sum / weights) as f32)
}

#[cfg(test)]
#[path = "fill_voids_tests.rs"]
mod tests;
