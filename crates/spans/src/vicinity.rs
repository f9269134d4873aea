//! The surroundings of bridges and tunnels: the roads that can carry, touch or cross them.

use corniche_geom::LatticePoint;
use rstar::{AABB, RTree, primitives::Rectangle};

/// The surroundings of some segments of bridges and tunnels, and of the nodes on them.
#[derive(Debug)]
pub struct Vicinity(RTree<Rectangle<[f64; 2]>>);

impl Vicinity {
    /// Returns the surroundings: everything near `segments`, or within `reach` lattice steps of
    /// `nodes` along both axes.
    #[must_use]
    pub fn new(
        segments: impl Iterator<Item = [LatticePoint; 2]>,
        nodes: impl Iterator<Item = LatticePoint>,
        reach: f64,
    ) -> Self {
        let of_segment =
            |[a, b]: [LatticePoint; 2]| Rectangle::from_corners(a.in_steps(), b.in_steps());
        let around = |node: LatticePoint| {
            let [u, v] = node.in_steps();
            Rectangle::from_corners([u - reach, v - reach], [u + reach, v + reach])
        };
        Self(RTree::bulk_load(segments.map(of_segment).chain(nodes.map(around)).collect()))
    }

    /// Whether a segment of a road may cross or touch one of the bridges or tunnels.
    #[must_use]
    pub fn may_meet(&self, [a, b]: [LatticePoint; 2]) -> bool {
        let own = AABB::from_corners(a.in_steps(), b.in_steps());
        self.0.locate_in_envelope_intersecting(&own).next().is_some()
    }
}

#[cfg(test)]
#[path = "vicinity_tests.rs"]
mod tests;
