//! Rectangles along the axes, with f64 coordinates or on the lattice.

use serde::{Deserialize, Serialize};

use crate::LatticePoint;

/// An axis-parallel rectangle in a plane coordinate system, in metres or in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// West edge.
    pub min_x: f64,
    /// South edge.
    pub min_y: f64,
    /// East edge.
    pub max_x: f64,
    /// North edge.
    pub max_y: f64,
}

impl Bounds {
    /// The rectangle without points; [`Bounds::include`] extends it.
    pub const EMPTY: Self = Self {
        min_x: f64::INFINITY,
        min_y: f64::INFINITY,
        max_x: f64::NEG_INFINITY,
        max_y: f64::NEG_INFINITY,
    };

    /// Returns the smallest rectangle around the finite points; empty if there are none.
    #[must_use]
    pub fn around<'a>(points: impl IntoIterator<Item = &'a [f64; 2]>) -> Self {
        let mut bounds = Self::EMPTY;
        let is_finite = |point: &&[f64; 2]| point[0].is_finite() && point[1].is_finite();
        points.into_iter().filter(is_finite).for_each(|&point| bounds.include(point));
        bounds
    }

    /// Extends the rectangle to contain `point`.
    pub fn include(&mut self, point: [f64; 2]) {
        let [x, y] = point;
        *self = self.union(&Self { min_x: x, min_y: y, max_x: x, max_y: y });
    }

    /// Whether the rectangle contains no point at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(self.min_x <= self.max_x && self.min_y <= self.max_y)
    }

    /// Returns the rectangle extended by `margin_x` on the west and on the east side, and by
    /// `margin_y` on the south and on the north side.
    #[must_use]
    pub fn expanded(&self, [margin_x, margin_y]: [f64; 2]) -> Self {
        Self {
            min_x: self.min_x - margin_x,
            min_y: self.min_y - margin_y,
            max_x: self.max_x + margin_x,
            max_y: self.max_y + margin_y,
        }
    }

    /// Returns the smallest rectangle around both rectangles.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min_x: self.min_x.min(other.min_x),
            min_y: self.min_y.min(other.min_y),
            max_x: self.max_x.max(other.max_x),
            max_y: self.max_y.max(other.max_y),
        }
    }

    /// Returns the intersection of both rectangles; if it is empty, its sides are swapped.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            min_x: self.min_x.max(other.min_x),
            min_y: self.min_y.max(other.min_y),
            max_x: self.max_x.min(other.max_x),
            max_y: self.max_y.min(other.max_y),
        }
    }

    /// Whether a point is inside or on the edge.
    #[must_use]
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        (self.min_x..=self.max_x).contains(&x) && (self.min_y..=self.max_y).contains(&y)
    }

    /// Whether the two rectangles share a point, edges included.
    #[must_use]
    pub fn intersects(&self, other: &Self) -> bool {
        self.min_x <= other.max_x
            && other.min_x <= self.max_x
            && self.min_y <= other.max_y
            && other.min_y <= self.max_y
    }

    /// Returns the centre of the rectangle.
    #[must_use]
    pub fn center(&self) -> [f64; 2] {
        [f64::midpoint(self.min_x, self.max_x), f64::midpoint(self.min_y, self.max_y)]
    }

    /// The length from west to east.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.max_x - self.min_x
    }

    /// The length from south to north.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.max_y - self.min_y
    }

    /// Describes a rectangle in degrees as text.
    #[must_use]
    pub fn degrees_text(&self) -> String {
        let [west, south, east, north] = self.to_array();
        format!("longitudes {west:.5} to {east:.5} and latitudes {south:.5} to {north:.5}")
    }

    /// Returns the rectangle as `[min_x, min_y, max_x, max_y]`.
    #[must_use]
    pub fn to_array(self) -> [f64; 4] {
        [self.min_x, self.min_y, self.max_x, self.max_y]
    }
}

/// An axis-parallel rectangle on the lattice, edges included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct LatticeBounds {
    /// South-west corner.
    pub min: LatticePoint,
    /// North-east corner.
    pub max: LatticePoint,
}

impl LatticeBounds {
    /// Whether `point` is inside or on the edge.
    #[must_use]
    pub fn contains(&self, point: LatticePoint) -> bool {
        (self.min.u..=self.max.u).contains(&point.u) && (self.min.v..=self.max.v).contains(&point.v)
    }

    /// Whether a point of the rectangle is on its edge.
    #[must_use]
    pub fn has_on_border(&self, point: LatticePoint) -> bool {
        let Self { min, max } = self;
        [min.u, max.u].contains(&point.u) || [min.v, max.v].contains(&point.v)
    }

    /// Returns the rectangle extended by `margin` steps on every side.
    #[must_use]
    pub fn expanded(&self, margin: i64) -> Self {
        Self {
            min: LatticePoint::new(self.min.u - margin, self.min.v - margin),
            max: LatticePoint::new(self.max.u + margin, self.max.v + margin),
        }
    }

    /// Returns the rectangle of one point.
    #[must_use]
    pub fn at(point: LatticePoint) -> Self {
        Self { min: point, max: point }
    }

    /// Returns the smallest rectangle around `points`; `None` without points.
    #[must_use]
    pub fn around(points: &[LatticePoint]) -> Option<Self> {
        points.iter().copied().map(Self::at).reduce(|bounds, point| bounds.union(&point))
    }

    /// Returns the smallest rectangle around both rectangles.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: LatticePoint::new(self.min.u.min(other.min.u), self.min.v.min(other.min.v)),
            max: LatticePoint::new(self.max.u.max(other.max.u), self.max.v.max(other.max.v)),
        }
    }

    /// Returns the intersection of both rectangles. If it is empty, its corners are swapped, and it
    /// contains no point.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            min: LatticePoint::new(self.min.u.max(other.min.u), self.min.v.max(other.min.v)),
            max: LatticePoint::new(self.max.u.min(other.max.u), self.max.v.min(other.max.v)),
        }
    }

    /// Whether the two rectangles share a point, edges included.
    #[must_use]
    pub fn intersects(&self, other: &Self) -> bool {
        self.min.u <= other.max.u
            && other.min.u <= self.max.u
            && self.min.v <= other.max.v
            && other.min.v <= self.max.v
    }
}
