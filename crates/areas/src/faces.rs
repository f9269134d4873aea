//! The faces of a planar graph, and which of them are inside.
//!
//! A *walk* goes once around a face along its left side. A face has one walk for each connected
//! part of the graph that it meets: one around it, and one around each island in it. The walks on
//! the two sides of a segment belong to different faces, one inside and one outside, because no
//! segment occurs an even number of times. So for each connected part it is enough to know which
//! face contains it: the face to the west of its westernmost point.

use std::cmp::Ordering;

use corniche_geom::{LatticePoint, Side, cross, side};

use crate::{planar_graph::PlanarGraph, segments::OrderedSegment, stabbing::Stabbing};

/// The number of the face west of everything.
const OUTERMOST: usize = usize::MAX;

/// Finds the inner faces: the half-edges of the walks of each face, from any start.
pub(crate) fn inner_faces(graph: &PlanarGraph) -> Vec<Vec<Vec<usize>>> {
    let walks = Walks::new(graph);
    let parts = parts_of(graph, &walks);
    let stabbing =
        Stabbing::new(graph.segments().iter().map(|[a, b]| [a.v.min(b.v), a.v.max(b.v)]));
    let mut face_of: Vec<Option<Face>> = vec![None; walks.starts.len()];
    for part in parts {
        let around = match west_of(graph, &stabbing, part.westernmost) {
            // The part seen there begins farther west, so it was processed before.
            Some(half) => face_of[walks.of[half]].unwrap_or(Face::OUTSIDE),
            None => Face::OUTSIDE,
        };
        spread(graph, &walks, &mut face_of, part.outer_walk, around);
    }
    collect(graph, &walks, &face_of)
}

/// A face: the walk that identifies it, and whether it is inside.
#[derive(Debug, Clone, Copy)]
struct Face {
    name: usize,
    is_inside: bool,
}

impl Face {
    const OUTSIDE: Self = Self { name: OUTERMOST, is_inside: false };
}

struct Walks {
    /// The walk to which each half-edge belongs.
    of: Vec<usize>,
    /// One half-edge of each walk.
    starts: Vec<usize>,
}

impl Walks {
    fn new(graph: &PlanarGraph) -> Self {
        const NONE: usize = usize::MAX;
        let mut of = vec![NONE; graph.half_edges()];
        let mut starts = Vec::new();
        for start in 0..graph.half_edges() {
            let mut half = start;
            if of[half] == NONE {
                while of[half] == NONE {
                    of[half] = starts.len();
                    half = graph.next(half);
                }
                starts.push(start);
            }
        }
        Self { of, starts }
    }
}

/// A connected part of the graph.
struct ConnectedPart {
    westernmost: LatticePoint,
    /// The walk around the whole part.
    outer_walk: usize,
}

/// Returns the connected parts, from west to east.
fn parts_of(graph: &PlanarGraph, walks: &Walks) -> Vec<ConnectedPart> {
    let mut is_seen = vec![false; walks.starts.len()];
    let mut parts = Vec::new();
    // Half-edges with even numbers begin at the smaller point, and segments are sorted by it. So
    // the first half-edge reached of each part begins at the part's westernmost point.
    for half in (0..graph.half_edges()).step_by(2) {
        if is_seen[walks.of[half]] {
            continue;
        }
        let westernmost = graph.origin(half);
        // All segments from that point lead east (or straight north). The west is to the left of
        // the last one, counter-clockwise.
        let last = (half..graph.half_edges())
            .step_by(2)
            .take_while(|&other| graph.origin(other) == westernmost)
            .max_by(|&a, &b| 0.cmp(&cross(westernmost, graph.target(a), graph.target(b))))
            .unwrap_or(half);
        let outer_walk = walks.of[last];
        parts.push(ConnectedPart { westernmost, outer_walk });
        let mut waiting = vec![outer_walk];
        is_seen[outer_walk] = true;
        while let Some(walk) = waiting.pop() {
            for_each_half_edge(graph, walks.starts[walk], |half| {
                let beside = walks.of[half ^ 1];
                if !is_seen[beside] {
                    is_seen[beside] = true;
                    waiting.push(beside);
                }
            });
        }
    }
    parts
}

