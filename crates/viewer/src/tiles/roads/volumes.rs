//! Straight pieces of roads with a range of heights, as the SV method draws them.

use std::borrow::Cow;

use super::{
    super::{PlanScale, ground_mesh::relative_in_plan},
    NearHeights, PlanLine, RoadKind, RoadList,
    cut::OffGroundRoads,
    dashes::{DashPlace, dash_starts},
    ends::plan_ends,
    flat_ends::LineEnds,
    list::Classed,
    parts::InNet,
    road_line::RoadLine,
};

/// A straight piece of a road in plan with the height range of its volume.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoadVolume {
    /// Start of the piece, metres from the tile's reference point, east and north.
    pub start_in_tile: [f32; 2],
    /// End of the piece, likewise.
    pub end_in_tile: [f32; 2],
    /// Lowest and highest ground within the width margin, true metres above the reference point,
    /// rounded outwards.
    pub(crate) height_range_in_tile: [f32; 2],
    /// Tighter bounds for roads that are not wide.
    pub(crate) near: NearHeights,
    /// Working metres across the piece per true metre across it.
    pub width_factor: f32,
    /// Kind of the road.
    pub kind: RoadKind,
    /// Length of the part of the network to which the road belongs, working metres.
    pub(crate) part_m: f32,
    /// Dash position of its start.
    pub(crate) dash: DashPlace,
    /// Whether the piece ends flat at its start and at its end, even if roads have caps.
    pub(crate) flat_ends: [bool; 2],
}

impl Classed for RoadVolume {
    fn kind(&self) -> RoadKind {
        self.kind
    }
}

/// All volumes of a tile.
pub type RoadVolumes = RoadList<RoadVolume>;

impl RoadLine for PlanLine {
    fn road(&self) -> (i64, RoadKind) {
        (self.way_id, self.kind)
    }

    fn vertices_m(&self) -> Vec<[f64; 2]> {
        self.points_m.clone()
    }

    /// The ends of the line. It was cut at the margin, that is, outside the tile.
    fn ends(&self) -> LineEnds {
        let pair =
            |ends: Option<&[[f64; 2]]>| ends.and_then(|ends| Some([*ends.first()?, *ends.get(1)?]));
        let first = pair(self.points_m.get(..2)).map(|[a, b]| [b, a]);
        let last = pair(self.points_m.get(self.points_m.len().saturating_sub(2)..));
        LineEnds::of_road(self.kind, [first, last])
    }

    fn off_decks(&self, decks: &OffGroundRoads<'_>) -> Vec<Cow<'_, Self>> {
        decks.without_plan(self)
    }
}

impl RoadList<RoadVolume> {
    /// Cuts lines of a tile and of a margin around it into volumes.
    ///
    /// For the ends of a segment in the working CRS, `near` returns the range of true heights of
    /// the ground below it and how many metres that range grows per metre away from it; `None` if
    /// no ground is within [`NearHeights::reach_m`].
    pub(crate) fn new(
        lines: &[InNet<'_, PlanLine>],
        decks: &OffGroundRoads<'_>,
        reference_m: [f64; 3],
        scale: &PlanScale,
        near: impl Fn([[f64; 2]; 2]) -> Option<([f64; 2], f64)>,
    ) -> Self {
        let above = |[low_m, high_m]: [f64; 2]| {
            let [low, high] = [low_m, high_m].map(|height_m| (height_m - reference_m[2]) as f32);
            [low.next_down(), high.next_up()]
        };
        let place = |at: [f64; 2]| relative_in_plan(at, reference_m);
        let tile = decks.tile;
        let (place, near) = (&place, &near);
        let flat = InNet::with_flat_ends(lines, decks).into_iter();
        let volumes = flat.flat_map(|(line, part_m, [first_flat, last_flat])| {
            let last = line.points_m.len().saturating_sub(2);
            let dashes = line.dashes.clone().unwrap_or_else(|| dash_starts(&line.points_m, tile));
            let segments = line.points_m.windows(2).zip(&line.ground_range_m).zip(dashes);
            segments.enumerate().map(move |(number, ((pair, range_m), dash))| {
                // Without ground near, the box is almost flat.
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
                    kind: line.kind,
                    part_m,
                    dash,
                    flat_ends: [number == 0 && first_flat, number == last && last_flat],
                }
            })
        });
        let lines = lines.iter().map(|in_net| in_net.line.as_ref());
        Self::sorted(volumes.collect(), plan_ends(lines, tile, scale))
    }
}
