//! Lines are clipped to a rectangle of the lattice, with the rule for what runs exactly along its borders.

use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TILE_CELLS};

use crate::{OwnedBorders, fraction::Fraction, owned_borders::Border};

/// The parts of `line` in the closed rectangle `bounds`, in order.
///
/// A segment that leaves is cut on the exact border coordinate; the other coordinate is the exact one, rounded
/// to the nearest lattice step (half a step: up), so both tiles at a border and both directions of travel get
/// the same point. Parts that are a point, or become one by rounding, are dropped. Of segments along the
/// border only what is on `owned` stretches is kept; where a stretch ends, between two cells, is a cut, too.
///
/// Coordinates are below 2^60, so that products of their differences fit 128 bits.
///
/// Source: Liang & Barsky 1984, *A New Concept and Method for Line Clipping*, with exact fractions.
#[must_use]
pub fn clip(line: &Polyline, bounds: &LatticeBounds, owned: OwnedBorders) -> Vec<Polyline> {
    clip_parts(line, bounds, owned).into_iter().map(|part| part.line).collect()
}

/// A part of a line in a rectangle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClippedPart {
    /// The part.
    pub line: Polyline,
    /// The segment of the whole line that each of its segments is a piece of.
    pub segments: Vec<usize>,
}

/// [`clip`], and where in the line its parts come from.
#[must_use]
pub fn clip_parts(
    line: &Polyline,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
) -> Vec<ClippedPart> {
    clip_parts_within(line, bounds, owned, bounds)
}

/// [`clip_parts`] of what lies in `within`, too; `owned` are the borders of `bounds`.
///
/// Where a segment is cut depends on the segment and the border alone, so a tile that lies in `within` as a whole, and its
/// neighbour that does not, get the same points on their border.
#[must_use]
pub fn clip_parts_within(
    line: &Polyline,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
    within: &LatticeBounds,
) -> Vec<ClippedPart> {
    let both = bounds.intersection(within);
    let mut parts = Parts::default();
    for (index, pair) in line.points().windows(2).enumerate() {
        let segment = [pair[0], pair[1]];
        parts.segment = index;
        if let Some(along) = Along::of(segment, bounds) {
            along.keep_owned(&owned, &both, &mut parts);
        } else if let Some(inside) = inside(segment, &both) {
            parts.keep(inside);
        } else {
            parts.goes_on = false;
        }
    }
    parts.end();
    parts.ended
}

/// [`clip`] that keeps segments along every border: for a tile with a margin, whose parts overlap anyway.
#[must_use]
pub fn clip_closed(line: &Polyline, bounds: &LatticeBounds) -> Vec<Polyline> {
    clip(line, bounds, OwnedBorders::ALL)
}

/// The parts that are being made.
#[derive(Default)]
pub(crate) struct Parts {
    pub(crate) ended: Vec<ClippedPart>,
    current: Vec<LatticePoint>,
    /// The segment of the line that each segment of `current` is a piece of.
    segments: Vec<usize>,
    /// The segment of the line that is being clipped.
    pub(crate) segment: usize,
    /// Whether the last segment's end was kept, so that the next one goes on from it.
    pub(crate) goes_on: bool,
}

impl Parts {
    pub(crate) fn keep(&mut self, inside: Inside) {
        if !(self.goes_on && inside.whole_start) {
            self.end();
        }
        let [start, end] = inside.ends;
        if self.current.is_empty() {
            self.current.push(start);
        }
        // A piece that rounding makes a point is left out.
        if start != end {
            self.current.push(end);
            self.segments.push(self.segment);
        }
        self.goes_on = inside.whole_end;
    }

    pub(crate) fn end(&mut self) {
        let segments = std::mem::take(&mut self.segments);
        let line = Polyline::new(std::mem::take(&mut self.current)).ok();
        self.ended.extend(line.map(|line| ClippedPart { line, segments }));
    }
}

/// What of a segment lies inside.
#[derive(Clone, Copy)]
pub(crate) struct Inside {
    pub(crate) ends: [LatticePoint; 2],
    /// The first end is the segment's own.
    pub(crate) whole_start: bool,
    /// The second end is the segment's own.
    pub(crate) whole_end: bool,
}

/// A segment on the line of a border.
struct Along<'a> {
    segment: [LatticePoint; 2],
    bounds: &'a LatticeBounds,
    border: Border,
}

impl<'a> Along<'a> {
    fn of([p, q]: [LatticePoint; 2], bounds: &'a LatticeBounds) -> Option<Self> {
        let (min, max) = (bounds.min, bounds.max);
        let border = match (p.u == q.u, p.v == q.v) {
            (true, _) if p.u == min.u => Border::West,
            (true, _) if p.u == max.u => Border::East,
            (_, true) if p.v == min.v => Border::South,
            (_, true) if p.v == max.v => Border::North,
            _ => return None,
        };
        Some(Self { segment: [p, q], bounds, border })
    }