/// Assigns faces to the walks of a connected part: `around` to its outer walk, then step by step
/// across segments.
fn spread(
    graph: &PlanarGraph,
    walks: &Walks,
    face_of: &mut [Option<Face>],
    outer_walk: usize,
    around: Face,
) {
    face_of[outer_walk] = Some(around);
    let mut waiting = vec![(outer_walk, around.is_inside)];
    while let Some((walk, is_inside)) = waiting.pop() {
        for_each_half_edge(graph, walks.starts[walk], |half| {
            let beside = walks.of[half ^ 1];
            if face_of[beside].is_none() {
                face_of[beside] = Some(Face { name: beside, is_inside: !is_inside });
                waiting.push((beside, !is_inside));
            }
        });
    }
}

fn collect(graph: &PlanarGraph, walks: &Walks, face_of: &[Option<Face>]) -> Vec<Vec<Vec<usize>>> {
    let mut by_name: Vec<(usize, usize)> = face_of
        .iter()
        .enumerate()
        .filter_map(|(walk, face)| face.filter(|face| face.is_inside).map(|face| (face.name, walk)))
        .collect();
    by_name.sort_unstable();
    let half_edges = |walk: usize| {
        let mut all = Vec::new();
        for_each_half_edge(graph, walks.starts[walk], |half| all.push(half));
        all
    };
    by_name
        .chunk_by(|a, b| a.0 == b.0)
        .map(|face| face.iter().map(|&(_, walk)| half_edges(walk)).collect())
        .collect()
}

fn for_each_half_edge(graph: &PlanarGraph, start: usize, mut take: impl FnMut(usize)) {
    let mut half = start;
    loop {
        take(half);
        half = graph.next(half);
        if half == start {
            return;
        }
    }
}

/// Returns the first half-edge to the west of a point, in the direction that has the point on its
/// left side.
///
/// The search runs a little above the point, so that ends of segments at the same height are no
/// special case: a segment includes its lower end and excludes its upper end.
fn west_of(graph: &PlanarGraph, stabbing: &Stabbing, point: LatticePoint) -> Option<usize> {
    let mut nearest: Option<(Upward, usize)> = None;
    stabbing.at(point.v, &mut |number| {
        let upward = Upward::new(graph.segments()[number]);
        if side(upward.low, upward.high, point) != Side::Right {
            return;
        }
        if nearest.is_none_or(|(other, _)| other.at(point.v, upward) == Ordering::Less) {
            nearest = Some((upward, number));
        }
    });
    // As seen from the east, the half-edge that leads down has the point on its left.
    nearest.map(|(upward, number)| 2 * number + usize::from(upward.is_forward))
}

/// A segment that is not horizontal, from its lower to its upper end.
#[derive(Clone, Copy)]
struct Upward {
    low: LatticePoint,
    high: LatticePoint,
    /// Whether the lower end is the first point of the segment.
    is_forward: bool,
}

impl Upward {
    fn new([a, b]: OrderedSegment) -> Self {
        let is_forward = a.v < b.v;
        let (low, high) = if is_forward { (a, b) } else { (b, a) };
        Self { low, high, is_forward }
    }

    /// Whether this segment is west (`Less`) or east of another at a height, or a little above it.
    /// The two do not cross.
    fn at(self, height: i64, other: Self) -> Ordering {
        let rise = |segment: Self| i128::from(segment.high.v - segment.low.v);
        let run = |segment: Self| i128::from(segment.high.u - segment.low.u);
        let (own_rise, other_rise) = (rise(self), rise(other));
        // Both positions are multiplied by the rise: exact, at most 2^70 for coordinates of 2^34.
        let place = |segment: Self| {
            i128::from(segment.low.u) * rise(segment)
                + run(segment) * i128::from(height - segment.low.v)
        };
        let here = (place(self) * other_rise).cmp(&(place(other) * own_rise));
        here.then_with(|| (run(self) * other_rise).cmp(&(run(other) * own_rise)))
    }
}
