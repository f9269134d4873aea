use std::ops::Range;

use corniche_geom::{Bounds, TILE_CELLS};
use corniche_roads::FunctionalRoadClass;

use super::{
    super::{PlanScale, ground::relative},
    GroundLine, PlanLine, ground_ends, plan_ends,
};

/// A straight piece of a road's centre-line on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadSegment {
    /// The segment of the source line that it is a piece of: its start, metres east and north of the tile's reference
    /// point.
    pub start_in_tile: [f32; 2],
    /// Its end.
    pub end_in_tile: [f32; 2],
    /// Which part of that segment it is: 0 is the start, 1 the end.
    pub shares: [f32; 2],
    /// True height of the piece's start above the reference point.
    pub height_in_tile: f32,
    /// Whether the road does not go straight on before and behind the piece.
    pub has_caps: [bool; 2],
    /// Working metres across the segment for each true metre across it.
    pub width_factor: f32,
    /// The ground beside it.
    pub bed: Bed,
    /// Functional road class.
    pub class: FunctionalRoadClass,
}

/// A plane through a piece of a road, and how far the ground beside it leaves that plane: true metres.
///
/// Of each pair the first is downwards, the second upwards; neither is below 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bed {
    /// Metres that the plane rises for each metre along the piece and for each metre to its left.
    pub slopes: [f32; 2],
    /// Metres that the ground leaves it for each metre away from the piece, up to [`Bed::reaches_m`]'s first.
    pub rises: [f32; 2],
    /// Metres that it leaves it at most within each of [`Bed::reaches_m`].
    pub most_m: [[f32; 2]; 3],
    /// Whether ground of other tiles may be within each of those.
    pub leaves_tile: [bool; 3],
}

impl Bed {
    /// How far from the piece each of the bounds holds, in a tile of this size whose roads are drawn so far to each side.
    #[must_use]
    pub fn reaches_m(tile_size_m: [f64; 2], width_margin_m: f64) -> [f64; 3] {
        let cell_m = NearHeights::reach_m(tile_size_m);
        [cell_m, 4.0 * cell_m, width_margin_m.max(8.0 * cell_m)]
    }
}

/// A straight piece of a road in plan with the heights that its volume spans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadVolume {
    /// Metres from the tile's reference point, east and north.
    pub start_in_tile: [f32; 2],
    /// The other end.
    pub end_in_tile: [f32; 2],
    /// Lowest and highest ground within the width margin, true metres above the reference point, rounded outwards.
    pub height_range_in_tile: [f32; 2],
    /// Closer bounds for roads that are not wide.
    pub near: NearHeights,
    /// Working metres across it for each true metre across it.
    pub width_factor: f32,
    /// Functional road class.
    pub class: FunctionalRoadClass,
}

/// Heights of the ground no farther from a segment than [`NearHeights::reach_m`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearHeights {
    /// Lowest and highest ground beneath, true metres above the reference point, rounded outwards.
    pub range_in_tile: [f32; 2],
    /// True metres that it may lie lower or higher for each metre away from the segment.
    pub rise: f32,
}

impl NearHeights {
    /// How far away they hold, in a tile of this size: the shorter side of one of its cells. Roads that look wider are drawn
    /// on a finer level, if there is one.
    #[must_use]
    pub fn reach_m([east_m, north_m]: [f64; 2]) -> f64 {
        east_m.min(north_m) / TILE_CELLS as f64
    }
}

/// A side of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "compass directions")]
pub enum Side {
    West,
    East,
    North,
    South,
}

/// Where a road meets the border of its tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadEnd {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// Which border.
    pub side: Side,
    /// Where, in the working CRS.
    pub at_m: [f64; 2],
    /// Lowest and highest true height that the ground may have there.
    pub height_range_m: [f64; 2],
    /// Working metres across the road for each true metre across it.
    pub width_factor: f32,
}

/// All pieces of the roads of a tile, as one method draws them, in order of class.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadList<T> {
    pieces: Vec<T>,
    ranges: [Range<u32>; FunctionalRoadClass::COUNT],
    ends: Vec<RoadEnd>,
}

/// All segments of a tile.
pub type RoadSegments = RoadList<RoadSegment>;

/// All volumes of a tile.
pub type RoadVolumes = RoadList<RoadVolume>;

impl Side {
    /// The side of `tile` that a point lies on, if any.
    pub(crate) fn of([x, y]: [f64; 2], tile: Bounds) -> Option<Self> {
        // Roads are cut on the border exactly; positions are sums of f64.
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
}

/// A piece of a line on the ground, before it is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    /// x, y in the working CRS and true heights of its ends.
    pub(crate) ends_m: [[f64; 3]; 2],
    /// The ends of its source segment in plan.
    pub(crate) source_m: [[f64; 2]; 2],
    pub(crate) has_caps: [bool; 2],
}

impl Piece {
    fn all_of(line: &GroundLine) -> impl Iterator<Item = Self> {
        let sources_m = &line.sources_m;
        line.points_m.windows(2).zip(sources_m).enumerate().map(move |(k, (pair, source_m))| {
            let goes_on = |other: Option<&[[f64; 2]; 2]>| other == Some(source_m);
            Self {
                ends_m: [pair[0], pair[1]],
                source_m: *source_m,
                has_caps: [
                    !goes_on(k.checked_sub(1).and_then(|k| sources_m.get(k))),
                    !goes_on(sources_m.get(k + 1)),
                ],
            }
        })
    }