    /// Keeps what of the segment is on owned stretches and `within`, in its direction.
    fn keep_owned(&self, owned: &OwnedBorders, within: &LatticeBounds, parts: &mut Parts) {
        let [p, q] = self.segment;
        let mut kept = Vec::new();
        let mut from = 0;
        let (first_within, last_within, is_within) = match self.border {
            Border::North | Border::South => {
                (within.min.u, within.max.u, (within.min.v..=within.max.v).contains(&p.v))
            }
            Border::East | Border::West => {
                (within.min.v, within.max.v, (within.min.u..=within.max.u).contains(&p.u))
            }
        };
        while let Some([first, end]) = owned.next_run(self.border, from) {
            from = end;
            let [a, b] = [first, end].map(|cell| self.offset(cell));
            let [low, high] = [a.min(b).max(first_within), a.max(b).min(last_within)];
            if !is_within || low >= high {
                continue;
            }
            let within = |point: LatticePoint| self.along(point).clamp(low, high);
            if within(p) != within(q) {
                let ends = [self.at(within(p)), self.at(within(q))];
                kept.push(Inside { ends, whole_start: ends[0] == p, whole_end: ends[1] == q });
            }
        }
        let eastward_or_southward = match self.border {
            Border::North | Border::South => p.u < q.u,
            Border::East | Border::West => p.v > q.v,
        };
        if !eastward_or_southward {
            kept.reverse();
        }
        if kept.is_empty() {
            parts.goes_on = false;
        }
        for inside in kept {
            parts.keep(inside);
        }
    }

    /// Where, along the border, the `cell`th cell begins: from the west or from the north.
    fn offset(&self, cell: i64) -> i64 {
        let (min, max) = (self.bounds.min, self.bounds.max);
        let part =
            |side: i64| (i128::from(side) * i128::from(cell) / i128::from(TILE_CELLS)) as i64;
        match self.border {
            Border::North | Border::South => min.u + part(max.u - min.u),
            Border::East | Border::West => max.v - part(max.v - min.v),
        }
    }

    fn along(&self, point: LatticePoint) -> i64 {
        match self.border {
            Border::North | Border::South => point.u,
            Border::East | Border::West => point.v,
        }
    }

    fn at(&self, along: i64) -> LatticePoint {
        match self.border {
            Border::North | Border::South => LatticePoint::new(along, self.segment[0].v),
            Border::East | Border::West => LatticePoint::new(self.segment[0].u, along),
        }
    }
}

/// What of a segment that is on no border's line lies in the rectangle.
fn inside([p, q]: [LatticePoint; 2], bounds: &LatticeBounds) -> Option<Inside> {
    let (min, max) = (bounds.min, bounds.max);
    let (mut start, mut end) =
        (Cut { at: Fraction::ZERO, point: p }, Cut { at: Fraction::ONE, point: q });
    let (mut whole_start, mut whole_end) = (true, true);
    for axis in [Axis::U, Axis::V] {
        let (from, to) = (axis.of(p), axis.of(q));
        let (low, high) = (axis.of(min), axis.of(max));
        let (first, last) = if from < to { (low, high) } else { (high, low) };
        if from == to {
            if from < low || from > high {
                return None;
            }
            continue;
        }
        let enters = Cut::new([p, q], axis, first);
        if enters.at > start.at {
            (start, whole_start) = (enters, false);
        }
        let leaves = Cut::new([p, q], axis, last);
        if leaves.at < end.at {
            (end, whole_end) = (leaves, false);
        }
    }
    (start.at < end.at).then_some(Inside { ends: [start.point, end.point], whole_start, whole_end })
}

#[derive(Clone, Copy)]
enum Axis {
    U,
    V,
}

impl Axis {
    fn of(self, point: LatticePoint) -> i64 {
        match self {
            Self::U => point.u,
            Self::V => point.v,
        }
    }
}

/// Where a segment meets the line of a border.
#[derive(Clone, Copy)]
struct Cut {
    at: Fraction,
    point: LatticePoint,
}

impl Cut {
    /// The segment is not parallel to the border.
    fn new([p, q]: [LatticePoint; 2], axis: Axis, border: i64) -> Self {
        let towards = i128::from((axis.of(q) - axis.of(p)).signum());
        let length = i128::from(axis.of(q) - axis.of(p)) * towards;
        let reach = i128::from(border - axis.of(p)) * towards;
        // ⌊x + 1/2⌋ of the exact x: the same from either end. For a border that the segment does not reach, the
        // result has no meaning and is not used; it only must not overflow.
        let round = |from: i64, to: i64| {
            let offset = (2 * i128::from(to - from) * reach + length).div_euclid(2 * length);
            from.wrapping_add(offset as i64)
        };
        let point = match axis {
            Axis::U => LatticePoint::new(border, round(p.v, q.v)),
            Axis::V => LatticePoint::new(round(p.u, q.u), border),
        };
        Self { at: Fraction::new(reach, length), point }
    }
}

#[cfg(test)]
#[path = "clip_tests.rs"]
mod tests;
