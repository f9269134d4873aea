//! A position in plan, in whole steps of a package's lattice.

use serde::{Deserialize, Serialize};

/// A position in plan, in whole lattice steps of a [`GridFrame`](crate::GridFrame): `u` east, `v`
/// north.
///
/// All geometry of a package in plan is on this lattice, so orientation and side tests are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct LatticePoint {
    /// Number of steps east of node (0, 0).
    pub u: i64,
    /// Number of steps north of node (0, 0).
    pub v: i64,
}

impl LatticePoint {
    /// Returns the point `u` steps east and `v` steps north of the frame's node (0, 0).
    #[must_use]
    pub const fn new(u: i64, v: i64) -> Self {
        Self { u, v }
    }

    /// Steps east and north of node (0, 0) as f64; exact below 2^53.
    #[must_use]
    pub fn in_steps(self) -> [f64; 2] {
        [self.u as f64, self.v as f64]
    }

    /// Returns the lattice point nearest to the position at a fraction of the way to `other`.
    #[must_use]
    pub fn share_of_way(self, other: Self, share: f64) -> Self {
        let along = |from: i64, to: i64| from + ((to - from) as f64 * share).round() as i64;
        Self::new(along(self.u, other.u), along(self.v, other.v))
    }

    /// The distance to `other` in lattice steps.
    #[must_use]
    pub fn distance_steps(self, other: Self) -> f64 {
        ((self.u - other.u) as f64).hypot((self.v - other.v) as f64)
    }
}
