//! Clips lines to a rectangle of the lattice, with a rule for segments exactly along its borders.

use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TILE_CELLS};

use crate::{OwnedBorders, fraction::Fraction, owned_borders::TileBorder};

/// Returns the parts of `line` in the closed rectangle `bounds`, in order.
///
/// A segment that leaves the rectangle is cut exactly at the border coordinate; the other
/// coordinate is the exact one, rounded to the nearest lattice step (half a step: up), so both
/// tiles at a border and both directions of travel get the same point. Parts that are a point, or
/// become one by rounding, are dropped. Segments along the border are only kept on `owned`
/// stretches; the end of a stretch, between two cells, is a cut, too.
///
/// Coordinates must be below 2^60, so that products of their differences fit in 128 bits.
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
    /// For each segment of the part, the index of the segment of the whole line that contains it.
    pub segments: Vec<usize>,
}

/// Clips like [`clip`], and also returns where in the line the parts come from.
#[must_use]
pub fn clip_parts(
    line: &Polyline,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
) -> Vec<ClippedPart> {
    clip_parts_within(line, bounds, owned, bounds)
}

/// Clips like [`clip_parts`], and also to `within`; `owned` are the borders of `bounds`.
///
/// Cuts depend only on the segment and the border, so a tile that is completely in `within`, and a
/// neighbour that is not, get the same points on their border.
#[must_use]
pub fn clip_parts_within(
    line: &Polyline,
    bounds: &LatticeBounds,
    owned: OwnedBorders,
    within: &LatticeBounds,
) -> Vec<ClippedPart> {
    let both = bounds.intersection(within);
    let mut parts = ClippedParts::default();
    for (index, &segment) in line.points().array_windows().enumerate() {
        parts.segment = index;
        if let Some(along) = Along::from_segment(segment, bounds) {
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

/// Clips like [`clip`], but keeps segments along every border: for a tile with a margin, whose
/// parts overlap anyway.
#[must_use]
pub fn clip_closed(line: &Polyline, bounds: &LatticeBounds) -> Vec<Polyline> {
    clip(line, bounds, OwnedBorders::ALL)
}

/// The parts that are being assembled.
#[derive(Default)]
pub(crate) struct ClippedParts {
    pub ended: Vec<ClippedPart>,
    current: Vec<LatticePoint>,
    /// The index of the segment of the line that contains each segment of `current`.
    segments: Vec<usize>,
    /// The segment of the line that is being clipped.
    pub segment: usize,
    /// Whether the last segment's end was kept, so that the next segment continues from it.
    pub goes_on: bool,
}

impl ClippedParts {
    pub(crate) fn keep(&mut self, inside: Inside) {
        if !(self.goes_on && inside.whole_start) {
            self.end();
        }
        let [start, end] = inside.ends;
        if self.current.is_empty() {
            self.current.push(start);
        }
        // A piece that rounding makes a point is dropped.
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

/// The part of a segment inside the rectangle.
#[derive(Clone, Copy)]
pub(crate) struct Inside {
    pub ends: [LatticePoint; 2],
    /// Whether the first end is the segment's own.
    pub whole_start: bool,
    /// Whether the second end is the segment's own.
    pub whole_end: bool,
}

/// A segment on the line of a border.
struct Along<'a> {
    segment: [LatticePoint; 2],
    bounds: &'a LatticeBounds,
    border: TileBorder,
}

impl<'a> Along<'a> {
    fn from_segment([p, q]: [LatticePoint; 2], bounds: &'a LatticeBounds) -> Option<Self> {
        let (min, max) = (bounds.min, bounds.max);
        let border = match (p.u == q.u, p.v == q.v) {
            (true, _) if p.u == min.u => TileBorder::West,
            (true, _) if p.u == max.u => TileBorder::East,
            (_, true) if p.v == min.v => TileBorder::South,
            (_, true) if p.v == max.v => TileBorder::North,
            _ => return None,
        };
        Some(Self { segment: [p, q], bounds, border })
    }

    /// Keeps the pieces of the segment on owned stretches and in `within`, in its direction.
    fn keep_owned(&self, owned: &OwnedBorders, within: &LatticeBounds, parts: &mut ClippedParts) {
        let [p, q] = self.segment;
        let mut kept = Vec::new();
        let mut from = 0;
        let (first_within, last_within, is_within) = match self.border {
            TileBorder::North | TileBorder::South => {
                (within.min.u, within.max.u, (within.min.v..=within.max.v).contains(&p.v))
            }
            TileBorder::East | TileBorder::West => {
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
            TileBorder::North | TileBorder::South => p.u < q.u,
            TileBorder::East | TileBorder::West => p.v > q.v,
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

    /// The offset along the border at which the `cell`th cell begins: from the west or from the
    /// north.
    fn offset(&self, cell: i64) -> i64 {
        let (min, max) = (self.bounds.min, self.bounds.max);
        let part =
            |side: i64| (i128::from(side) * i128::from(cell) / i128::from(TILE_CELLS)) as i64;
        match self.border {
            TileBorder::North | TileBorder::South => min.u + part(max.u - min.u),
            TileBorder::East | TileBorder::West => max.v - part(max.v - min.v),
        }
    }

    fn along(&self, point: LatticePoint) -> i64 {
        match self.border {
            TileBorder::North | TileBorder::South => point.u,
            TileBorder::East | TileBorder::West => point.v,
        }
    }

    fn at(&self, along: i64) -> LatticePoint {
        match self.border {
            TileBorder::North | TileBorder::South => LatticePoint::new(along, self.segment[0].v),
            TileBorder::East | TileBorder::West => LatticePoint::new(self.segment[0].u, along),
        }
    }
}

/// The part in the rectangle of a segment that is not on the line of a border.
fn inside([p, q]: [LatticePoint; 2], bounds: &LatticeBounds) -> Option<Inside> {
    let (min, max) = (bounds.min, bounds.max);
    let (mut start, mut end) =
        (Cut { at: Fraction::ZERO, point: p }, Cut { at: Fraction::ONE, point: q });
    let (mut whole_start, mut whole_end) = (true, true);
    for axis in [Axis::U, Axis::V] {
        let (from, to) = (axis.coordinate_of(p), axis.coordinate_of(q));
        let (low, high) = (axis.coordinate_of(min), axis.coordinate_of(max));
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
    fn coordinate_of(self, point: LatticePoint) -> i64 {
        match self {
            Self::U => point.u,
            Self::V => point.v,
        }
    }
}

/// The position where a segment meets the line of a border.
#[derive(Clone, Copy)]
struct Cut {
    at: Fraction,
    point: LatticePoint,
}

impl Cut {
    /// Computes the cut; the segment must not be parallel to the border.
    fn new([p, q]: [LatticePoint; 2], axis: Axis, border: i64) -> Self {
        let towards = i128::from((axis.coordinate_of(q) - axis.coordinate_of(p)).signum());
        let length = i128::from(axis.coordinate_of(q) - axis.coordinate_of(p)) * towards;
        let reach = i128::from(border - axis.coordinate_of(p)) * towards;
        // ⌊x + 1/2⌋ of the exact x: the same from either end. If the segment does not reach the
        // border, the result has no meaning and is not used; it only must not overflow.
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
