//! Decks of bridges as straight pieces for drawing.

use std::collections::BTreeMap;

use corniche_geom::{Bounds, StepBudget, along};
use corniche_roads::slab_thickness_m;

use super::{
    super::{PlanScale, distance, ground_mesh::relative},
    DeckLine, RoadEnd, RoadKind, RoadList,
    dashes::{DashPlace, dash_starts},
    ends::TileSide,
    flat_ends::{LineEnds, direction},
    list::Classed,
    parts::OPEN_M,
};

/// A deck is drawn in pieces of at most this length, working metres, because its width is straight
/// between the ends of a piece.
const LONGEST_M: f64 = 200.0;
/// Maximum number of pieces of a segment that is as long as the tile.
const MOST_PIECES: f64 = 64.0;
/// Work per piece, in steps of laying a road: it limits a tile to some 95 000 pieces. Real tiles
/// have fewer: 9 142 points in a tile of Porto with cells of 111 m, at most 14 057 in a tile of 28
/// km of Milan.
const STEPS_OF_PIECE: usize = 704;
/// Additional work per deck for each side of the tile that the deck is long: the drawn deck is
/// wider than a pixel. Milan has decks of two sides; a tile may have a thousand.
const STEPS_OF_SIDE: f64 = 65536.0;
/// Thickness of the slab under a line of a layer, such as a railway, true metres.
const LINE_SLAB_M: f64 = 1.0;
/// A line that turns by more has no mitre.
const LEAST_COSINE: f64 = -0.5;

/// A straight piece of a deck: a slab, with the road on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DeckPiece {
    /// Start of the road, metres from the tile's reference point: east, north, and up (true
    /// height).
    pub start_in_tile: [f32; 3],
    /// End of the road, likewise.
    pub end_in_tile: [f32; 3],
    /// Mitres in plan, at the start and at the end: the piece is cut off there, perpendicular to
    /// this unit vector. A zero vector means a round cap.
    pub mitres: [[f32; 2]; 2],
    /// Whether the deck comes down to the ground at its start and at its end, where one road
    /// continues.
    pub lands: [bool; 2],
    /// Length of the deck, working metres.
    pub(crate) deck_m: f32,
    /// Thickness of the deck, true metres; 0 for a ribbon, which is not a bridge: ground hides it.
    pub slab_m: f32,
    /// Working metres across the deck per true metre across it.
    pub width_factor: f32,
    /// Kind of the road.
    pub kind: RoadKind,
    /// Length of the part of the network to which the road belongs, working metres.
    pub(crate) part_m: f32,
    /// Dash position of its start.
    pub(crate) dash: DashPlace,
}

impl Classed for DeckPiece {
    fn kind(&self) -> RoadKind {
        self.kind
    }
}

/// All pieces of decks of a tile.
pub type DeckPieces = RoadList<DeckPiece>;

/// Properties of the roads on the ground of a tile that decks need.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct GroundNet {
    /// Ends of the roads.
    pub(crate) ends: Vec<LineEnds>,
    /// Length of the part of the network to which a way belongs.
    pub(crate) parts_m: BTreeMap<i64, f32>,
}

/// The continuations of a tile's decks: for each point, the directions beyond all line ends there.
struct Joints(BTreeMap<[u64; 2], Vec<[f64; 2]>>);

impl Joints {
    /// Collects the ends at each point. Three ends at a point are enough to know that there is no
    /// mitre.
    fn new<'a>(ends: impl Iterator<Item = &'a LineEnds>) -> Self {
        let mut at_point: BTreeMap<[u64; 2], Vec<[f64; 2]>> = BTreeMap::new();
        for (at, outward) in ends.flat_map(LineEnds::outward) {
            let known = at_point.entry(at.map(f64::to_bits)).or_default();
            if known.len() < 3 {
                known.push(outward);
            }
        }
        Self(at_point)
    }

    /// The mitre of an end, which must be in the list: half-way to the only line that continues
    /// there.
    fn mitre(&self, at: [f64; 2], outward: [f64; 2]) -> Option<[f64; 2]> {
        let [first, second] = self.0.get(&at.map(f64::to_bits))?.as_slice() else { return None };
        let is_own = first.map(f64::to_bits) == outward.map(f64::to_bits);
        let other = if is_own { second } else { first };
        mitre(outward, other.map(|part| -part))
    }
}

/// The mitre between a direction and the direction in which a line continues; `None` if it turns
/// back.
fn mitre(from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
    let cosine = from[0] * to[0] + from[1] * to[1];
    let sum = [from[0] + to[0], from[1] + to[1]];
    let length = libm::hypot(sum[0], sum[1]);
    (cosine > LEAST_COSINE).then(|| sum.map(|part| part / length))
}

/// A line in plan with heights, without repeated points.
fn distinct(points_m: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut points_m = points_m.to_vec();
    points_m.dedup_by_key(|[x, y, _]| [x.to_bits(), y.to_bits()]);
    points_m
}

impl RoadList<DeckPiece> {
    /// The same pieces as ribbons, which end at the border of their tile.
    pub(crate) fn as_ribbons(&self) -> Self {
        let ribbon = |piece: &DeckPiece| DeckPiece { slab_m: 0.0, ..*piece };
        Self::sorted(self.all().iter().map(ribbon).collect(), Vec::new())
    }

