//! Points where roads meet the border of their tile.

use corniche_geom::Bounds;
use serde::{Deserialize, Serialize};

use super::{super::PlanScale, GroundLine, PlanLine, RoadKind};

/// A side of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum TileSide {
    West,
    East,
    North,
    South,
}

/// A point where a road meets the border of its tile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct RoadEnd {
    /// OSM's id of the way.
    pub(crate) way_id: i64,
    /// Kind of the road.
    pub(crate) kind: RoadKind,
    /// The side of the tile.
    pub(crate) side: TileSide,
    /// The position, in the working CRS.
    pub(crate) at_m: [f64; 2],
    /// Lowest and highest true height of the ground at this point.
    pub(crate) height_range_m: [f64; 2],
    /// Working metres across the road per true metre across it.
    pub(crate) width_factor: f32,
}

impl TileSide {
    /// The side of `tile` on which a point is, if any.
    pub(crate) fn from_position([x, y]: [f64; 2], tile: Bounds) -> Option<Self> {
        // Roads are clipped exactly at the border, but positions are rounded sums.
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

    /// The offset of the tile beyond this side: columns to the east and rows to the south.
    pub(crate) fn offset(self) -> (i32, i32) {
        match self {
            Self::West => (-1, 0),
            Self::East => (1, 0),
            Self::North => (0, -1),
            Self::South => (0, 1),
        }
    }

    /// The side of the neighbouring tile that faces this side.
    pub(crate) fn opposite(self) -> Self {
        match self {
            Self::West => Self::East,
            Self::East => Self::West,
            Self::North => Self::South,
            Self::South => Self::North,
        }
    }
}

/// Points where lines on the ground end on the tile's border.
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
            if let Some(side) = TileSide::from_position([x, y], tile) {
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

/// Points where lines in plan cross the tile's border.
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

/// Points where a segment crosses a border of the tile.
fn crossings([p, q]: [[f64; 2]; 2], tile: Bounds) -> impl Iterator<Item = (TileSide, [f64; 2])> {
    let sides = [
        (TileSide::West, 0, tile.min_x),
        (TileSide::East, 0, tile.max_x),
        (TileSide::South, 1, tile.min_y),
        (TileSide::North, 1, tile.max_y),
    ];
    sides.into_iter().filter_map(move |(side, axis, border)| {
        // A point on the border counts as outside, so that a line through the point crosses once.
        ((p[axis] < border) != (q[axis] < border)).then_some(())?;
        let share = (border - p[axis]) / (q[axis] - p[axis]);
        let along = p[1 - axis] + share * (q[1 - axis] - p[1 - axis]);
        let range = [[tile.min_y, tile.max_y], [tile.min_x, tile.max_x]][axis];
        let mut at_m = [border; 2];
        at_m[1 - axis] = along;
        (range[0]..=range[1]).contains(&along).then_some((side, at_m))
    })
}
