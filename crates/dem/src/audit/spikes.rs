//! Finds single samples far above or below all samples around them.

use serde::{Deserialize, Serialize};

/// A spike is at least this far beyond each of its neighbours: no slope of the earth is so long and
/// so steep on all sides. The limit grows with the spacing of samples, see [`STEEPNESS`].
const LEAST_M: f64 = 2000.0;
/// The limit per metre of spacing, for samples that are kilometres apart: on grids of half a
/// degree, islands are isolated samples in the ocean, but their slopes are less steep than this.
const STEEPNESS: f64 = 2.0 / 3.0;
/// The limit never exceeds this: no summit of the earth is as far above all of its surroundings,
/// including the bottom of the sea (Mauna Kea: some 9200 m).
const MOST_M: f64 = 9500.0;
/// A sample with fewer neighbours is not judged.
const FEWEST_NEIGHBOURS: usize = 3;
/// The number of spikes whose positions are kept.
const KEPT_SPIKES: usize = 3;

/// The least distance of a spike from all of its neighbours, for samples with this spacing.
pub(crate) fn limit_m(spacing_m: f64) -> f64 {
    (spacing_m * STEEPNESS).clamp(LEAST_M, MOST_M)
}

/// A single sample far beyond its neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Spike {
    pub(crate) row: usize,
    pub(crate) column: usize,
    pub(crate) height_m: f64,
    /// The value as stored in the file.
    pub(crate) stored: f64,
}

/// The number of spikes in some samples of a file, and the first spikes, row by row. Parts can be
/// merged in any order.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Spikes {
    pub(crate) count: u64,
    pub(crate) first: Vec<Spike>,
}

impl Spikes {
    pub(crate) fn add(&mut self, spike: Spike) {
        self.count += 1;
        self.keep(spike);
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        other.first.iter().for_each(|&spike| self.keep(spike));
    }

    fn keep(&mut self, spike: Spike) {
        let place = |spike: &Spike| (spike.row, spike.column);
        let at = self.first.partition_point(|known| place(known) < place(&spike));
        self.first.insert(at, spike);
        self.first.truncate(KEPT_SPIKES);
    }
}

/// The positions (column, row) in a rectangle whose samples may be spikes, by the neighbours inside
/// the rectangle. Inside the rim they are spikes; on the rim they can have neighbours outside.
pub(crate) fn candidates(heights_m: &[f64], columns: usize, limit_m: f64) -> Vec<[usize; 2]> {
    let size = [columns, heights_m.len() / columns];
    let mut found = Vec::new();
    for (row, line) in heights_m.chunks_exact(columns).enumerate() {
        let mut before = f64::NAN;
        for (column, &height_m) in line.iter().enumerate() {
            // Nearly all samples are close to the previous one, and need no further test.
            let is_near = (height_m - before).abs() <= limit_m;
            before = height_m;
            if is_near || height_m.is_nan() {
                continue;
            }
            let fewest = if is_on_rim(size, [column, row]) { 0 } else { FEWEST_NEIGHBOURS };
            if stands_alone(heights_m, columns, [column, row], (fewest, limit_m)) {
                found.push([column, row]);
            }
        }
    }
    found
}

/// Whether a position is in the first or last row or column of a rectangle.
pub(crate) fn is_on_rim(size: [usize; 2], at: [usize; 2]) -> bool {
    (0..2).any(|axis| at[axis] == 0 || at[axis] + 1 == size[axis])
}

/// Whether a sample of a rectangle is a spike, by the neighbours inside the rectangle.
pub(crate) fn is_spike(heights_m: &[f64], columns: usize, at: [usize; 2], limit_m: f64) -> bool {
    stands_alone(heights_m, columns, at, (FEWEST_NEIGHBOURS, limit_m))
}

/// Whether a sample lies beyond all of its neighbours, to the same side, of which there are at
/// least `fewest`; a sample without neighbours lies beyond all.
fn stands_alone(
    heights_m: &[f64],
    columns: usize,
    [column, row]: [usize; 2],
    (fewest, limit_m): (usize, f64),
) -> bool {
    let rows = heights_m.len() / columns;
    let own_m = heights_m[row * columns + column];
    let (mut low_m, mut high_m, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for r in row.saturating_sub(1)..(row + 2).min(rows) {
        for c in column.saturating_sub(1)..(column + 2).min(columns) {
            let height_m = heights_m[r * columns + c];
            if [c, r] != [column, row] && !height_m.is_nan() {
                (low_m, high_m) = (low_m.min(height_m), high_m.max(height_m));
                count += 1;
            }
        }
    }
    count >= fewest && (own_m < low_m - limit_m || own_m > high_m + limit_m)
}

#[cfg(test)]
#[path = "spikes_tests.rs"]
mod tests;
