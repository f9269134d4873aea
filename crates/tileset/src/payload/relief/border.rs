//! Slopes of the nodes on a tile's border.

#[cfg(feature = "write")]
use corniche_geom::{Cell, HeightGrid};

use super::{coefficients::NumberModel, wavelet::SIDE};
use crate::payload::{
    damage::{Damage, Result},
    range_coder::Bits,
};

/// Number of nodes on the border of a tile.
pub(crate) const BORDER_NODES: usize = 4 * (SIDE - 1);
/// Number of steps of a slope of 1. A step is 0.7 grey levels of 255 on level ground that is lit
/// from 45°, so rounding is not visible.
pub(crate) const STEPS_PER_ONE: f64 = 256.0;
/// Slopes have fewer steps than this; larger ones are clamped.
const MOST_STEPS: i64 = 1 << 20;

/// The index of a node in the list of border nodes: the north row, then the western and the eastern
/// node of each row, then the south row. `None` for other nodes.
pub(crate) fn index(column: usize, row: usize) -> Option<usize> {
    let last = SIDE - 1;
    match (column, row) {
        (column, row) if column > last || row > last => None,
        (column, 0) => Some(column),
        (column, row) if row == last => Some(SIDE + 2 * (last - 1) + column),
        (0, row) => Some(SIDE + 2 * (row - 1)),
        (column, row) if column == last => Some(SIDE + 2 * (row - 1) + 1),
        _ => None,
    }
}

/// Iterates over the nodes in the order of [`index`].
fn nodes() -> impl Iterator<Item = [usize; 2]> {
    let last = SIDE - 1;
    let north = (0..SIDE).map(|column| [column, 0]);
    let sides = (1..last).flat_map(move |row| [[0, row], [last, row]]);
    let south = (0..SIDE).map(move |column| [column, last]);
    north.chain(sides).chain(south)
}

/// Returns the slopes of the raster in whole steps.
#[cfg(feature = "write")]
pub(crate) fn of_raster(with_halo: &HeightGrid, cell: Cell) -> Vec<Option<[i32; 2]>> {
    let most = (MOST_STEPS - 1) as f64;
    let steps = |slope: f64| (slope * STEPS_PER_ONE).round().clamp(-most, most) as i32;
    nodes()
        .map(|[column, row]| {
            let at = [column + 1, row + 1];
            with_halo
                .has_height(at[0], at[1])
                .then(|| corniche_tin::gradient(with_halo, at, cell).map(steps))
        })
        .collect()
}

/// Codes the slopes as differences from those of the decoded heights.
pub(crate) fn code<B: Bits>(
    bits: &mut B,
    border: &mut [Option<[i32; 2]>],
    units: &[i64],
    mask: &[bool],
    factors: [i64; 2],
) -> Result<()> {
    let mut numbers = [const { NumberModel::new() }; 2];
    let mut around = [[0; 2]; 2];
    for ([column, row], slopes) in nodes().zip(border) {
        let there = mask[row * SIDE + column];
        if !there {
            *slopes = None;
            continue;
        }
        let given = slopes.unwrap_or_default();
        let mut found = [0; 2];
        for axis in 0..2 {
            let expected = expected([column, row], axis, units, mask, factors[axis]);
            let given = i64::from(given[axis]) - expected;
            let [before, earlier] = around[axis];
            let difference = numbers[axis].code(bits, 3 * before + 2 * earlier, given);
            around[axis] = [difference.abs().min(MOST_STEPS), before];
            let steps = expected + difference;
            Damage::invalid_if(steps.abs() >= MOST_STEPS, "a slope of the relief")?;
            found[axis] = steps as i32;
        }
        *slopes = Some(found);
    }
    Ok(())
}

/// Returns the slope expected from the decoded heights, in steps; `axis` is 0 for east, 1 for
/// north.
fn expected(
    [column, row]: [usize; 2],
    axis: usize,
    units: &[i64],
    mask: &[bool],
    factor: i64,
) -> i64 {
    let at = |column: usize, row: usize| {
        let inside = column < SIDE && row < SIDE && mask[row * SIDE + column];
        inside.then(|| units[row * SIDE + column])
    };
    // A column or row before the first has wrapped around, so it is beyond the last.
    let (low, high) = match axis {
        0 => (at(column.wrapping_sub(1), row), at(column + 1, row)),
        _ => (at(column, row + 1), at(column, row.wrapping_sub(1))),
    };
    let here = units[row * SIDE + column];
    let twice = match (low, high) {
        (Some(low), Some(high)) => high - low,
        (Some(low), None) => 2 * (here - low),
        (None, Some(high)) => 2 * (high - here),
        (None, None) => 0,
    };
    ((twice * factor + (1 << 15)) >> 16).clamp(1 - MOST_STEPS, MOST_STEPS - 1)
}
