//! Compares reliefs with the rasters of their levels, and with those of neighbouring tiles.

use std::hash::{DefaultHasher, Hash, Hasher};

use corniche_geom::{Cell, HeightGrid, TILE_NODES, TileId};
use corniche_tileset::Relief;

use super::checks::{CheckId, Findings};

/// Half of a step of slopes, which are rounded to 256ths, plus a little, because slopes were
/// computed in two ways.
const HALF_STEP: f64 = 0.5 / 256.0 + 1e-9;
/// Slopes steeper than this are capped.
const STEEPEST: f64 = 4095.0;

/// A hash of the slopes along each border: north, south, west, east. The hashes of two tiles are
/// equal exactly if all slopes are, except in one case of 2^64.
pub(crate) fn borders(relief: &Relief) -> [u64; 4] {
    let last = TILE_NODES - 1;
    let of = |node: &dyn Fn(usize) -> [usize; 2]| {
        let mut hasher = DefaultHasher::new();
        for [column, row] in (0..=last).map(node) {
            relief.border_slope(column, row).map(|slope| slope.map(f64::to_bits)).hash(&mut hasher);
        }
        hasher.finish()
    };
    [of(&|k| [k, 0]), of(&|k| [k, last]), of(&|k| [0, k]), of(&|k| [last, k])]
}

/// The largest distance of displayed heights from the raster, in steps of the DEM's heights.
const MOST_STEPS: f64 = 0.4;

/// The tolerance of displayed slopes, east and north: both heights of a slope were low-pass
/// filtered over the step of the DEM. At gaps, a slope is the one to the next node.
pub(crate) fn may_move(step_m: f64, cell: Cell) -> [f64; 2] {
    cell.to_array().map(|side_m| 2.0 * MOST_STEPS * step_m / side_m)
}

/// Compares a relief with the raster of its level, which has a halo of one node on every side;
/// `slope_at` returns the slopes of the raster's ground, and slopes may differ by `may_move`.
pub(crate) fn verify(
    id: TileId,
    relief: &Relief,
    (with_halo, may_move): (&HeightGrid, [f64; 2]),
    slope_at: impl Fn([usize; 2]) -> [f64; 2],
    findings: &mut Findings,
) {
    for row in 0..TILE_NODES {
        for column in 0..TILE_NODES {
            let (wanted_m, found_m) =
                (with_halo.height(column + 1, row + 1), relief.heights().height(column, row));
            let holds = match (wanted_m, found_m) {
                (Some(wanted_m), Some(found_m)) => {
                    let (wanted_m, found_m) = (f64::from(wanted_m), f64::from(found_m));
                    let rounding_m = wanted_m.abs() * f64::from(f32::EPSILON);
                    (wanted_m - found_m).abs() <= relief.greatest_error_m() + rounding_m
                }
                (None, None) => true,
                _ => false,
            };
            look!(
                findings,
                Relief,
                holds,
                "tile {id}: the relief has {found_m:?} at node {column}, {row}, the DEM {wanted_m:?}; the relief states a bound of {} m",
                relief.greatest_error_m()
            );
            let found = relief.water().is_some_and(|water| water[row * TILE_NODES + column]);
            findings.look(CheckId::Relief, found == is_water(with_halo, [column, row]), || {
                let found = if found { "water" } else { "land" };
                format!(
                    "tile {id}: node {column}, {row} is {found} in the relief, but not in the DEM"
                )
            });
            let Some(found) = relief.border_slope(column, row) else { continue };
            let wanted = slope_at([column + 1, row + 1]);
            let holds = (0..2).all(|axis| {
                wanted[axis].abs() > STEEPEST
                    || (found[axis] - wanted[axis]).abs() <= HALF_STEP + may_move[axis]
            });
            look!(
                findings,
                Relief,
                holds,
                "tile {id}: the relief has slopes {found:?} at node {column}, {row}, the DEM {wanted:?}"
            );
        }
    }
}

/// Whether a node of the tile is water according to its heights: it lies at or below 0, and all
/// nodes around it that have a height, at least three, have the same height.
fn is_water(with_halo: &HeightGrid, [column, row]: [usize; 2]) -> bool {
    let around: Vec<f32> =
        (0..9).filter_map(|k| with_halo.height(column + k % 3, row + k / 3)).collect();
    let own_m = with_halo.height(column + 1, row + 1);
    own_m.is_some_and(|own_m| own_m <= 0.0)
        && around.len() > 3
        && around.iter().all(|height_m| Some(*height_m) == own_m)
}

#[cfg(test)]
#[path = "relief_tests.rs"]
mod tests;
