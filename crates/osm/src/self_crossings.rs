//! Counts how often a line crosses itself.

use corniche_geom::LatticePoint;
use geo::line_intersection::{LineIntersection, line_intersection};
use geo::{Coord, Line};

/// The maximum number of pairs of segments that are compared. This is enough for all pairs of a way
/// of 2000 nodes, OSM's limit (OSM wiki, *Way*). Without a limit, a way of a million nodes that
/// runs to and fro would take a day.
const MAX_COMPARISONS: u32 = 2_000_000;

/// Counts the pairs of segments that cross strictly inside both. Shared points and overlaps are not
/// crossings, because closed ways and ways that return along the same line are common and correct.
/// Counting ends after [`MAX_COMPARISONS`].
pub(crate) fn self_crossings(points: &[LatticePoint]) -> u32 {
    let mut segments: Vec<[LatticePoint; 2]> =
        points.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]).collect();
    // In order from west to east, a segment can cross only those that begin before it ends.
    segments.sort_unstable();
    let mut crossings = 0;
    let mut comparisons = 0;
    for (number, &[a, b]) in segments.iter().enumerate() {
        for &[c, d] in segments[number + 1..].iter().take_while(|[c, _]| c.u <= b.u) {
            if comparisons == MAX_COMPARISONS {
                return crossings;
            }
            comparisons += 1;
            if cross_inside([a, b], [c, d]) {
                crossings += 1;
            }
        }
    }
    crossings
}

/// Whether two segments cross strictly inside both.
///
/// `geo` decides by the signs of Shewchuk's orientations, which are exact for coordinates that an
/// f64 represents exactly: lattice points are below 2^50 ([`corniche_geom::MAX_LATTICE_STEPS`]),
/// and an f64 represents integers up to 2^53.
fn cross_inside(one: [LatticePoint; 2], other: [LatticePoint; 2]) -> bool {
    // Most pairs are neighbours, which share a point and therefore do not cross inside both, or are
    // apart from each other.
    let [own, its] = [one, other].map(|[a, b]| [a.v.min(b.v), a.v.max(b.v)]);
    if one.iter().any(|point| other.contains(point)) || own[0] > its[1] || its[0] > own[1] {
        return false;
    }
    let [one, other] = [one, other].map(|[from, to]| {
        let [from, to] = [from, to].map(|point| Coord::from(point.in_steps()));
        Line::new(from, to)
    });
    matches!(
        line_intersection(one, other),
        Some(LineIntersection::SinglePoint { is_proper: true, .. })
    )
}

#[cfg(test)]
#[path = "self_crossings_tests.rs"]
mod tests;
