//! Straight pieces of roads on the ground, as the GEO method draws them.

use std::borrow::Cow;

use super::{
    super::{
        PlanScale, distance,
        ground_mesh::{relative, relative_in_plan},
    },
    Bed, GroundLine, RoadKind, RoadList,
    cut::OffGroundRoads,
    dashes::{DashPlace, dash_starts},
    ends::ground_ends,
    flat_ends::{LineEnds, direction},
    list::Classed,
    parts::InNet,
    road_line::RoadLine,
};

/// A straight piece of a road's centre-line on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoadSegment {
    /// Start of the segment of the source line that contains the piece, metres east and north of
    /// the tile's reference point.
    pub start_in_tile: [f32; 2],
    /// End of the segment of the source line.
    pub end_in_tile: [f32; 2],
    /// Range of the piece within the segment: 0 is the start, 1 the end.
    pub shares: [f32; 2],
    /// True height of the piece's start above the reference point.
    pub height_in_tile: f32,
    /// Whether the piece has a cap at its start and at its end: where the road does not continue
    /// straight.
    pub(crate) has_caps: [bool; 2],
    /// Working metres across the segment per true metre across it.
    pub width_factor: f32,
    /// The ground next to the piece.
    pub bed: Bed,
    /// Kind of the road.
    pub kind: RoadKind,
    /// Length of the part of the network to which the road belongs, working metres.
    pub(crate) part_m: f32,
    /// Dash position of the start of its source segment.
    pub(crate) dash: DashPlace,
    /// Whether its source segment ends flat at its start and at its end, even if roads have caps.
    pub(crate) flat_ends: [bool; 2],
}

impl Classed for RoadSegment {
    fn kind(&self) -> RoadKind {
        self.kind
    }
}

/// All segments of a tile.
pub type RoadSegments = RoadList<RoadSegment>;

/// A piece of a line on the ground, before it is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinePiece {
    /// x, y in the working CRS and true heights of the ends.
    pub(crate) ends_m: [[f64; 3]; 2],
    /// The ends of the source segment in plan.
    pub(crate) source_m: [[f64; 2]; 2],
    pub(crate) has_caps: [bool; 2],
    /// The index of the source segment in its line.
    source_number: usize,
}

impl LinePiece {
    fn all_of(line: &GroundLine) -> impl Iterator<Item = Self> {
        let sources_m = &line.sources_m;
        let mut source_number = 0;
        line.points_m.windows(2).zip(sources_m).enumerate().map(move |(k, (pair, source_m))| {
            let goes_on = |other: Option<&[[f64; 2]; 2]>| other == Some(source_m);
            let before = k.checked_sub(1).and_then(|k| sources_m.get(k));
            source_number += usize::from(before.is_some() && !goes_on(before));
            Self {
                ends_m: [pair[0], pair[1]],
                source_m: *source_m,
                has_caps: [!goes_on(before), !goes_on(sources_m.get(k + 1))],
                source_number,
            }
        })
    }

    /// The unit vector along the piece in plan.
    pub(crate) fn direction(&self) -> [f64; 2] {
        direction(self.source_m).unwrap_or([1.0, 0.0])
    }

    /// Length of the piece in plan.
    pub(crate) fn length_m(&self) -> f64 {
        let [from, to] = self.ends_m.map(|[x, y, _]| [x, y]);
        distance(from, to)
    }

    /// The position along the source segment: 0 at its start, 1 at its end.
    fn share(&self, [x, y, _]: [f64; 3]) -> f32 {
        let [p, q] = self.source_m;
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let squared = dx * dx + dy * dy;
        if squared > 0.0 { (((x - p[0]) * dx + (y - p[1]) * dy) / squared) as f32 } else { 0.0 }
    }
}

/// The vertices of the source line, from the start of the first segment that has a piece to the end
/// of the last one.
fn source_vertices(line: &GroundLine) -> Vec<[f64; 2]> {
    let mut sources_m = line.sources_m.clone();
    sources_m.dedup();
    let first = sources_m.first().map(|source_m| source_m[0]);
    first.into_iter().chain(sources_m.iter().map(|source_m| source_m[1])).collect()
}

impl RoadLine for GroundLine {
    fn road(&self) -> (i64, RoadKind) {
        (self.way_id, self.kind)
    }

    fn vertices_m(&self) -> Vec<[f64; 2]> {
        source_vertices(self)
    }

    /// The ends of the line, unless it was cut at the border or at a void.
    fn ends(&self) -> LineEnds {
        // Both are positions of the same point, computed by two formulas.
        let is_at = |[x, y, _]: [f64; 3], to: [f64; 2]| distance([x, y], to) < 1e-6;
        let first = self.sources_m.first().zip(self.points_m.first());
        let last = self.sources_m.last().zip(self.points_m.last());
        let first = first.filter(|([a, _], point)| is_at(**point, *a)).map(|([a, b], _)| [*b, *a]);
        let last = last.filter(|([_, b], point)| is_at(**point, *b)).map(|(source, _)| *source);
        LineEnds::of_road(self.kind, [first, last])
    }

    fn off_decks(&self, decks: &OffGroundRoads<'_>) -> Vec<Cow<'_, Self>> {
        decks.without_ground(self)
    }
}

impl RoadList<RoadSegment> {
    /// Cuts lines of a tile into segments. `bed` returns the ground next to a piece.
    #[must_use]
    pub(crate) fn of_lines(
        lines: &[InNet<'_, GroundLine>],
        decks: &OffGroundRoads<'_>,
        reference_m: [f64; 3],
        scale: &PlanScale,
        bed: impl Fn(&LinePiece) -> Bed,
    ) -> Self {
        let place = |at: [f64; 2]| relative_in_plan(at, reference_m);
        let (place, bed) = (&place, &bed);
        let tile = decks.tile;
        let flat = InNet::with_flat_ends(lines, decks).into_iter();
        let segments = flat.flat_map(|(line, part_m, [first_flat, last_flat])| {
            let sources = source_vertices(line);
            let segments = sources.len().saturating_sub(1);
            let dashes = line.dashes.clone().unwrap_or_else(|| dash_starts(&sources, tile));
            LinePiece::all_of(line).map(move |piece| {
                let [start_in_tile, end_in_tile] = piece.source_m.map(place);
                RoadSegment {
                    start_in_tile,
                    end_in_tile,
                    shares: piece.ends_m.map(|end| piece.share(end)),
                    height_in_tile: relative(piece.ends_m[0], reference_m)[2],
                    has_caps: piece.has_caps,
                    width_factor: scale.across(piece.source_m) as f32,
                    bed: bed(&piece),
                    kind: line.kind,
                    part_m,
                    dash: dashes[piece.source_number],
                    flat_ends: [
                        piece.source_number == 0 && first_flat,
                        piece.source_number + 1 == segments && last_flat,
                    ],
                }
            })
        });
        let lines = lines.iter().map(|in_net| in_net.line.as_ref());
        Self::sorted(segments.collect(), ground_ends(lines, tile, scale))
    }
}
