//! Roads on bridges and in tunnels, as lines above and below laid ground.

use corniche_roads::Structure;
use corniche_spans::SpanKind;

use crate::{
    dem_ground::{DemLine, DemNodes, lay},
    error::ElevationError,
    grades::{SmoothLine, Station, stretch_of_way},
    measures::distances_m,
    piece::Vertex,
};

/// A line that bends by no more than this is straight there, metres: only rounding. Hundreds of such bends in a row are no millimetre.
const STRAIGHT_M: f64 = 1e-9;

/// A line on its deck.
#[derive(Debug, Clone, PartialEq)]
struct RaisedLine {
    vertices: Vec<Vertex>,
    /// Whether parts of it lie on the ground, which comes in the way of the deck there.
    is_on_ground: bool,
}

/// What may carry a line.
pub(crate) struct Carrier<'a> {
    pub(crate) structure: Structure,
    /// The smooth lines of its way.
    pub(crate) way: &'a [SmoothLine],
    /// How far lines are from their way at most.
    pub(crate) most_steps: f64,
    /// Whether lines run against their way.
    pub(crate) is_turned: bool,
}

/// Lays a line on the elevation files, and on its deck where that is known.
pub(crate) fn lay_on_deck(
    nodes: &mut DemNodes<'_>,
    line: &[Vertex],
    carrier: &Carrier<'_>,
    distance_m: &dyn Fn([f64; 2], [f64; 2]) -> f64,
) -> Result<Vec<DemLine>, ElevationError> {
    let Carrier { structure, way, most_steps, is_turned } = *carrier;
    let mut lines = lay(nodes, line)?;
    for line in lines.iter_mut().filter(|_| structure != Structure::Ground) {
        // Decks know the direction of their ways.
        let along_way = |mut vertices: Vec<Vertex>| {
            if is_turned {
                vertices.reverse();
            }
            vertices
        };
        let ground = along_way(line.vertices.clone());
        let raised = on_deck(structure, &ground, (way, most_steps), distance_m);
        if let Some(RaisedLine { vertices, is_on_ground }) = raised {
            line.vertices = along_way(vertices);
            line.on_deck = true;
            // A deck lies on the ground where that is in its way.
            line.tolerance_m = line.tolerance_m.filter(|_| is_on_ground);
        }
    }
    Ok(lines)
}

/// Puts a line of a bridge or a tunnel, which was laid on the ground, where its deck is: `way` are the decks of its way. A bridge never lies below
/// the ground, a tunnel never above: where the ground is in the way, it has the bends of the ground. `None` where the deck is not known.
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
    distance_m: &dyn Fn([f64; 2], [f64; 2]) -> f64,
) -> Option<RaisedLine> {
    let kind = SpanKind::of(structure)?;
    let along_m = distances_m(ground.iter().map(|vertex| vertex.at), distance_m);
    let length_m = along_m.last().copied().unwrap_or_default();
    let [from_m, to_m] = stretch_of_way(way, ground, length_m, most_steps)?;
    let deck = way.iter().find(|line| line.reaches([from_m, to_m]))?;
    // Lines that are simplified are shorter than their ways; ends lie at their places to the bit.
    let place_m = |at_m: &f64| {
        if *at_m >= length_m { to_m } else { from_m + at_m * (to_m - from_m) / length_m }
    };
    let mut places: Vec<OverGround> = Vec::with_capacity(ground.len());
    let inner = |bend: &&Station| bend.along_m > from_m && bend.along_m < to_m;
    let mut bends = deck.stations.iter().filter(inner).peekable();
    for (at_m, vertex) in along_m.iter().map(place_m).zip(ground) {
        let before = places.last().copied();
        // Where the deck bends between two vertices, the ground is straight.
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

/// The vertices without those that are no points of the way, and at which the line is straight.
fn without_straight(all: &[(f64, Vertex)]) -> Vec<Vertex> {
    let mut kept: Vec<(f64, Vertex)> = Vec::with_capacity(all.len());
    for (index, &(at_m, at)) in all.iter().enumerate() {
        // Measured from what is kept: of two at one place, or nearly, each is straight between the other and what is beyond it.
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
