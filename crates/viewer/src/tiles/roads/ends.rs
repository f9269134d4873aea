//! Where roads meet the border of their tile.

use corniche_geom::Bounds;
use serde::{Deserialize, Serialize};

use super::{super::PlanScale, GroundLine, PlanLine, RoadKind};

/// A side of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Side {
    West,
    East,
    North,
    South,
}

/// Where a road meets the border of its tile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct RoadEnd {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// What the road is.
    pub(crate) kind: RoadKind,
    /// The side of the tile.
    pub(crate) side: Side,
    /// The position, in the working CRS.
    pub(crate) at_m: [f64; 2],
    /// Lowest and highest true height that the ground may have there.
    pub(crate) height_range_m: [f64; 2],
    /// Working metres across the road for each true metre across it.
    pub(crate) width_factor: f32,
}

impl Side {
    /// The side of `tile` that a point lies on, if any.
    pub(crate) fn of([x, y]: [f64; 2], tile: Bounds) -> Option<Self> {
        // Roads are clipped exactly on the border, but positions are rounded sums.
        let slack_m = 1e-9 * tile.width();
        let on = |a: f64, b: f64| (a - b).abs() <= slack_m;
        [
            (Self::West, on(x, tile.min_x)),
            (Self::East, on(x, tile.max_x)),
            (Self::North, on(y, tile.max_y)),
            (Self::South, on(y, tile.min_y)),
        ]
        .into_iter()
        .find_map(|(side, is_on)| is_on.then_some(side))
    }

    /// How many columns to the east and rows to the south the tile beyond this side is.
    pub(crate) fn offset(self) -> (i32, i32) {
        match self {
            Self::West => (-1, 0),
            Self::East => (1, 0),
            Self::North => (0, -1),
            Self::South => (0, 1),
        }
    }

    /// The side of the tile beyond that faces this one.
    pub(crate) fn opposite(self) -> Self {
        match self {
            Self::West => Self::East,
            Self::East => Self::West,
            Self::North => Self::South,
            Self::South => Self::North,
        }
    }
}

/// Where lines on the ground end on the tile's border.
pub(crate) fn ground_ends<'a>(
    lines: impl Iterator<Item = &'a GroundLine>,
    tile: Bounds,
    scale: &PlanScale,
) -> Vec<RoadEnd> {
    let mut ends = Vec::new();
    for line in lines {
        let points = [
            line.points_m.first().zip(line.sources_m.first()),
            line.points_m.last().zip(line.sources_m.last()),
        ];
        for (point, source_m) in points.into_iter().flatten() {
            let [x, y, height_m] = *point;
            if let Some(side) = Side::of([x, y], tile) {
                ends.push(RoadEnd {
                    way_id: line.way_id,
                    kind: line.kind,
                    side,
                    at_m: [x, y],
                    height_range_m: [height_m; 2],
                    width_factor: scale.across(*source_m) as f32,
                });
            }
        }
    }
    ends
}

/// Where lines in plan cross the tile's border.
pub(crate) fn plan_ends<'a>(
    lines: impl Iterator<Item = &'a PlanLine>,
    tile: Bounds,
    scale: &PlanScale,
) -> Vec<RoadEnd> {
    let mut ends = Vec::new();
    for line in lines {
        for (pair, height_range_m) in line.points_m.windows(2).zip(&line.ground_range_m) {
            for (side, at_m) in crossings([pair[0], pair[1]], tile) {
                ends.push(RoadEnd {
                    way_id: line.way_id,
                    kind: line.kind,
                    side,
                    at_m,
                    height_range_m: *height_range_m,
                    width_factor: scale.across([pair[0], pair[1]]) as f32,
                });
            }
        }
    }
    ends
}

/// Where a segment crosses a border of the tile.
fn crossings([p, q]: [[f64; 2]; 2], tile: Bounds) -> impl Iterator<Item = (Side, [f64; 2])> {
    let sides = [
        (Side::West, 0, tile.min_x),
        (Side::East, 0, tile.max_x),
        (Side::South, 1, tile.min_y),
        (Side::North, 1, tile.max_y),
    ];
    sides.into_iter().filter_map(move |(side, axis, border)| {
        // A point on the border counts as beyond it, so that a line through one crosses once.
        ((p[axis] < border) != (q[axis] < border)).then_some(())?;
        let share = (border - p[axis]) / (q[axis] - p[axis]);
        let along = p[1 - axis] + share * (q[1 - axis] - p[1 - axis]);
        let range = [[tile.min_y, tile.max_y], [tile.min_x, tile.max_x]][axis];
        let mut at_m = [border; 2];
        at_m[1 - axis] = along;
        (range[0]..=range[1]).contains(&along).then_some((side, at_m))
    })
}
