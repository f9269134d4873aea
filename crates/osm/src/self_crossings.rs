//! Where a line crosses itself.

use corniche_geom::{LatticePoint, Side, side};

/// Pairs of segments that are compared at most: all of a way of 2000 nodes, the most that OSM allows (OSM wiki, *Way*). A way of
/// a million nodes that runs to and fro would take a day.
const MAX_COMPARISONS: u32 = 2_000_000;

/// How many pairs of segments cross strictly inside both. Shared points and overlaps are no crossings: loops and
/// there-and-back ways are common and right. Counting ends after [`MAX_COMPARISONS`].
pub(crate) fn self_crossings(points: &[LatticePoint]) -> u32 {
    let mut segments: Vec<[LatticePoint; 2]> =
        points.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]).collect();
    // Swept from west to east, a segment meets only those that begin before it ends.
    segments.sort_unstable();
    let mut crossings = 0;
    let mut comparisons = 0;
    for (number, &[a, b]) in segments.iter().enumerate() {
        for &[c, d] in segments[number + 1..].iter().take_while(|[c, _]| c.u <= b.u) {
            if comparisons == MAX_COMPARISONS {
                return crossings;
            }
            comparisons += 1;
            let is_apart = c.v.max(d.v) < a.v.min(b.v) || a.v.max(b.v) < c.v.min(d.v);
            if !is_apart && straddles([a, b], [c, d]) && straddles([c, d], [a, b]) {
                crossings += 1;
            }
        }
    }
    crossings
}

/// Whether the ends of `other` lie strictly on different sides of the line through `segment`.
fn straddles(segment: [LatticePoint; 2], other: [LatticePoint; 2]) -> bool {
    let [from, to] = other.map(|end| side(segment[0], segment[1], end));
    from != Side::On && to != Side::On && from != to
}

#[cfg(test)]
#[path = "self_crossings_tests.rs"]
mod tests;
