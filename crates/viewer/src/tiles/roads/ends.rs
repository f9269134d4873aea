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

impl RoadEnd {
    /// The end of a road at a point of its segment `source_m`, if the point is on the tile's
    /// border.
    pub(crate) fn at(
        (way_id, kind): (i64, RoadKind),
        [x, y, height_m]: [f64; 3],
        source_m: [[f64; 2]; 2],
        (tile, scale): (Bounds, &PlanScale),
    ) -> Option<Self> {
        Some(Self {
            way_id,
            kind,
            side: TileSide::from_position([x, y], tile)?,
            at_m: [x, y],
            height_range_m: [height_m; 2],
            width_factor: scale.across(source_m) as f32,
        })
    }
}

/// Points where lines on the ground end on the tile's border.
pub(crate) fn ground_ends<'a>(
    lines: impl Iterator<Item = &'a GroundLine>,
    tile: Bounds,
    scale: &PlanScale,
) -> Vec<RoadEnd> {
    let ends = |line: &'a GroundLine| {
        let points = [
            line.points_m.first().zip(line.sources_m.first()),
            line.points_m.last().zip(line.sources_m.last()),
        ];
        points.into_iter().flatten().filter_map(move |(point, source_m)| {
            RoadEnd::at((line.way_id, line.kind), *point, *source_m, (tile, scale))
        })
    };
    lines.flat_map(ends).collect()
}

/// Points where lines in plan cross the tile's border.
pub(crate) fn plan_ends<'a>(
    lines: impl Iterator<Item = &'a PlanLine>,
    tile: Bounds,
    scale: &PlanScale,
) -> Vec<RoadEnd> {
    let ends = |line: &'a PlanLine| {
        let segments = line.points_m.windows(2).zip(&line.ground_range_m);
        segments.flat_map(move |(pair, height_range_m)| {
            let segment_m = [pair[0], pair[1]];
            crossings(segment_m, tile).map(move |(side, at_m)| RoadEnd {
                way_id: line.way_id,
                kind: line.kind,
                side,
                at_m,
                height_range_m: *height_range_m,
                width_factor: scale.across(segment_m) as f32,
            })
        })
    };
    lines.flat_map(ends).collect()
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
