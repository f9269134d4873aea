//! Groups roads on bridges and in tunnels that may depend on each other, because they share a node
//! or may cross.

use std::collections::HashMap;

use corniche_geom::{DisjointSets, LatticeBounds, LatticePoint, StepBudget};
use rstar::{
    AABB, RTree,
    primitives::{GeomWithData, Rectangle},
};

/// The maximum number of boxes into which a line is divided.
const MOST_BOXES: usize = 256;
/// The maximum number of pairs of boxes to compare: a base, and an addition for each box.
const MOST_PAIRS: u64 = 1 << 22;
const MOST_PAIRS_OF_BOX: u64 = 1 << 8;

/// A road on a bridge or in a tunnel.
#[derive(Debug, Clone, Copy)]
pub struct SpanLine<'a> {
    /// The points of the road.
    pub points: &'a [LatticePoint],
    /// The nodes of the road at which others may join: the indices of their points, and their ids.
    pub nodes: &'a [(u32, i64)],
}

/// Returns the number of the group of each line. Lines of different groups do not share a node and
/// do not cross. Pairs of nodes in `same_places` count as one node.
///
/// If lines overlap each other more than any real lines, all lines form one group.
#[must_use]
pub fn connected(lines: &[SpanLine<'_>], same_places: &[[i64; 2]]) -> Vec<usize> {
    let mut groups = DisjointSets::new(lines.len());
    let mut first_at: HashMap<i64, usize> = HashMap::new();
    for (number, line) in lines.iter().enumerate() {
        for &(_, id) in line.nodes {
            let first = *first_at.entry(id).or_insert(number);
            groups.join(first, number);
        }
    }
    for pair in same_places {
        if let [Some(&one), Some(&other)] = pair.map(|id| first_at.get(&id)) {
            groups.join(one, other);
        }
    }
    let boxes: Vec<GeomWithData<Rectangle<[f64; 2]>, usize>> =
        lines.iter().enumerate().flat_map(|(number, line)| boxes_of(number, line.points)).collect();
    let work = StepBudget::new(MOST_PAIRS + MOST_PAIRS_OF_BOX * boxes.len() as u64);
    let tree = RTree::bulk_load(boxes.clone());
    for own in &boxes {
        let (low, high) = (own.geom().lower(), own.geom().upper());
        let mut looked = 0;
        for other in tree.locate_in_envelope_intersecting(&AABB::from_corners(low, high)) {
            groups.join(own.data, other.data);
            looked += 1;
        }
        work.add(looked);
        if work.check().is_err() {
            return vec![0; lines.len()];
        }
    }
    (0..lines.len()).map(|number| groups.first_of(number)).collect()
}

/// Returns boxes around the segments of a line.
fn boxes_of(
    number: usize,
    points: &[LatticePoint],
) -> impl Iterator<Item = GeomWithData<Rectangle<[f64; 2]>, usize>> + '_ {
    let segments = points.len().saturating_sub(1);
    let step = segments.div_ceil(MOST_BOXES).max(1);
    (0..segments).step_by(step).filter_map(move |first| {
        let own = LatticeBounds::around(&points[first..=(first + step).min(segments)])?;
        let corners = [own.min, own.max].map(LatticePoint::in_steps);
        Some(GeomWithData::new(Rectangle::from_corners(corners[0], corners[1]), number))
    })
}

#[cfg(test)]
#[path = "connected_tests.rs"]
mod tests;
