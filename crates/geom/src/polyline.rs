//! A line on the lattice: at least two points, without equal neighbours.

use crate::LatticePoint;

/// Why points cannot form a [`Polyline`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a polyline needs two different points, got {distinct}")]
pub struct PolylineError {
    /// The number of points that were left after equal neighbours were merged.
    pub distinct: usize,
}

/// At least two lattice points, without equal neighbours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Polyline {
    points: Vec<LatticePoint>,
}

impl Polyline {
    /// Creates a line from points in order; equal neighbours are merged into one.
    ///
    /// # Errors
    /// When fewer than two points remain.
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

    /// Returns the vector of the points, in order.
    #[must_use]
    pub fn into_points(self) -> Vec<LatticePoint> {
        self.points
    }
}

#[cfg(test)]
#[path = "polyline_tests.rs"]
mod tests;
