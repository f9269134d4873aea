//! Points and the half-edges between them.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, cross};

use crate::segments::OrderedSegment;

/// Segments that meet only at their ends, as pairs of half-edges.
///
/// Half-edge `2 s` goes from the first to the second point of segment `s`, half-edge `2 s + 1`
/// back: its *twin*.
///
/// ```text
///            next ╲  ╱
///                  ╲╱ to            next: the first half-edge clockwise from the twin,
///                  ▲│ twin          so that the left side stays on the left
///        left face │▼
///                 from
/// ```
pub(crate) struct PlanarGraph {
    segments: Vec<OrderedSegment>,
    /// The next half-edge around the left face of each half-edge.
    next: Vec<u32>,
}

/// The first odd end of an outline, and the number of odd ends.
pub(crate) struct OddEnds {
    pub count: u64,
    pub first: LatticePoint,
}

impl PlanarGraph {
    /// Creates the graph. Fails if a point has an odd number of segments: the outline is open
    /// there.
    pub(crate) fn new(segments: Vec<OrderedSegment>) -> Result<Self, OddEnds> {
        let mut leaving: Vec<u32> = (0..2 * segments.len() as u32).collect();
        let origin = |half: u32| segments[half as usize / 2][half as usize % 2];
        let target = |half: u32| origin(half ^ 1);
        leaving.sort_unstable_by(|&a, &b| {
            let by_angle = || by_angle(origin(a), target(a), target(b));
            origin(a).cmp(&origin(b)).then_with(by_angle)
        });
        let mut next = vec![0; leaving.len()];
        let mut odd: Option<OddEnds> = None;
        for around in leaving.chunk_by(|&a, &b| origin(a) == origin(b)) {
            if around.len() % 2 == 1 {
                let first = origin(around[0]);
                odd.get_or_insert(OddEnds { count: 0, first }).count += 1;
            }
            // Angles ascend counter-clockwise, so the previous half-edge is the next one clockwise.
            let before = around.iter().cycle().skip(around.len() - 1);
            for (&half, &clockwise) in around.iter().zip(before) {
                next[half as usize ^ 1] = clockwise;
            }
        }
        match odd {
            Some(odd) => Err(odd),
            None => Ok(Self { segments, next }),
        }
    }

    pub(crate) fn segments(&self) -> &[OrderedSegment] {
        &self.segments
    }

    pub(crate) fn half_edges(&self) -> usize {
        self.next.len()
    }

    pub(crate) fn next(&self, half: usize) -> usize {
        self.next[half] as usize
    }

    pub(crate) fn origin(&self, half: usize) -> LatticePoint {
        self.segments[half / 2][half % 2]
    }

    pub(crate) fn target(&self, half: usize) -> LatticePoint {
        self.origin(half ^ 1)
    }
}

/// Orders directions from one point by angle, counter-clockwise from east. No two directions are
/// equal.
fn by_angle(from: LatticePoint, a: LatticePoint, b: LatticePoint) -> Ordering {
    let is_lower_half = |to: LatticePoint| to.v < from.v || (to.v == from.v && to.u < from.u);
    is_lower_half(a).cmp(&is_lower_half(b)).then_with(|| 0.cmp(&cross(from, a, b)))
}
