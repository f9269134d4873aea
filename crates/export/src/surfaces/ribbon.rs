//! A road as a surface: the outline of its true width around its centre-line, in plan.
//!
//! ```text
//!        mitre tip
//!   ────────────◆                 Sides end where they meet: outside in the mitre's tip, inside where they cross. Turns
//!   ── centre ──◦╲                sharper than 120° are bevelled outside; where a segment is too short for the inner
//!   ──────────◇  ╲ ╲              crossing, sides keep their full length and overlap, which the cut resolves.
//!     crossing ╲  ╲ ╲
//! ```
//!
//! Everything that is computed at a point depends on that point and its two neighbours alone, so that both tiles of a border have the same
//! outline there.

use corniche_geom::LatticePoint;

/// Turns whose normals have a smaller product are bevelled: 120°.
const SHARPEST_MITRE: f64 = -0.5;

/// A centre-line with what it needs to become a surface.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CenterLine {
    /// Two at least, no two neighbours the same.
    pub(crate) points: Vec<LatticePoint>,
    /// The points before the first and after the last, where the line goes on in another tile.
    pub(crate) beyond: [Option<LatticePoint>; 2],
    /// Whether other lines meet its first point and its last one.
    pub(crate) is_met: [bool; 2],
    /// Half its width, lattice steps.
    pub(crate) half_width: f64,
}

/// The surface of a road in plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ribbon {
    /// The lines that bound it, some of which may lie inside of it.
    pub(crate) outline: Vec<[LatticePoint; 2]>,
    /// Polygons that make it up together; they may overlap.
    pub(crate) parts: Vec<Vec<LatticePoint>>,
}

/// The two sides at a point of the line, on the left and on the right: where the segment before ends, and where the one after begins.
struct Sides {
    before: [[f64; 2]; 2],
    after: [[f64; 2]; 2],
    /// Whether a side of the segment before ends where that of the one after begins.
    meet: [bool; 2],
}

impl Ribbon {
    /// The surface along a line.
    pub(crate) fn around(line: &CenterLine) -> Self {
        let CenterLine { points, beyond, is_met, half_width } = line;
        let mut ribbon = Self::default();
        let [first, last] = [points[0], points[points.len() - 1]];
        let before = beyond[0].filter(|before| *before != first);
        let after = beyond[1].filter(|after| *after != last);
        let all: Vec<LatticePoint> =
            before.into_iter().chain(points.iter().copied()).chain(after).collect();
        let from = usize::from(before.is_some());
        let end = from + points.len() - 1;
        let sides_at = |index: usize| {
            let at = all[index];
            let normal = |one: usize, other: usize| left_normal(all[one], all[other]);
            match (index.checked_sub(1), all.get(index + 1)) {
                (Some(previous), Some(_)) => {
                    let reach = length(all[previous], at).min(length(at, all[index + 1]));
                    Sides::at_turn(
                        at,
                        normal(previous, index),
                        normal(index, index + 1),
                        *half_width,
                        reach,
                    )
                }
                (Some(previous), None) => Sides::at_end(at, normal(previous, index), *half_width),
                _ => Sides::at_end(at, normal(index, index + 1), *half_width),
            }
        };
        let mut start = sides_at(from);
        if before.is_none() {
            ribbon.cap(
                first,
                left_normal(points[0], points[1]).map(|n| -n),
                *half_width,
                is_met[0],
            );
        }
        for index in from..end {
            let stop = sides_at(index + 1);
            let [left, right] = [0, 1].map(|side| [start.after[side], stop.before[side]].map(snap));
            ribbon.outline.extend([left, right]);
            ribbon.parts.push(vec![left[0], left[1], right[1], right[0]]);
            // A turn belongs to the segment before it.
            if index + 1 < end || after.is_some() {
                let at = all[index + 1];
                for side in [0, 1] {
                    if !stop.meet[side] {
                        let [one, other] = [stop.before[side], stop.after[side]].map(snap);
                        ribbon.outline.extend([[one, other], [one, at], [at, other]]);
                        ribbon.parts.push(vec![at, one, other]);
                    }
                }
            }
            start = stop;
        }
        if after.is_none() {
            let normal = left_normal(points[points.len() - 2], last);
            ribbon.cap(last, normal, *half_width, is_met[1]);
        }
        ribbon.outline.retain(|[one, other]| one != other);
        ribbon
    }

