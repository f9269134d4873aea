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
//! Everything computed at a point depends only on that point and its two neighbours, so both tiles
//! of a border have the same outline there.

use corniche_geom::LatticePoint;

use crate::plane::{nearest_point, steps_between};

/// Turns whose normals have a smaller product are bevelled: 120°.
const SHARPEST_MITRE: f64 = -0.5;

/// A centre-line with everything that its surface depends on.
#[derive(Clone)]
pub(crate) struct CenterLine {
    /// At least two points, no two neighbours equal.
    pub(crate) points: Vec<LatticePoint>,
    /// The points before the first and after the last, if the line continues in another tile.
    pub(crate) beyond: [Option<LatticePoint>; 2],
    /// Whether other lines meet its first point and its last one.
    pub(crate) is_met: [bool; 2],
    /// Half its width, lattice steps.
    pub(crate) half_width: f64,
}

/// The surface of a road in plan.
#[derive(Default)]
pub(crate) struct Ribbon {
    /// The lines that bound it, some of which may be inside it.
    pub(crate) outline: Vec<[LatticePoint; 2]>,
    /// Polygons that form it together; they may overlap.
    pub(crate) parts: Vec<Vec<LatticePoint>>,
}

/// A line across a road at a point of its centre-line.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct CrossSection {
    /// The number of the point.
    pub(crate) point: usize,
    /// The left and the right side.
    pub(crate) sides: [LatticePoint; 2],
}

/// The two sides at a point of the line, on the left and on the right: the end of the previous
/// segment, and the start of the next one.
struct Sides {
    before: [[f64; 2]; 2],
    after: [[f64; 2]; 2],
    /// Whether a side of the previous segment ends where that of the next one begins.
    meet: [bool; 2],
    /// The side inside of a turn.
    inner: Option<InnerSide>,
}

/// The side inside a turn, where both segments end on the bisector.
#[derive(Clone, Copy)]
struct InnerSide {
    side: usize,
    /// The distance before the point at which they end, and after it at which they begin, along the
    /// line: less than to their crossing if that is too far.
    back: f64,
    /// The vector along the bisector for a `back` of one.
    direction: [f64; 2],
}

/// A centre-line with the points beyond its ends.
struct LongLine {
    all: Vec<LatticePoint>,
    /// The indices of the line's own first and last point.
    own: [usize; 2],
    half_width: f64,
}

impl LongLine {
    fn from_center_line(line: &CenterLine) -> Self {
        let CenterLine { points, beyond, half_width, .. } = line;
        let before = beyond[0].filter(|before| *before != points[0]);
        let after = beyond[1].filter(|after| *after != points[points.len() - 1]);
        let from = usize::from(before.is_some());
        Self {
            all: before.into_iter().chain(points.iter().copied()).chain(after).collect(),
            own: [from, from + points.len() - 1],
            half_width: *half_width,
        }
    }

    fn sides_at(&self, index: usize) -> Sides {
        let Self { all, half_width, .. } = self;
        let at = all[index];
        let normal = |one: usize, other: usize| left_normal(all[one], all[other]);
        match (index.checked_sub(1), all.get(index + 1)) {
            (Some(previous), Some(_)) => {
                let reach = at.distance_steps(all[previous]).min(at.distance_steps(all[index + 1]));
                let normals = [normal(previous, index), normal(index, index + 1)];
                Sides::at_turn(at, normals, *half_width, reach)
            }
            (Some(previous), None) => Sides::at_end(at, normal(previous, index), *half_width),
            _ => Sides::at_end(at, normal(index, index + 1), *half_width),
        }
    }

    /// Whether the line continues beyond its last point.
    fn goes_on(&self) -> bool {
        self.own[1] + 1 < self.all.len()
    }
}

impl CenterLine {
    /// Returns lines across the road: the sides of its [`Ribbon`], except that they never cross
    /// inside turns, so that a strip can pass through them. There is one at each point, and two
    /// where a turn is bevelled.
    pub(crate) fn cross_sections(&self) -> Vec<CrossSection> {
        let line = LongLine::from_center_line(self);
        let [from, end] = line.own;
        let mut turns: Vec<Sides> = (from..=end).map(|index| line.sides_at(index)).collect();
        let lengths = self.points.array_windows().map(|[one, other]| one.distance_steps(*other));
        let shares = inner_shares(&turns, lengths);
        let mut sections: Vec<CrossSection> = Vec::with_capacity(self.points.len());
        for (point, (sides, share)) in turns.iter_mut().zip(shares).enumerate() {
            if let Some(InnerSide { side, back, direction }) = sides.inner
                && (share < 1.0 || !sides.meet[side])
            {
                let corner = moved(self.points[point], direction, back * share);
                (sides.before[side], sides.after[side]) = (corner, corner);
            }
            // A turn belongs to the segment before it.
            let before = if point == 0 { sides.after } else { sides.before };
            for sides in [before, sides.after] {
                let next = CrossSection { point, sides: sides.map(nearest_point) };
                if sections.last() != Some(&next) {
                    sections.push(next);
                }
            }
        }
        sections
    }
}

