//! The size of a grid cell of the finest level, east and north, and the lattice that follows from it.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A lattice step is at most this long.
const LATTICE_STEP_M: f64 = 0.001;

/// The finest level's cell: a rectangle, metres east and north.
///
/// The lattice is square, so a frame takes only cells whose east side is a whole number of its steps:
/// [`Cell::fitted`] gives the nearest one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Cell {
    /// West to east, metres.
    pub east_m: f64,
    /// South to north, metres.
    pub north_m: f64,
}

impl Cell {
    /// The cell nearest to this one whose east side is a whole number of lattice steps: it moves by half a step at most.
    /// The north side stays. A cell with unusable sides is given back as it is.
    #[must_use]
    pub fn fitted(self) -> Self {
        if !self.is_usable() {
            return self;
        }
        let step_m = self.lattice_step_m();
        Self { east_m: (self.east_m / step_m).round().max(1.0) * step_m, ..self }
    }

    /// The shorter side. It is used wherever one length represents the cell.
    #[must_use]
    pub fn shorter_m(self) -> f64 {
        self.east_m.min(self.north_m)
    }

    /// East and north.
    #[must_use]
    pub fn to_array(self) -> [f64; 2] {
        [self.east_m, self.north_m]
    }

    /// A cell `factor` times as long on both sides.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { east_m: self.east_m * factor, north_m: self.north_m * factor }
    }

    pub(crate) fn is_usable(self) -> bool {
        self.to_array().iter().all(|side_m| (0.001..=1e6).contains(side_m))
    }

    /// The north side is 2^bits lattice steps.
    pub(crate) fn lattice_bits(self) -> u8 {
        let mut bits = 0;
        while self.north_m / f64::from(1_u32 << bits) > LATTICE_STEP_M {
            bits += 1;
        }
        bits
    }

    /// Length of a lattice step: the north side over a power of two, at most a millimetre.
    pub(crate) fn lattice_step_m(self) -> f64 {
        self.north_m / (1_u64 << self.lattice_bits()) as f64
    }
}

impl From<f64> for Cell {
    /// A square cell.
    fn from(side_m: f64) -> Self {
        Self { east_m: side_m, north_m: side_m }
    }
}

impl From<[f64; 2]> for Cell {
    /// The cell with these sides, east and north.
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
    /// "30 m" for a square, else "20 × 30 m": east, then north.
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
