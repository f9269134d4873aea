//! Boxes in a plane, found by where they are: what is looked at grows with what lies there, not with all there is.

use corniche_geom::Work;
use rstar::{
    AABB, RTree,
    primitives::{GeomWithData, Rectangle},
};

/// So few boxes are looked at one by one: a tree of them costs more than it saves.
const FEW: usize = 32;

/// The boxes around some things, which are numbered from 0.
pub(crate) enum NearIndex {
    Few(usize),
    Many(RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>),
}

impl NearIndex {
    /// Each thing is given by two places; its box is the one around both.
    pub(crate) fn new(corners: impl ExactSizeIterator<Item = [[f64; 2]; 2]>) -> Self {
        if corners.len() <= FEW {
            return Self::Few(corners.len());
        }
        let boxes = corners
            .enumerate()
            .map(|(number, [a, b])| GeomWithData::new(Rectangle::from_corners(a, b), number));
        Self::Many(RTree::bulk_load(boxes.collect()))
    }

    /// The numbers of all things within `reach` of the box around two places, along both axes, and perhaps of others. Each is a step of `work`.
    pub(crate) fn near(
        &self,
        [a, b]: [[f64; 2]; 2],
        reach: f64,
        work: &Work,
    ) -> impl Iterator<Item = usize> {
        let lows = [a[0].min(b[0]) - reach, a[1].min(b[1]) - reach];
        let highs = [a[0].max(b[0]) + reach, a[1].max(b[1]) + reach];
        let (few, many) = match self {
            Self::Few(count) => (0..*count, None),
            Self::Many(tree) => {
                (0..0, Some(tree.locate_in_envelope_intersecting(&AABB::from_corners(lows, highs))))
            }
        };
        few.chain(many.into_iter().flatten().map(|found| found.data)).inspect(|_| work.add(1))
    }
}

#[cfg(test)]
#[path = "near_index_tests.rs"]
mod tests;
