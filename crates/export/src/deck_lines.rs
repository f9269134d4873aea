//! Roads on bridges and in tunnels, as lines above and below the ground.

use corniche_roads::Structure;
use corniche_spans::SpanKind;

use crate::{
    dem_ground::{DemLine, DemNodes, lay},
    error::ElevationError,
    grades::{SmoothLine, Station, stretch_of_way},
    measures::{Metric, distances_m},
    piece::Vertex,
};

/// A line counts as straight if it bends by no more than this, metres: only rounding. Hundreds of
/// such bends in a row add up to less than a millimetre.
const STRAIGHT_M: f64 = 1e-9;

/// A line on its deck.
#[derive(Debug, Clone, PartialEq)]
struct RaisedLine {
    vertices: Vec<Vertex>,
    /// Whether parts of the line are on the ground, because the ground obstructs the deck there.
    is_on_ground: bool,
}

/// The decks that may carry a line.
pub(crate) struct Carrier<'a> {
    pub(crate) structure: Structure,
    /// The smooth lines of its way.
    pub(crate) way: &'a [SmoothLine],
    /// The largest distance of lines from their way, lattice steps.
    pub(crate) most_steps: f64,
    /// Whether lines run against their way.
    pub(crate) is_turned: bool,
}

/// Drapes a line on the elevation files, and lays it on its deck where the deck is known.
pub(crate) fn lay_on_deck(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
    carrier: &Carrier<'_>,
    distance_m: &Metric<'_>,
) -> Result<Vec<DemLine>, ElevationError> {
    let Carrier { structure, way, most_steps, is_turned } = *carrier;
    let mut lines = lay(nodes, line)?;
    for line in lines.iter_mut().filter(|_| structure != Structure::Ground) {
        // Decks follow the direction of their ways.
        let ground = along_way(line.vertices.clone(), is_turned);
        let raised = on_deck(structure, &ground, (way, most_steps), distance_m);
        if let Some(RaisedLine { vertices, is_on_ground }) = raised {
            line.vertices = along_way(vertices, is_turned);
            line.on_deck = true;
            // A deck that the ground obstructs is on the ground.
            line.tolerance_m = line.tolerance_m.filter(|_| is_on_ground);
        }
    }
    Ok(lines)
}

/// Returns vertices in the direction of their way; the same function reverses them again.
pub(crate) fn along_way(mut vertices: Vec<Vertex>, is_turned: bool) -> Vec<Vertex> {
    if is_turned {
        vertices.reverse();
    }
    vertices
}

/// Moves a line of a bridge or a tunnel from the ground to its deck; `way` contains the decks of
/// its way. A bridge is never below the ground, and a tunnel never above it: where the ground
/// obstructs the deck, the line follows the bends of the ground. Returns `None` if the deck is
/// unknown.
///
/// ```text
///        ●────────────●       D = max(deck, ground): vertices are points of the way, where the deck bends, and where it meets the ground
///      ╱  ╲          ╱ ╲
///   ──●    ╲________╱   ●──
/// ```
fn on_deck(
    structure: Structure,
    ground: &[Vertex],
    (way, most_steps): (&[SmoothLine], f64),
    distance_m: &Metric<'_>,
) -> Option<RaisedLine> {
    let kind = SpanKind::from_structure(structure)?;
    let along_m = distances_m(ground.iter().map(|vertex| vertex.at), distance_m);
    let length_m = along_m.last().copied().unwrap_or_default();
    let [from_m, to_m] = stretch_of_way(way, ground, length_m, most_steps)?;
    let deck = way.iter().find(|line| line.reaches([from_m, to_m]))?;
    // Simplified lines are shorter than their ways; ends are at their exact places.
    let place_m = |at_m: &f64| {
        if *at_m >= length_m { to_m } else { from_m + at_m * (to_m - from_m) / length_m }
    };
    let mut places: Vec<OverGround> = Vec::with_capacity(ground.len());
    let inner = |bend: &&Station| bend.along_m > from_m && bend.along_m < to_m;
    let mut bends = deck.stations.iter().filter(inner).peekable();
    for (at_m, vertex) in along_m.iter().map(place_m).zip(ground) {
        let before = places.last().copied();
        // Between two vertices the ground is straight, but the deck may bend.
        while let (Some(from), Some(bend)) = (before, bends.next_if(|bend| bend.along_m < at_m)) {
            let share = (bend.along_m - from.along_m) / (at_m - from.along_m);
            if share > 0.0 {
                let ground = from.ground.towards(*vertex, share);
                places.push(OverGround { along_m: bend.along_m, ground, deck_m: bend.ground_m });
            }
        }
        places.push(OverGround { along_m: at_m, ground: *vertex, deck_m: deck.at(at_m)?.ground_m });
    }
    let mut all: Vec<(f64, Vertex)> = Vec::with_capacity(places.len());
    let mut is_on_ground = false;
    let mut before: Option<(OverGround, f64)> = None;
    for place in places {
        let over_m = kind.away() * (place.deck_m - place.ground.z_m);
        if let Some((from, from_over_m)) = before
            && (from_over_m < 0.0) != (over_m < 0.0)
        {
            let share = from_over_m / (from_over_m - over_m);
            let along_m = from.along_m + share * (place.along_m - from.along_m);
            all.push((along_m, from.ground.towards(place.ground, share)));
        }
        let z_m = if over_m > 0.0 { place.deck_m } else { place.ground.z_m };
        all.push((place.along_m, Vertex { z_m, ..place.ground }));
        is_on_ground |= over_m < 0.0;
        before = Some((place, over_m));
    }
    Some(RaisedLine { vertices: without_straight(&all), is_on_ground })
}

/// The ground and the deck at a distance along the way.
#[derive(Clone, Copy)]
struct OverGround {
    along_m: f64,
    ground: Vertex,
    deck_m: f64,
}

/// Removes the vertices that are not points of the way and at which the line is straight.
fn without_straight(all: &[(f64, Vertex)]) -> Vec<Vertex> {
    let mut kept: Vec<(f64, Vertex)> = Vec::with_capacity(all.len());
    for (index, &(at_m, at)) in all.iter().enumerate() {
        // Measured from the vertices that are kept: of two vertices at (nearly) the same place,
        // each is straight between the other one and the next.
        let is_straight = match (kept.last(), all.get(index + 1)) {
            (Some((from_m, from)), Some((to_m, to))) => {
                let share = (at_m - from_m) / (to_m - from_m);
                let straight_m = from.z_m + share * (to.z_m - from.z_m);
                (at.z_m - straight_m).abs() < STRAIGHT_M || at_m >= *to_m
            }
            _ => false,
        };
        if at.is_source || !is_straight {
            kept.push((at_m, at));
        }
    }
    kept.into_iter().map(|(_, vertex)| vertex).collect()
}

#[cfg(test)]
#[path = "deck_lines_tests.rs"]
mod tests;
