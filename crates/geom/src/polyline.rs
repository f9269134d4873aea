//! A line on the lattice: at least two points, and no two neighbours equal.

use crate::LatticePoint;

/// Why points do not make a [`Polyline`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a polyline needs two different points, got {distinct}")]
pub struct PolylineError {
    /// How many points were left after equal neighbours were merged.
    pub distinct: usize,
}

/// At least two lattice points, no two neighbours equal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Polyline {
    points: Vec<LatticePoint>,
}

impl Polyline {
    /// Takes the points in order; equal neighbours are merged into one.
    ///
    /// # Errors
    /// When fewer than two points are left.
    pub fn new(mut points: Vec<LatticePoint>) -> Result<Self, PolylineError> {
        points.dedup();
        if points.len() < 2 {
            Err(PolylineError { distinct: points.len() })
        } else {
            Ok(Self { points })
        }
    }

    /// The points, in order.
    #[must_use]
    pub fn points(&self) -> &[LatticePoint] {
        &self.points
    }

    /// The points, in order, as their vector.
    #[must_use]
    pub fn into_points(self) -> Vec<LatticePoint> {
        self.points
    }
}

#[cfg(test)]
#[path = "polyline_tests.rs"]
mod tests;
