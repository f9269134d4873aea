//! A rectangle of samples, its intersections and unions.

/// A rectangle of samples: `min` inclusive, `max` exclusive, as `[column, row]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SampleRect {
    pub(crate) min: [i64; 2],
    pub(crate) max: [i64; 2],
}

impl SampleRect {
    pub(crate) fn columns(&self) -> usize {
        (self.max[0] - self.min[0]).max(0) as usize
    }

    pub(crate) fn rows(&self) -> usize {
        (self.max[1] - self.min[1]).max(0) as usize
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.columns() == 0 || self.rows() == 0
    }

    pub(crate) fn intersection(&self, other: &Self) -> Self {
        let low = |axis: usize| self.min[axis].max(other.min[axis]);
        let high = |axis: usize| self.max[axis].min(other.max[axis]);
        Self { min: [low(0), low(1)], max: [high(0), high(1)] }
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        let low = |axis: usize| self.min[axis].min(other.min[axis]);
        let high = |axis: usize| self.max[axis].max(other.max[axis]);
        Self { min: [low(0), low(1)], max: [high(0), high(1)] }
    }
}
