//! Computes how finely each band is quantised, from its effect on slopes.

use corniche_geom::Cell;

use super::head::{BANDS, MOST_EXPONENT, MOST_FACTOR, MOST_STEP};

/// The quantisation steps as slopes: a change of one coefficient by a step changes slopes by this
/// value, as the root of the sum of squares over all nodes. The smooth band comes first, then the
/// divisions from the coarsest to the finest.
///
/// Equal values for all bands would need the fewest bytes for an error. But errors of coarse bands
/// are waves of many cells, and on smooth ground these are more visible than noise; and coarse
/// bands have few numbers. So the steps of coarse bands are a tenth of the finest: 5 % more bytes,
/// and half of the error on smooth ground. With these steps the error of shading is 2.4 to 3.6 grey
/// levels of 255.
const SLOPE_STEPS: [f64; 1 + super::wavelet::LEVELS] = [0.009, 0.009, 0.011, 0.027, 0.065, 0.1];

/// The effect of a coefficient of 1 on slopes east and slopes north, as sums of squares over all
/// nodes, for a node spacing of 1. The smooth band comes first, then the rough bands of the
/// coarsest division and so on, in the order of the steps in the head: rough from west to east,
/// from north to south, in both directions. The values were computed by transforming back one
/// coefficient in the middle of each band; the test `weights_are_those_of_the_transform` checks
/// them.
pub(crate) const WEIGHTS: [[f64; 2]; BANDS] = [
    [1.303, 1.303],
    [2.615, 0.3675],
    [0.3675, 2.615],
    [0.7376, 0.7376],
    [2.481, 0.3625],
    [0.3625, 2.481],
    [0.7065, 0.7065],
    [2.220, 0.3593],
    [0.3593, 2.220],
    [0.6551, 0.6551],
    [1.708, 0.3745],
    [0.3745, 1.708],
    [0.5726, 0.5726],
    [0.6328, 0.4492],
    [0.4492, 0.6328],
    [0.3032, 0.3032],
];

/// The exponent of the unit: the largest power of two that is at most a 512th of the cell, but at
/// least a 64th of the height step, so that all heights of a package have few enough units.
pub(crate) fn unit_exponent(cell: Cell, quantum_m: f64) -> i32 {
    let below = |length_m: f64| {
        // This is the exponent of a normal number; other numbers do not occur as cells or steps.
        ((length_m.to_bits() >> 52) & 0x7ff) as i32 - 1023
    };
    let fine = below(cell.shorter_m()) - 9;
    fine.max(below(quantum_m) - 6).clamp(-MOST_EXPONENT, MOST_EXPONENT)
}

/// The steps of all bands, in units.
pub(crate) fn of_cell(cell: Cell, unit_m: f64) -> [i64; BANDS] {
    std::array::from_fn(|band| {
        let ([east, north], slope_step) = (WEIGHTS[band], SLOPE_STEPS[band.div_ceil(3)]);
        let slopes = east / (cell.east_m * cell.east_m) + north / (cell.north_m * cell.north_m);
        let step = slope_step / slopes.sqrt() / unit_m;
        (step.round() as u64).clamp(1, MOST_STEP) as i64
    })
}

/// The slope factors of the head.
pub(crate) fn slope_factors(cell: Cell, unit_m: f64) -> [i64; 2] {
    cell.to_array().map(|side_m| {
        let factor = super::border::STEPS_PER_ONE * unit_m / (2.0 * side_m) * 65_536.0;
        (factor.round() as u64).min(MOST_FACTOR) as i64
    })
}
