//! The size of a grid cell of the finest level, east and north, and the lattice that follows from
//! it.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The largest length of a lattice step.
const LATTICE_STEP_M: f64 = 0.001;

/// The finest level's cell: a rectangle, in metres east and north.
///
/// The lattice is square, so a frame only accepts cells whose east side is a whole number of its
/// steps: [`Cell::fitted`] returns the nearest one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Cell {
    /// Length from west to east in metres.
    pub east_m: f64,
    /// Length from south to north in metres.
    pub north_m: f64,
}

impl Cell {
    /// Returns the nearest cell whose east side is a whole number of lattice steps: the side
    /// changes by at most half a step. The north side does not change. A cell with unusable sides
    /// is returned unchanged.
    #[must_use]
    pub fn fitted(self) -> Self {
        if !self.is_usable() {
            return self;
        }
        let step_m = self.lattice_step_m();
        Self { east_m: (self.east_m / step_m).round().max(1.0) * step_m, ..self }
    }

    /// The shorter side, which is used wherever one length represents the cell.
    #[must_use]
    pub fn shorter_m(self) -> f64 {
        self.east_m.min(self.north_m)
    }

    /// The lengths east and north.
    #[must_use]
    pub fn to_array(self) -> [f64; 2] {
        [self.east_m, self.north_m]
    }

    /// Returns a cell with both sides `factor` times as long.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { east_m: self.east_m * factor, north_m: self.north_m * factor }
    }

    pub(crate) fn is_usable(self) -> bool {
        self.to_array().iter().all(|side_m| (0.001..=1e6).contains(side_m))
    }

    /// The number of bits b for which the north side is 2^b lattice steps.
    pub(crate) fn lattice_bits(self) -> u8 {
        let mut bits = 0;
        while self.north_m / f64::from(1_u32 << bits) > LATTICE_STEP_M {
            bits += 1;
        }
        bits
    }

    /// The length of a lattice step: the north side divided by a power of two, at most a
    /// millimetre.
    pub(crate) fn lattice_step_m(self) -> f64 {
        self.north_m / (1_u64 << self.lattice_bits()) as f64
    }
}

impl From<f64> for Cell {
    /// Returns a square cell.
    fn from(side_m: f64) -> Self {
        Self { east_m: side_m, north_m: side_m }
    }
}

impl From<[f64; 2]> for Cell {
    /// Returns the cell with these sides, east and north.
    fn from([east_m, north_m]: [f64; 2]) -> Self {
        Self { east_m, north_m }
    }
}

impl From<Cell> for [f64; 2] {
    fn from(cell: Cell) -> Self {
        cell.to_array()
    }
}

impl fmt::Display for Cell {
    /// Prints "30 m" for a square, else "20 × 30 m": east, then north.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { east_m, north_m } = self;
        if east_m.to_bits() == north_m.to_bits() {
            write!(f, "{north_m} m")
        } else {
            write!(f, "{east_m} × {north_m} m")
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "cell_tests.rs"]
mod tests;
