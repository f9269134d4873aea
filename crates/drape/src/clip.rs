use corniche_geom::{LatticeBounds, LatticePoint, Polyline, TileId};

use crate::fraction::Fraction;

/// Which borders a tile owns besides its west and north one: where a segment runs exactly along a border of
/// two tiles, one of them must keep it, and only one, so that lengths add up.
///
/// A tile owns its west and its north border, as in `Frame::tile_column_row`. Its east and south border
/// belong to its neighbours, if there are any.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OwnedBorders {
    /// Whether segments along the east border belong to this tile.
    pub east: bool,
    /// Whether segments along the south border belong to this tile.
    pub south: bool,
}

impl OwnedBorders {
    /// All four.
    pub const ALL: Self = Self { east: true, south: true };

    /// The borders a tile owns in its level: west and north, and at the edge of the root also east or south.
    #[must_use]
    pub fn of_tile(id: TileId) -> Self {
        Self { east: id.neighbour(1, 0).is_none(), south: id.neighbour(0, 1).is_none() }
    }
}

/// The parts of `line` in the closed rectangle `bounds`, in order.
///
/// A segment that leaves is cut on the exact border coordinate; the other coordinate is the exact one, rounded
/// to the nearest lattice step (half a step: up), so both tiles at a border and both directions of travel get
/// the same point. Parts that are a point, or become one by rounding, are dropped. Of segments along the
/// border only those on `owned` ones are kept.
///
/// Source: Liang & Barsky 1984, *A New Concept and Method for Line Clipping*, with exact fractions.
#[must_use]
pub fn clip(line: &Polyline, bounds: &LatticeBounds, owned: OwnedBorders) -> Vec<Polyline> {
    let mut parts = Vec::new();
    let mut current: Vec<LatticePoint> = Vec::new();
    // Whether the last segment's end was kept, so that the next one goes on from it.
    let mut goes_on = false;
    for pair in line.points().windows(2) {
        let kept = inside([pair[0], pair[1]], bounds, owned);
        if !(goes_on && kept.is_some_and(|inside| inside.whole_start)) {
            parts.extend(Polyline::new(std::mem::take(&mut current)).ok());
        }
        goes_on = false;
        if let Some(inside) = kept {
            current.extend(inside.ends);
            goes_on = inside.whole_end;
        }
    }
    parts.extend(Polyline::new(current).ok());
    parts
}

/// [`clip`] that keeps segments along every border: for a tile with a margin, whose parts overlap anyway.
#[must_use]
pub fn clip_closed(line: &Polyline, bounds: &LatticeBounds) -> Vec<Polyline> {
    clip(line, bounds, OwnedBorders::ALL)
}

/// What of a segment lies inside.
#[derive(Clone, Copy)]
struct Inside {
    ends: [LatticePoint; 2],
    /// The first end is the segment's own.
    whole_start: bool,
    /// The second end is the segment's own.
    whole_end: bool,
}

fn inside(
    [p, q]: [LatticePoint; 2],
    bounds: &LatticeBounds,
    owned: OwnedBorders,
) -> Option<Inside> {
    let (min, max) = (bounds.min, bounds.max);
    let along_east = p.u == q.u && p.u == max.u && !owned.east;
    let along_south = p.v == q.v && p.v == min.v && !owned.south;
    if along_east || along_south {
        return None;
    }
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
        // ⌊x + 1/2⌋ of the exact x: the same from either end. A border that the segment does not reach is
        // never used, and its meaningless point must only not overflow.
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
