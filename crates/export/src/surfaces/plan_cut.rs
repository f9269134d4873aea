//! Clips lines to a tile, so that the tile beyond the border has the same point on it.

use corniche_geom::{LatticeBounds, LatticePoint, dot};

/// Returns the part of a segment within a tile, its border included: two ends, one if it only
/// touches the tile, or none.
///
/// The crossing of the segment with the line along one of the tile's sides is computed from the
/// segment's own ends alone, in either order, and rounded to the lattice.
pub(crate) fn within(segment: [LatticePoint; 2], tile: &LatticeBounds) -> Vec<LatticePoint> {
    let [mut from, mut to] = segment;
    if to < from {
        (from, to) = (to, from);
    }
    let mut found: Vec<LatticePoint> = vec![from, to];
    // The coordinate along the other axis at which the segment crosses the line at `here`.
    let crossed = |here: i64, [start, end]: [i64; 2], [other, other_end]: [i64; 2]| {
        let is_between = start.min(end) < here && here < start.max(end);
        let place = || share((here - start).into(), other_end - other, (end - start).into());
        is_between.then(|| other + place())
    };
    for u in [tile.min.u, tile.max.u] {
        let v = crossed(u, [from.u, to.u], [from.v, to.v]);
        found.extend(v.map(|v| LatticePoint::new(u, v)));
    }
    for v in [tile.min.v, tile.max.v] {
        let u = crossed(v, [from.v, to.v], [from.u, to.u]);
        found.extend(u.map(|u| LatticePoint::new(u, v)));
    }
    found.retain(|point| tile.contains(*point));
    // Along the segment: its ends are sorted, and points between them have the same order up to
    // rounding.
    found.sort_unstable_by_key(|point| (dot(from, to, *point), *point));
    found.dedup();
    found
}

/// `part · of / whole`, rounded to the nearest whole number, halves upwards.
pub(crate) fn share(part: i128, of: i64, whole: i128) -> i64 {
    let product = part * i128::from(of);
    let (product, whole) = if whole < 0 { (-product, -whole) } else { (product, whole) };
    (2 * product + whole).div_euclid(2 * whole) as i64
}

#[cfg(test)]
#[path = "plan_cut_tests.rs"]
mod tests;
