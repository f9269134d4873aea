//! What of a line lies in a tile, so that the tile beyond the border has the same point on it.

use corniche_geom::{LatticeBounds, LatticePoint};

/// The part of a segment within a tile, its border included: two ends, one where it only touches the tile, or none.
///
/// Where the segment crosses the line along one of the tile's sides is computed from the segment's own ends alone, whatever their order, and rounded to the lattice.
pub(crate) fn within(segment: [LatticePoint; 2], tile: &LatticeBounds) -> Vec<LatticePoint> {
    let [mut from, mut to] = segment;
    if to < from {
        (from, to) = (to, from);
    }
    let holds = |p: &LatticePoint| {
        (tile.min.u..=tile.max.u).contains(&p.u) && (tile.min.v..=tile.max.v).contains(&p.v)
    };
    let mut found: Vec<LatticePoint> = vec![from, to];
    for u in [tile.min.u, tile.max.u] {
        if (from.u < u && u < to.u) || (to.u < u && u < from.u) {
            let v = from.v + share(u - from.u, to.v - from.v, to.u - from.u);
            found.push(LatticePoint::new(u, v));
        }
    }
    for v in [tile.min.v, tile.max.v] {
        if (from.v < v && v < to.v) || (to.v < v && v < from.v) {
            let u = from.u + share(v - from.v, to.u - from.u, to.v - from.v);
            found.push(LatticePoint::new(u, v));
        }
    }
    found.retain(holds);
    // Along the segment: its ends are sorted, and points between them follow the same order up to rounding.
    found.sort_unstable_by_key(|p| {
        let (du, dv) = (i128::from(p.u - from.u), i128::from(p.v - from.v));
        (du * i128::from(to.u - from.u) + dv * i128::from(to.v - from.v), *p)
    });
    found.dedup();
    found
}

/// `part · of / whole`, rounded to the nearest whole number, halves upwards.
fn share(part: i64, of: i64, whole: i64) -> i64 {
    let (product, whole) = (i128::from(part) * i128::from(of), i128::from(whole));
    let (product, whole) = if whole < 0 { (-product, -whole) } else { (product, whole) };
    (2 * product + whole).div_euclid(2 * whole) as i64
}

#[cfg(test)]
#[path = "plan_cut_tests.rs"]
mod tests;