/// Returns the share of its `back` that each turn may have, so that no two turns use more than the
/// segment between them.
fn inner_shares(turns: &[Sides], lengths: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut shares = vec![1.0_f64; turns.len()];
    for (number, length) in lengths.enumerate() {
        if let [Some(one), Some(other)] = [number, number + 1].map(|point| turns[point].inner)
            && one.side == other.side
            && one.back + other.back > length
        {
            // Leave a small gap between them.
            let share = 0.99 * length / (one.back + other.back);
            for point in [number, number + 1] {
                shares[point] = shares[point].min(share);
            }
        }
    }
    shares
}

impl Ribbon {
    /// The surface along a line.
    pub(crate) fn around(line: &CenterLine) -> Self {
        let CenterLine { points, is_met, half_width, .. } = line;
        let mut ribbon = Self::default();
        let [first, last] = [points[0], points[points.len() - 1]];
        let long = LongLine::from_center_line(line);
        let [from, end] = long.own;
        let mut start = long.sides_at(from);
        if from == 0 {
            ribbon.cap(
                first,
                left_normal(points[0], points[1]).map(|n| -n),
                *half_width,
                is_met[0],
            );
        }
        for index in from..end {
            let stop = long.sides_at(index + 1);
            let [left, right] =
                [0, 1].map(|side| [start.after[side], stop.before[side]].map(nearest_point));
            ribbon.outline.extend([left, right]);
            ribbon.parts.push(vec![left[0], left[1], right[1], right[0]]);
            // A turn belongs to the segment before it.
            if index + 1 < end || long.goes_on() {
                let at = long.all[index + 1];
                for side in [0, 1] {
                    if !stop.meet[side] {
                        let [one, other] = [stop.before[side], stop.after[side]].map(nearest_point);
                        ribbon.outline.extend([[one, other], [one, at], [at, other]]);
                        ribbon.parts.push(vec![at, one, other]);
                    }
                }
            }
            start = stop;
        }
        if !long.goes_on() {
            let normal = left_normal(points[points.len() - 2], last);
            ribbon.cap(last, normal, *half_width, is_met[1]);
        }
        ribbon.outline.retain(|[one, other]| one != other);
        ribbon
    }

    /// Adds an end: straight where the road ends, half an octagon where it meets another.
    fn cap(&mut self, at: LatticePoint, [nx, ny]: [f64; 2], half_width: f64, is_round: bool) {
        let offset = |x: f64, y: f64| nearest_point(moved(at, [x, y], half_width));
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
        Self { before: sides, after: sides, meet: [true; 2], inner: None }
    }

    fn at_turn(
        at: LatticePoint,
        [before, after]: [[f64; 2]; 2],
        half_width: f64,
        reach: f64,
    ) -> Self {
        let Self { before: ends, .. } = Self::at_end(at, before, half_width);
        let Self { after: starts, .. } = Self::at_end(at, after, half_width);
        let product = before[0] * after[0] + before[1] * after[1];
        let turn = before[0] * after[1] - before[1] * after[0];
        let bisector = [0, 1].map(|axis| before[axis] + after[axis]);
        let inner = usize::from(turn <= 0.0);
        let sign = |side: usize| if side == 0 { 1.0 } else { -1.0 };
        // The distance from the point to the crossing of the inner sides: the tangent of half the
        // turn, times half the width.
        let back = half_width * turn.abs() / (1.0 + product);
        let direction = bisector.map(|axis| axis * sign(inner) / turn.abs());
        // A line that turns back on itself has no bisector.
        let inner_side = direction.iter().all(|axis| axis.is_finite()).then(|| InnerSide {
            side: inner,
            back: if back > reach { reach.min(half_width) } else { back },
            direction,
        });
        let mut sides = Self { before: ends, after: starts, meet: [false; 2], inner: inner_side };
        if product <= SHARPEST_MITRE {
            return sides;
        }
        let mitre = bisector.map(|axis| axis / (1.0 + product));
        for side in [0, 1] {
            if side == inner && back > reach {
                continue;
            }
            let corner = moved(at, mitre.map(|axis| axis * sign(side)), half_width);
            (sides.before[side], sides.after[side]) = (corner, corner);
            sides.meet[side] = true;
        }
        sides
    }
}

/// Returns the unit vector to the left of the way from one point to another.
fn left_normal(from: LatticePoint, to: LatticePoint) -> [f64; 2] {
    let [du, dv] = steps_between(from, to);
    let length = du.hypot(dv);
    [-dv / length, du / length]
}

/// Returns a point, moved by a multiple of a vector, in lattice steps from the lattice's origin.
fn moved(at: LatticePoint, [x, y]: [f64; 2], factor: f64) -> [f64; 2] {
    // The offset is rounded separately, so it is the same wherever the point is.
    [at.u as f64 + (x * factor).round(), at.v as f64 + (y * factor).round()]
}

#[cfg(test)]
#[path = "ribbon_tests.rs"]
mod tests;
