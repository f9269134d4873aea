//! Walks over triangles in floating point: the paper's form as written, and a more careful form.

use corniche_geom::LatticePoint;
use corniche_tin::{NO_TWIN, Surface};

/// A surface with its vertices in metres from a corner of its tile, for programs without a lattice.
pub(crate) struct Ground {
    pub(crate) surface: Surface,
    corner: LatticePoint,
    step_m: [f64; 2],
    points_m: Vec<[f64; 2]>,
}

impl Ground {
    pub(crate) fn new(surface: Surface, corner: LatticePoint, step_m: [f64; 2]) -> Self {
        let mut ground = Self { surface, corner, step_m, points_m: Vec::new() };
        ground.points_m = ground.surface.points().iter().map(|&at| ground.place(at)).collect();
        ground
    }

    /// The position of a lattice point in metres.
    pub(crate) fn place(&self, point: LatticePoint) -> [f64; 2] {
        let steps = [point.u - self.corner.u, point.v - self.corner.v];
        [steps[0] as f64 * self.step_m[0], steps[1] as f64 * self.step_m[1]]
    }

    /// The position of a point between lattice points in metres.
    pub(crate) fn place_of_steps(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [(u - self.corner.u as f64) * self.step_m[0], (v - self.corner.v as f64) * self.step_m[1]]
    }
}

/// A vertex added by a walk.
pub(crate) struct Crossed {
    /// The ends of the edge, the smaller index first.
    pub(crate) ends: [u32; 2],
    pub(crate) at: [f64; 2],
}

/// The end of a walk.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Outcome {
    /// The walk reached the end of the segment, in this triangle.
    Arrived(u32),
    /// The walk stopped before the end: the ground does not continue, or no edge is ahead.
    Stopped { left_m: f64 },
    /// The walk entered more triangles than there are.
    Endless,
}

/// A method for finding the exit from a triangle.
pub(crate) trait Form {
    /// Whether each exit becomes the new start; otherwise all distances are from the start of the
    /// segment.
    const MOVES_ON: bool;

    /// Finds the first exit from a triangle: the edge that is crossed, and its distance from `from`
    /// in the direction `v` of length 1. Edge k begins at corner k; `entered` is the edge through
    /// which the walk entered.
    fn exit(
        corners: [[f64; 2]; 3],
        entered: Option<usize>,
        from: [f64; 2],
        v: [f64; 2],
    ) -> Option<(usize, f64)>;
}

/// The paper's section 6.1 as written: unit vectors across the edges, distances from them,
/// barycentric coordinates.
pub(crate) struct AsWritten;

/// The same quotient without the terms that cancel out, so that it is the quotient of two areas.
/// The start does not move, so that rounding errors do not add up, and the walk never goes back
/// across the edge through which it entered.
pub(crate) struct Areas;

impl Form for AsWritten {
    const MOVES_ON: bool = true;

    fn exit(
        corners: [[f64; 2]; 3],
        _: Option<usize>,
        from: [f64; 2],
        v: [f64; 2],
    ) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        for k in 0..3 {
            let [start, end, opposite] = [0, 1, 2].map(|n| corners[(k + n) % 3]);
            let edge = minus(end, start);
            let length = dot(edge, edge).sqrt();
            let inwards = [-edge[1] / length, edge[0] / length];
            let height = dot(inwards, minus(opposite, start));
            let coordinate = dot(inwards, minus(from, start)) / height;
            let rate = dot(inwards, v) / height;
            if rate < 0.0 {
                let distance = coordinate / -rate;
                if first.is_none_or(|(_, known)| distance < known) {
                    first = Some((k, distance));
                }
            }
        }
        first
    }
}

impl Form for Areas {
    const MOVES_ON: bool = false;

    fn exit(
        corners: [[f64; 2]; 3],
        entered: Option<usize>,
        from: [f64; 2],
        v: [f64; 2],
    ) -> Option<(usize, f64)> {
        let mut first: Option<(usize, f64)> = None;
        for k in (0..3).filter(|&k| Some(k) != entered) {
            let [start, end] = [corners[k], corners[(k + 1) % 3]];
            let edge = minus(end, start);
            let rate = area(edge, v);
            if rate < 0.0 {
                let distance = area(edge, minus(from, start)) / -rate;
                if first.is_none_or(|(_, known)| distance < known) {
                    first = Some((k, distance));
                }
            }
        }
        first
    }
}

/// Follows a segment from a triangle that contains its start; adds a vertex at each exit.
pub(crate) fn trace<F: Form>(
    ground: &Ground,
    segment: [LatticePoint; 2],
    mut triangle: u32,
    found: &mut Vec<Crossed>,
) -> Outcome {
    let surface = &ground.surface;
    let [start, end] = segment.map(|point| ground.place(point));
    let way = minus(end, start);
    let length = dot(way, way).sqrt();
    let v = way.map(|part| part / length);
    let (mut from, mut left) = (start, length);
    let mut entered = None;
    for _ in 0..=surface.triangles().len() {
        let corners = surface.triangles()[triangle as usize];
        let corners = corners.map(|vertex| ground.points_m[vertex as usize]);
        let Some((k, distance)) = F::exit(corners, entered, from, v) else {
            return Outcome::Stopped { left_m: left };
        };
        if distance >= left {
            return Outcome::Arrived(triangle);
        }
        let half_edge = 3 * triangle + k as u32;
        let [a, b] = surface.ends(half_edge);
        // Rounding must not lead backwards.
        let distance = distance.max(0.0);
        let at = [from[0] + v[0] * distance, from[1] + v[1] * distance];
        found.push(Crossed { ends: [a.min(b), a.max(b)], at });
        if F::MOVES_ON {
            (from, left) = (at, left - distance);
        }
        match surface.twin(half_edge) {
            NO_TWIN => {
                let left_m = if F::MOVES_ON { left } else { left - distance };
                return Outcome::Stopped { left_m };
            }
            twin => (triangle, entered) = (twin / 3, Some(twin as usize % 3)),
        }
    }
    Outcome::Endless
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn area(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
