//! A spatial index of boxes: a query takes time for the boxes nearby, not for all boxes.

use corniche_geom::StepBudget;
use rstar::{
    AABB, RTree,
    primitives::{GeomWithData, Rectangle},
};

/// Up to this number, boxes are scanned one by one, which is faster than a tree.
const FEW: usize = 32;

/// An index of boxes, which are numbered from 0.
pub(crate) enum NearIndex {
    Few(usize),
    Many(RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>),
}

impl NearIndex {
    /// Builds the index. Each item is given by two points, and its box encloses both.
    pub(crate) fn new(corners: impl ExactSizeIterator<Item = [[f64; 2]; 2]>) -> Self {
        if corners.len() <= FEW {
            return Self::Few(corners.len());
        }
        let boxes = corners
            .enumerate()
            .map(|(number, [a, b])| GeomWithData::new(Rectangle::from_corners(a, b), number));
        Self::Many(RTree::bulk_load(boxes.collect()))
    }

    /// The numbers of all boxes within `reach` of the box around two points, along both axes, and
    /// perhaps of others. Each is a step of `work`.
    pub(crate) fn near(
        &self,
        [a, b]: [[f64; 2]; 2],
        reach: f64,
        work: &StepBudget,
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
