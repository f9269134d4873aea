//! Creates a tile's relief section from the raster of its level, and smooths the terraces of
//! heights in whole metres.
//!
//! ```text
//!   stored    ▁▁▁▁▁▁████████████   whole metres: level, a metre up in one cell, level
//!   shown     ▁▁▁▁▁▂▆███████████   each node goes to the mean of those around it, but not far
//! ```
//!
//! Level ground in whole metres has slopes of 0 and, along contour lines, slopes of a metre in one
//! or two cells: ripples in the light. A mean of neighbours removes the ripples, but on rough
//! ground it removes form, too. Rounding changes a height by at most half a step; a node that is
//! farther from the mean of its neighbours is so because of the ground's form. So nodes near the
//! mean move to it, nodes farther away stay, and the transition between them is continuous.

use corniche_geom::{HeightGrid, TileId};
use corniche_tileset::{EncodeError, Relief};

use crate::{BuildError, context::BuildContext};

/// The relief of a tile, if tiles of its level have one. `with_two` has two nodes of halo on every
/// side; `step_m` is the smallest height step that the DEM can represent.
pub(crate) fn of_tile(
    context: &BuildContext<'_>,
    id: TileId,
    with_two: &HeightGrid,
    step_m: f64,
) -> Result<Option<Relief>, BuildError> {
    if !context.has_relief(id) {
        return Ok(None);
    }
    let levels = context.levels;
    let cell = levels.frame().level_cell(id.z());
    let shown = low_passed(with_two, step_m);
    let relief = Relief::of_heights(&with_two.inner(1), &shown, cell, levels.quantum_m()).map_err(
        |what| EncodeError::Unencodable { tile: id, section: "relief section".into(), what },
    )?;
    Ok(Some(relief))
}

/// Nodes that are at least this many steps from the mean of their neighbours stay. Measured in
/// `docs/lab/measured.md`.
const STAYS_STEPS: f64 = 0.8;

/// Returns the grid without its outermost nodes, with each height moved towards the mean of the
/// nine nodes around it, weighted 1 2 1 along both axes. `step_m` is the smallest height step that
/// the DEM can represent; at 0 nothing moves. A height depends on these nine nodes alone, so tiles
/// agree on the nodes that they share. No height moves by more than half of [`STAYS_STEPS`].
pub(crate) fn low_passed(heights: &HeightGrid, step_m: f64) -> HeightGrid {
    let stays_m = STAYS_STEPS * step_m;
    HeightGrid::from_fn(heights.columns() - 2, heights.rows() - 2, |column, row| {
        let Some(own_m) = heights.height(column + 1, row + 1) else { return f32::NAN };
        let own_m = f64::from(own_m);
        let mut from_mean_m = 0.0;
        for (rows, row_weight) in [(0, 1.0), (1, 2.0), (2, 1.0)] {
            for (columns, weight) in [(0, 1.0), (1, 2.0), (2, 1.0)] {
                // A neighbour without a height counts as one of the same height.
                let height_m =
                    heights.height(column + columns, row + rows).map_or(own_m, f64::from);
                from_mean_m += row_weight * weight * (height_m - own_m) / 16.0;
            }
        }
        let moves_m = from_mean_m.abs().min((stays_m - from_mean_m.abs()).max(0.0));
        (own_m + moves_m.copysign(from_mean_m)) as f32
    })
}

#[cfg(test)]
#[path = "relief_tests.rs"]
mod tests;