    /// Cuts decks in the tile with these bounds into pieces; returns none if that is too much work,
    /// which the caller must check at the end.
    pub(crate) fn of_decks(
        decks: &[DeckLine],
        ground: &GroundNet,
        (tile, reference_m): (Bounds, [f64; 3]),
        scale: &PlanScale,
        work: &StepBudget,
    ) -> Self {
        let side_m = tile.width().max(tile.height());
        let longest_m = LONGEST_M.max(side_m / MOST_PIECES);
        let own_ends: Vec<LineEnds> = decks.iter().filter_map(DeckLine::ends).collect();
        let joints = Joints::new(ground.ends.iter().chain(&own_ends));
        let mut pieces = Vec::new();
        for deck in decks {
            let points_m = distinct(&deck.points_m);
            let plan: Vec<[f64; 2]> = points_m.iter().map(|[x, y, _]| [*x, *y]).collect();
            let ways: Vec<[f64; 2]> =
                plan.windows(2).filter_map(|pair| direction([pair[0], pair[1]])).collect();
            let dashes = dash_starts(&plan, tile);
            let goes_on = [plan.first(), plan.last()]
                .map(|end| end.is_some_and(|at| TileSide::from_position(*at, tile).is_some()));
            // The widths of roads below a line of a layer are not known where it is drawn.
            let lands = [0, 1].map(|end| deck.is_road && deck.on_ground[end] && !goes_on[end]);
            // Its length beyond the tile is unknown.
            let length_m = plan.windows(2).map(|pair| distance(pair[0], pair[1])).sum::<f64>();
            let is_whole = deck.is_road && goes_on == [false; 2];
            let deck_m = if is_whole { length_m as f32 } else { OPEN_M };
            let slab_m = if deck.is_road { slab_thickness_m(deck.kind.class) } else { LINE_SLAB_M };
            let at_end = |at: [f64; 2], outward: [f64; 2]| match TileSide::from_position(at, tile) {
                // It continues in the next tile.
                Some(_) => Some(outward),
                None => joints.mitre(at, outward),
            };
            for (number, (pair, way)) in points_m.windows(2).zip(&ways).enumerate() {
                let back = way.map(|part| -part);
                let before = number.checked_sub(1).map(|number| ways[number]);
                let start = match before {
                    Some(before) => mitre(before, *way).map(|at| at.map(|part| -part)),
                    None => at_end(plan[number], back),
                };
                let end = match ways.get(number + 1) {
                    Some(after) => mitre(*way, *after),
                    None => at_end(plan[number + 1], *way),
                };
                let dash = dashes[number];
                let width_factor = scale.across([plan[number], plan[number + 1]]) as f32;
                let length_m = distance(plan[number], plan[number + 1]);
                let count = (length_m / longest_m).ceil().clamp(1.0, 2.0 * MOST_PIECES);
                let of_length = STEPS_OF_SIDE * (length_m / side_m).min(2.0 * MOST_PIECES);
                work.add(STEPS_OF_PIECE * count as usize + of_length as usize);
                if work.check().is_err() {
                    return Self::default();
                }
                let at = |part: f64| along(pair[0], pair[1], part / count);
                for part in 0..count as usize {
                    let [first, last] = [part as f64, part as f64 + 1.0];
                    let is_last = last >= count;
                    pieces.push(DeckPiece {
                        start_in_tile: relative(at(first), reference_m),
                        end_in_tile: relative(
                            if is_last { pair[1] } else { at(last) },
                            reference_m,
                        ),
                        mitres: [
                            if part == 0 { start.unwrap_or_default() } else { back },
                            if is_last { end.unwrap_or_default() } else { *way },
                        ]
                        .map(|mitre| mitre.map(|part| part as f32)),
                        lands: [
                            lands[0] && number == 0 && part == 0 && start.is_some(),
                            lands[1] && number + 1 == ways.len() && is_last && end.is_some(),
                        ],
                        deck_m,
                        slab_m: slab_m as f32,
                        width_factor,
                        kind: deck.kind,
                        part_m: ground.parts_m.get(&deck.way_id).copied().unwrap_or(OPEN_M),
                        dash: dash.moved(first / count * length_m),
                    });
                }
            }
        }
        Self::sorted(pieces, deck_ends(decks, tile, scale))
    }
}

/// Points where decks end on the tile's border.
fn deck_ends(decks: &[DeckLine], tile: Bounds, scale: &PlanScale) -> Vec<RoadEnd> {
    let mut ends = Vec::new();
    for deck in decks {
        let points_m = distinct(&deck.points_m);
        let ([first, second, ..], [.., before, last]) = (&points_m[..], &points_m[..]) else {
            continue;
        };
        let source = |ends: [&[f64; 3]; 2]| ends.map(|[x, y, _]| [*x, *y]);
        let both = [(first, source([first, second])), (last, source([before, last]))];
        ends.extend(both.into_iter().filter_map(|(point, source_m)| {
            RoadEnd::at((deck.way_id, deck.kind), *point, source_m, (tile, scale))
        }));
    }
    ends
}

#[cfg(test)]
#[path = "decks_tests.rs"]
mod tests;
