//! The spacing of the lattice to which points of layers are snapped on each level.

use corniche_geom::GridFrame;

/// On the finest level, points of layers are on a lattice of at most this spacing,
/// metres, because they may be viewed from near.
const FINEST_STEP_M: f64 = 0.1;
/// On other levels, a cell has at least this many lattice steps. Tiles are drawn while their cells
/// look two pixels wide at most, so a point moves by a quarter of a pixel along each axis. With 16
/// steps, level 0 of Liechtenstein had 3.4 times the points of areas, and no picture differed from
/// those with 4 by more than two pixels.
const STEPS_PER_CELL: f64 = 4.0;

/// The spacing of the lattice for points of a level, in steps of the package's lattice: a power of
/// two.
#[must_use]
pub fn points_step(frame: &GridFrame, level: u8) -> i64 {
    let widest_m = if level == frame.max_level() {
        FINEST_STEP_M
    } else {
        frame.level_cell(level).shorter_m() / STEPS_PER_CELL
    };
    let steps = (widest_m / frame.lattice_step_m()).max(1.0);
    1 << (steps.log2().floor() as u32).min(40)
}
