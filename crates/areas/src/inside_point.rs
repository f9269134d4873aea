//! A place inside areas, for symbols and labels.

use corniche_geom::LatticePoint;

use crate::{Polygon, Ring};

/// Returns a place inside the largest of some polygons: the middle of the longest stretch inside it
/// of the horizontal line halfway up the polygon. Ends of stretches are rounded to the lattice, so
/// that the place is within a step of the polygon even if that is a sliver. `None` without
/// polygons.
#[must_use]
pub fn inside_point(polygons: &[Polygon]) -> Option<LatticePoint> {
    // Of equally large polygons, the first.
    let largest = polygons.iter().rev().max_by_key(|polygon| polygon.doubled_area())?;
    let heights = || largest.outer().points().iter().map(|point| point.v);
    let v = heights().min()?.midpoint(heights().max()?);
    let crosses = |[from, to]: [LatticePoint; 2]| {
        let [low, high] = if from.v <= to.v { [from, to] } else { [to, from] };
        (low.v <= v && v < high.v).then(|| {
            let [along, up, rise] = [high.u - low.u, v - low.v, high.v - low.v].map(i128::from);
            low.u + (along * up).div_euclid(rise) as i64
        })
    };
    let mut ends: Vec<i64> = largest.rings().flat_map(Ring::segments).filter_map(crosses).collect();
    ends.sort_unstable();
    let stretches = ends.chunks_exact(2).rev();
    let longest = stretches.max_by_key(|stretch| stretch[1] - stretch[0])?;
    Some(LatticePoint::new(longest[0].midpoint(longest[1]), v))
}

#[cfg(test)]
#[path = "inside_point_tests.rs"]
mod tests;