    /// An end: straight where the road ends, half an octagon where it meets another.
    fn cap(&mut self, at: LatticePoint, [nx, ny]: [f64; 2], half_width: f64, is_round: bool) {
        let offset = |x: f64, y: f64| snap(moved(at, [x, y], half_width));
        // Along the line and outwards.
        let [dx, dy] = [ny, -nx];
        let corners = if is_round {
            let diagonal = std::f64::consts::FRAC_1_SQRT_2;
            vec![
                offset(nx, ny),
                offset((nx + dx) * diagonal, (ny + dy) * diagonal),
                offset(dx, dy),
                offset((dx - nx) * diagonal, (dy - ny) * diagonal),
                offset(-nx, -ny),
            ]
        } else {
            vec![offset(nx, ny), offset(-nx, -ny)]
        };
        self.outline.extend(corners.windows(2).map(|pair| [pair[0], pair[1]]));
        if is_round {
            self.parts.push(corners);
        }
    }
}

impl Sides {
    fn at_end(at: LatticePoint, [nx, ny]: [f64; 2], half_width: f64) -> Self {
        let sides = [moved(at, [nx, ny], half_width), moved(at, [-nx, -ny], half_width)];
        Self { before: sides, after: sides, meet: [true; 2] }
    }

    fn at_turn(
        at: LatticePoint,
        before: [f64; 2],
        after: [f64; 2],
        half_width: f64,
        reach: f64,
    ) -> Self {
        let Self { before: ends, .. } = Self::at_end(at, before, half_width);
        let Self { after: starts, .. } = Self::at_end(at, after, half_width);
        let product = before[0] * after[0] + before[1] * after[1];
        let turn = before[0] * after[1] - before[1] * after[0];
        let mut sides = Self { before: ends, after: starts, meet: [false; 2] };
        if product <= SHARPEST_MITRE {
            return sides;
        }
        let mitre = [0, 1].map(|axis| (before[axis] + after[axis]) / (1.0 + product));
        // How far before the point the inner sides cross: the tangent of half the turn.
        let back = half_width * turn.abs() / (1.0 + product);
        let inner = usize::from(turn <= 0.0);
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            if side == inner && back > reach {
                continue;
            }
            let corner = moved(at, mitre.map(|axis| axis * sign), half_width);
            (sides.before[side], sides.after[side]) = (corner, corner);
            sides.meet[side] = true;
        }
        sides
    }
}

/// The unit vector to the left of the way from one point to another.
fn left_normal(from: LatticePoint, to: LatticePoint) -> [f64; 2] {
    let (du, dv) = ((to.u - from.u) as f64, (to.v - from.v) as f64);
    let length = du.hypot(dv);
    [-dv / length, du / length]
}

fn length(from: LatticePoint, to: LatticePoint) -> f64 {
    from.distance_steps(to)
}

/// A point, moved by a multiple of a vector, in lattice steps from the lattice's origin.
fn moved(at: LatticePoint, [x, y]: [f64; 2], factor: f64) -> [f64; 2] {
    // Rounding the offset by itself keeps it the same wherever the point lies.
    [at.u as f64 + (x * factor).round(), at.v as f64 + (y * factor).round()]
}

fn snap([u, v]: [f64; 2]) -> LatticePoint {
    LatticePoint::new(u.round() as i64, v.round() as i64)
}

#[cfg(test)]
#[path = "ribbon_tests.rs"]
mod tests;
