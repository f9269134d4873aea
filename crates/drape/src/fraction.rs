//! Exact comparison of positions along a segment.

use std::cmp::Ordering;

use corniche_geom::LatticePoint;

/// A position along a segment p → q as an exact fraction: 0 at p, 1 at q.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fraction {
    numerator: i128,
    /// The denominator, above 0.
    denominator: i128,
}

impl Fraction {
    pub(crate) const ZERO: Self = Self { numerator: 0, denominator: 1 };
    pub(crate) const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// Creates numerator / denominator; the denominator must not be 0.
    pub(crate) fn new(numerator: i128, denominator: i128) -> Self {
        if denominator < 0 {
            Self { numerator: -numerator, denominator: -denominator }
        } else {
            Self { numerator, denominator }
        }
    }

    /// The position of `point`, which is on the line through p and q, along the segment.
    pub(crate) fn of_point([p, q]: [LatticePoint; 2], point: LatticePoint) -> Self {
        let (du, dv) = (q.u - p.u, q.v - p.v);
        if du.unsigned_abs() >= dv.unsigned_abs() {
            Self::new(i128::from(point.u - p.u), i128::from(du))
        } else {
            Self::new(i128::from(point.v - p.v), i128::from(dv))
        }
    }

    /// The nearest f64, or a neighbour of it.
    pub(crate) fn to_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

impl PartialEq for Fraction {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Fraction {}

impl PartialOrd for Fraction {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Fraction {
    /// Compares whole parts, then the reciprocals of the remainders, as in Euclid's algorithm: the
    /// cross products of two fractions with numbers up to 2^115 would not fit in 128 bits.
    fn cmp(&self, other: &Self) -> Ordering {
        let (mut a, mut b) = (*self, *other);
        loop {
            let (whole_a, whole_b) =
                (a.numerator.div_euclid(a.denominator), b.numerator.div_euclid(b.denominator));
            if whole_a != whole_b {
                return whole_a.cmp(&whole_b);
            }
            let (rest_a, rest_b) =
                (a.numerator.rem_euclid(a.denominator), b.numerator.rem_euclid(b.denominator));
            match (rest_a, rest_b) {
                (0, 0) => return Ordering::Equal,
                (0, _) => return Ordering::Less,
                (_, 0) => return Ordering::Greater,
                // For remainders between 0 and 1, x < y if 1/y < 1/x.
                _ => {
                    let next_a = Self { numerator: b.denominator, denominator: rest_b };
                    b = Self { numerator: a.denominator, denominator: rest_a };
                    a = next_a;
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "fraction_tests.rs"]
mod tests;
