use std::ops::Range;

use corniche_geom::{Bounds, TILE_CELLS};
use corniche_roads::FunctionalRoadClass;

use super::{super::ground::relative, GroundLine, PlanLine, ground_ends, plan_ends};

/// A straight piece of a road's centre-line on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadSegment {
    /// Metres from the tile's reference point; z is true height, before exaggeration.
    pub start_in_tile: [f32; 3],
    /// The other end.
    pub end_in_tile: [f32; 3],
    /// True metres that the ground rises per metre to the left of the way from start to end.
    pub cross_slope: f32,
    /// Functional road class.
    pub class: FunctionalRoadClass,
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
    /// How far away they hold, in a tile of this width: one of its cells. Roads that look wider are drawn on a finer
    /// level, if there is one.
    #[must_use]
    pub fn reach_m(tile_width_m: f64) -> f64 {
        tile_width_m / TILE_CELLS as f64
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
    pub(super) fn of([x, y]: [f64; 2], tile: Bounds) -> Option<Self> {
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

impl RoadList<RoadSegment> {
    /// Cuts lines of the tile with these bounds into segments. `gradient` tells, for a position in the working CRS, how
    /// many true metres the ground there rises per metre east and per metre north.
    #[must_use]
    pub fn new(
        lines: &[GroundLine],
        tile: Bounds,
        reference_m: [f64; 3],
        gradient: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        // A segment lies in one triangle, and its middle not on the rim, unless all of it does.
        let cross_slope = |[x, y, _]: [f64; 3], [to_x, to_y, _]: [f64; 3]| {
            let (dx, dy) = (to_x - x, to_y - y);
            let length_m = dx.hypot(dy);
            let [east, north] = gradient([f64::midpoint(x, to_x), f64::midpoint(y, to_y)]);
            if length_m > 0.0 { ((north * dx - east * dy) / length_m) as f32 } else { 0.0 }
        };
        let segments = lines.iter().flat_map(|line| {
            line.points_m.windows(2).map(|pair| RoadSegment {
                start_in_tile: relative(pair[0], reference_m),
                end_in_tile: relative(pair[1], reference_m),
                cross_slope: cross_slope(pair[0], pair[1]),
                class: line.class,
            })
        });
        Self::sorted(segments.collect(), |segment| segment.class, ground_ends(lines, tile))
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
                    class: line.class,
                }
            })
        });
        Self::sorted(volumes.collect(), |volume| volume.class, plan_ends(lines, tile))
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
