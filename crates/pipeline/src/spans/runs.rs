//! The runs of bridges and tunnels that are off the ground of a tile.
//!
//! ```text
//!             ●──────────●          a run: from the ground to the ground, or to where the tile or the road ends
//!           ╱              ╲
//!   ──────○──────╲    ╱──────○──    ○ on the ground: vertices of the road as it is laid
//!                 ╲__╱
//! ```

use corniche_geom::LatticePoint;
use corniche_spans::{Decks, SpanKind};
use corniche_tileset::{SpanHeight, SpanPoint, SpanRun};

use super::{
    ground_lines::{GroundLine, GroundVertex},
    span_network::{OnRoad, SpanNetwork},
};

/// What is nearer to the ground is on it, metres.
const ON_GROUND_M: f64 = 1e-6;

/// A place of a deck.
struct Station {
    at: LatticePoint,
    /// `None` where it is on the ground.
    deck_m: Option<f64>,
    /// The vertex of the ground there; `None` where the deck bends between two.
    ground: Option<GroundVertex>,
}

/// The runs of a line. Heights are multiples of `quantum_m`, rounded away from the ground, so a bridge is never below it, and a tunnel never above.
pub(crate) fn runs_of(
    line: &GroundLine,
    (network, decks): (&SpanNetwork, &Decks),
    quantum_m: f64,
) -> Vec<SpanRun> {
    let structure = line.structure();
    let Some(kind) = SpanKind::of(structure) else { return Vec::new() };
    let deck_m = |along_um: u64| {
        let (chain, along_m) = network.on_chain(OnRoad { ordinal: line.ordinal, along_um })?;
        decks.height_m(chain, along_m)
    };
    let off_ground_m = |along_um: u64, ground_m: f64| {
        deck_m(along_um).filter(|deck_m| kind.away() * (deck_m - ground_m) > ON_GROUND_M)
    };
    let mut stations: Vec<Station> = Vec::new();
    let mut before: Option<&GroundVertex> = None;
    for vertex in &line.vertices {
        if let Some(from) = before {
            let ends_um = [from.along_um, vertex.along_um];
            for along_um in network.bends(decks, line.ordinal, ends_um) {
                let share = (along_um - ends_um[0]) as f64 / (ends_um[1] - ends_um[0]) as f64;
                let ground_m = from.height_m + share * (vertex.height_m - from.height_m);
                let at = between([from.at, vertex.at], share);
                let is_between = stations.last().is_none_or(|last| last.at != at);
                // Where a deck bends below the ground it is not seen.
                let deck_m = off_ground_m(along_um, ground_m);
                if deck_m.is_some() && is_between && at != vertex.at {
                    stations.push(Station { at, deck_m, ground: None });
                }
            }
        }
        let deck_m = off_ground_m(vertex.along_um, vertex.height_m);
        stations.push(Station { at: vertex.at, deck_m, ground: Some(*vertex) });
        before = Some(vertex);
    }
    let steps = |deck_m: f64| match kind {
        SpanKind::Bridge => (deck_m / quantum_m).ceil() as i64,
        SpanKind::Tunnel => (deck_m / quantum_m).floor() as i64,
    };
    let mut runs = Vec::new();
    let mut first = 0;
    while first < stations.len() {
        let off = stations[first..].iter().take_while(|station| station.deck_m.is_some()).count();
        if off == 0 {
            first += 1;
            continue;
        }
        let [from, to] = [first.saturating_sub(1), (first + off + 1).min(stations.len())];
        let own = &stations[from..to];
        let is_needed = |index: usize| {
            let is_beside_ground = [index.wrapping_sub(1), index + 1]
                .iter()
                .any(|&beside| own.get(beside).is_none_or(|station| station.deck_m.is_none()));
            is_beside_ground || own[index].ground.is_none_or(|vertex| vertex.is_source)
        };
        let point = |station: &Station| {
            let height = match (station.deck_m, station.ground) {
                (None, Some(vertex)) => SpanHeight::Ground { triangle: vertex.triangle },
                (deck_m, _) => SpanHeight::Steps(steps(deck_m.unwrap_or_default())),
            };
            SpanPoint { at: station.at, height }
        };
        let points: Vec<SpanPoint> = (0..own.len())
            .filter(|&index| is_needed(index))
            .map(|index| point(&own[index]))
            .collect();
        if points.len() >= 2 {
            runs.push(SpanRun { way_id: line.way_id, class: line.class, structure, points });
        }
        first += off;
    }
    runs
}

/// The lattice point at a share of the way from one point to another.
fn between(ends: [LatticePoint; 2], share: f64) -> LatticePoint {
    let [from, to] = ends.map(LatticePoint::in_steps);
    let mix = |axis: usize| (from[axis] + share * (to[axis] - from[axis])).round() as i64;
    LatticePoint::new(mix(0), mix(1))
}

#[cfg(test)]
#[path = "runs_tests.rs"]
mod tests;
