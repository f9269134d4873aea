//! The runs of bridges and tunnels that are off the ground of a tile.
//!
//! ```text
//!             ●──────────●          a run: from the ground to the ground, or to where the tile or the road ends
//!           ╱              ╲
//!   ──────○──────╲    ╱──────○──    ○ on the ground: vertices of the draped road
//!                 ╲__╱
//! ```

use corniche_geom::LatticePoint;
use corniche_spans::{Decks, SpanKind};
use corniche_tileset::{SpanHeight, SpanPoint, SpanRun};

use super::span_network::{OnCarriedLine, SpanNetwork};
use crate::{
    layers::span_pieces::SpanLineOf,
    roads::ground_lines::{SpanGroundLine, SpanGroundPoint, between},
};

/// Distance from the ground, metres, below which a deck is on the ground.
const ON_GROUND_M: f64 = 1e-6;

/// A point of a deck.
#[derive(Clone, Copy)]
struct Station {
    at: LatticePoint,
    along_um: u64,
    /// The triangle of the tile that gives the ground's height here.
    triangle: u32,
    /// The height of the deck off the ground, metres: negative where the deck is within the ground;
    /// `None` if it is unknown.
    off_m: Option<f64>,
    deck_m: f64,
    /// Whether a run has a vertex here.
    is_bend: bool,
}

impl Station {
    fn is_off(&self) -> bool {
        self.off_m.is_some_and(|off_m| off_m > ON_GROUND_M)
    }
}

/// The runs of a bridge or a tunnel on a line.
pub(crate) struct LineRuns {
    /// The runs that are off the ground.
    pub runs: Vec<SpanRun>,
    /// The largest distance by which the ground is on the wrong side of the deck, metres: there the
    /// deck stays on the ground.
    pub within_m: f64,
}

/// Returns the runs of a line. Heights are multiples of `quantum_m`, rounded away from the ground,
/// so a bridge is never below it, and a tunnel never above.
pub(crate) fn runs_of(
    line: &SpanGroundLine,
    (network, decks): (&SpanNetwork, &Decks),
    quantum_m: f64,
) -> LineRuns {
    let steps = |deck_m: f64| match line.kind() {
        SpanKind::Bridge => (deck_m / quantum_m).ceil() as i64,
        SpanKind::Tunnel => (deck_m / quantum_m).floor() as i64,
    };
    let stations = stations(line, (network, decks));
    let within_m = stations
        .iter()
        .filter_map(|own| own.off_m)
        .fold(0.0, |most_m, off_m| f64::max(most_m, -off_m));
    let mut runs = Vec::new();
    let mut first = 0;
    while first < stations.len() {
        let off = stations[first..].iter().take_while(|station| station.is_off()).count();
        if off == 0 {
            first += 1;
            continue;
        }
        let [from, to] = [first.saturating_sub(1), (first + off + 1).min(stations.len())];
        let own = &stations[from..to];
        let is_needed = |index: usize| index == 0 || index + 1 == own.len() || own[index].is_bend;
        let point = |station: &Station| {
            let height = if station.is_off() {
                SpanHeight::Steps(steps(station.deck_m))
            } else {
                SpanHeight::Ground { triangle: station.triangle }
            };
            SpanPoint { at: station.at, height }
        };
        let mut points: Vec<SpanPoint> =
            (0..own.len()).filter(|&at| is_needed(at)).map(|at| point(&own[at])).collect();
        // If two places share a lattice point, the one on the ground at an end is used.
        points.dedup_by(|next, before| {
            let is_same = next.at == before.at;
            if is_same && matches!(next.height, SpanHeight::Ground { .. }) {
                before.height = next.height;
            }
            is_same
        });
        if points.len() >= 2 {
            let SpanLineOf { way_id, owner, structure, .. } = line.of;
            runs.push(SpanRun { way_id, owner, structure, points });
        }
        first += off;
    }
    LineRuns { runs, within_m }
}

/// All places of a line at which its deck or the ground bends, or at which they meet.
fn stations(line: &SpanGroundLine, (network, decks): (&SpanNetwork, &Decks)) -> Vec<Station> {
    let station = |vertex: SpanGroundPoint, is_bend: bool| {
        let at = OnCarriedLine { line: line.of.line, along_um: vertex.along_um };
        let deck_m =
            network.on_chain(at).and_then(|(chain, along_m)| decks.height_m(chain, along_m));
        Station {
            at: vertex.at,
            along_um: vertex.along_um,
            triangle: vertex.triangle,
            off_m: deck_m.map(|deck_m| line.kind().away() * (deck_m - vertex.height_m)),
            deck_m: deck_m.unwrap_or(vertex.height_m),
            is_bend,
        }
    };
    let mut stations: Vec<Station> = Vec::new();
    let mut push = |next: Station, triangle: u32| {
        if let Some(&last) = stations.last()
            && let (Some(from_m), Some(to_m)) = (last.off_m, next.off_m)
            && last.is_off() != next.is_off()
            && from_m * to_m < 0.0
        {
            // Between two stations, deck and ground are straight: they meet here.
            let share = from_m / (from_m - to_m);
            let at = between([last.at, next.at], share);
            if at != last.at && at != next.at {
                let along = share * (next.along_um - last.along_um) as f64;
                let along_um = last.along_um + along.round() as u64;
                let off_m = Some(0.0);
                stations.push(Station { at, along_um, triangle, off_m, is_bend: false, ..last });
            }
        }
        stations.push(next);
    };
    let mut before: Option<&SpanGroundPoint> = None;
    for vertex in &line.vertices {
        if let Some(from) = before {
            let ends_um = [from.along_um, vertex.along_um];
            let mut last_at = from.at;
            for along_um in network.bends(decks, line.of.line, ends_um) {
                let share = (along_um - ends_um[0]) as f64 / (ends_um[1] - ends_um[0]) as f64;
                let at = between([from.at, vertex.at], share);
                if at == last_at || at == vertex.at {
                    continue;
                }
                last_at = at;
                let height_m = from.height_m + share * (vertex.height_m - from.height_m);
                let triangle = from.next_triangle;
                let bend = SpanGroundPoint { at, triangle, height_m, along_um, ..*from };
                push(station(bend, true), triangle);
            }
        }
        let triangle = before.map_or(vertex.triangle, |from| from.next_triangle);
        push(station(*vertex, vertex.is_source), triangle);
        before = Some(vertex);
    }
    stations
}

#[cfg(test)]
#[path = "runs_tests.rs"]
mod tests;