    /// Its direction in plan, of length 1.
    pub(crate) fn direction(&self) -> [f64; 2] {
        let [p, q] = self.source_m;
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let length_m = dx.hypot(dy);
        if length_m > 0.0 { [dx / length_m, dy / length_m] } else { [1.0, 0.0] }
    }

    /// How long it is in plan.
    pub(crate) fn length_m(&self) -> f64 {
        let [[x, y, _], [to_x, to_y, _]] = self.ends_m;
        (to_x - x).hypot(to_y - y)
    }

    /// How far along its source segment a position lies.
    fn share(&self, [x, y, _]: [f64; 3]) -> f32 {
        let [p, q] = self.source_m;
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let squared = dx * dx + dy * dy;
        if squared > 0.0 { (((x - p[0]) * dx + (y - p[1]) * dy) / squared) as f32 } else { 0.0 }
    }
}

impl RoadList<RoadSegment> {
    /// Cuts lines of the tile with these bounds into segments. `bed` tells of the ground beside a piece.
    #[must_use]
    pub(crate) fn of_lines(
        lines: &[GroundLine],
        tile: Bounds,
        reference_m: [f64; 3],
        scale: &PlanScale,
        bed: impl Fn(&Piece) -> Bed,
    ) -> Self {
        let place = |[x, y]: [f64; 2]| {
            let [x, y, _] = relative([x, y, 0.0], reference_m);
            [x, y]
        };
        let segments = lines.iter().flat_map(|line| {
            Piece::all_of(line).map(|piece| {
                let [start_in_tile, end_in_tile] = piece.source_m.map(place);
                RoadSegment {
                    start_in_tile,
                    end_in_tile,
                    shares: piece.ends_m.map(|end| piece.share(end)),
                    height_in_tile: relative(piece.ends_m[0], reference_m)[2],
                    has_caps: piece.has_caps,
                    width_factor: scale.across(piece.source_m) as f32,
                    bed: bed(&piece),
                    class: line.class,
                }
            })
        });
        Self::sorted(segments.collect(), |segment| segment.class, ground_ends(lines, tile, scale))
    }
}

impl RoadList<RoadVolume> {
    /// Cuts lines of the tile with these bounds into volumes.
    ///
    /// `near` tells, for the ends of a segment in the working CRS, the ground's true heights beneath it and how they
    /// rise per metre; `None` when no ground is within [`NearHeights::reach_m`].
    #[must_use]
    pub fn new(
        lines: &[PlanLine],
        tile: Bounds,
        reference_m: [f64; 3],
        scale: &PlanScale,
        near: impl Fn([[f64; 2]; 2]) -> Option<([f64; 2], f64)>,
    ) -> Self {
        let above = |[low_m, high_m]: [f64; 2]| {
            let [low, high] = [low_m, high_m].map(|height_m| (height_m - reference_m[2]) as f32);
            [low.next_down(), high.next_up()]
        };
        let place = |[x, y]: [f64; 2]| {
            let [x, y, _] = relative([x, y, 0.0], reference_m);
            [x, y]
        };
        let volumes = lines.iter().flat_map(|line| {
            line.points_m.windows(2).zip(&line.ground_range_m).map(|(pair, range_m)| {
                // Without ground near, a box as good as flat.
                let (near_m, rise) = near([pair[0], pair[1]])
                    .unwrap_or(([f64::midpoint(range_m[0], range_m[1]); 2], 0.0));
                RoadVolume {
                    start_in_tile: place(pair[0]),
                    end_in_tile: place(pair[1]),
                    height_range_in_tile: above(*range_m),
                    near: NearHeights {
                        range_in_tile: above(near_m),
                        rise: (rise as f32).next_up(),
                    },
                    width_factor: scale.across([pair[0], pair[1]]) as f32,
                    class: line.class,
                }
            })
        });
        Self::sorted(volumes.collect(), |volume| volume.class, plan_ends(lines, tile, scale))
    }
}

impl<T> RoadList<T> {
    fn sorted(
        mut pieces: Vec<T>,
        class_of: impl Fn(&T) -> FunctionalRoadClass,
        ends: Vec<RoadEnd>,
    ) -> Self {
        pieces.sort_by_key(&class_of);
        let mut ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        for (class, range) in FunctionalRoadClass::all().zip(&mut ranges) {
            let start = pieces.partition_point(|piece| class_of(piece) < class);
            let end = pieces.partition_point(|piece| class_of(piece) <= class);
            *range = start as u32..end as u32;
        }
        Self { pieces, ranges, ends }
    }

    /// The pieces, most important class first.
    #[must_use]
    pub fn all(&self) -> &[T] {
        &self.pieces
    }

    /// Where the pieces of a class are.
    #[must_use]
    pub fn range_of(&self, class: FunctionalRoadClass) -> Range<u32> {
        self.ranges[usize::from(class.number())].clone()
    }

    /// Where they meet the tile's border.
    #[must_use]
    pub fn ends(&self) -> &[RoadEnd] {
        &self.ends
    }
}

impl<T> Default for RoadList<T> {
    fn default() -> Self {
        let ranges = [const { 0..0 }; FunctionalRoadClass::COUNT];
        Self { pieces: Vec::new(), ranges, ends: Vec::new() }
    }
}
