//! Roads on bridges and in tunnels, as lines above and below laid ground.

use corniche_roads::Structure;
use corniche_spans::SpanKind;

use crate::{
    grades::{SmoothLine, stretch_of_way},
    piece::Vertex,
};

/// What lies on a straight line within this is no vertex, metres.
const STRAIGHT_M: f64 = 1e-4;

/// Puts a line of a bridge or a tunnel, which was laid on the ground, where its deck is: `way` are the decks of its way. A bridge never lies below
/// the ground, a tunnel never above. `None` where the deck is not known.
///
/// ```text
///        ●────────────●       D = max(deck, ground): vertices are points of the way, where the deck bends, and where it meets the ground
///      ╱  ╲          ╱ ╲
///   ──●    ╲________╱   ●──
/// ```
pub(crate) fn on_deck(
    structure: Structure,
    ground: &[Vertex],
    (way, most_steps): (&[SmoothLine], f64),
    distance_m: &dyn Fn([f64; 2], [f64; 2]) -> f64,
) -> Option<Vec<Vertex>> {
    let kind = SpanKind::of(structure)?;
    let mut along_m = Vec::with_capacity(ground.len());
    let mut length_m = 0.0;
    along_m.push(length_m);
    for [from, to] in ground.array_windows::<2>() {
        length_m += distance_m(from.at, to.at);
        along_m.push(length_m);
    }
    let [from_m, to_m] = stretch_of_way(way, ground, length_m, most_steps)?;
    let deck = way.iter().find(|line| line.reaches([from_m, to_m]))?;
    // Lines that are simplified are shorter than their ways; ends lie at their places to the bit.
    let place_m = |at_m: &f64| {
        if *at_m >= length_m { to_m } else { from_m + at_m * (to_m - from_m) / length_m }
    };
    let places_m: Vec<f64> = along_m.iter().map(place_m).collect();
    let mut all: Vec<(f64, Vertex)> = Vec::with_capacity(ground.len());
    let mut before: Option<(f64, Vertex, f64)> = None;
    let mut bends =
        deck.stations.iter().filter(|bend| bend.along_m > from_m && bend.along_m < to_m).peekable();
    for (&at_m, vertex) in places_m.iter().zip(ground) {
        let raised_m = deck.at(at_m)?.ground_m;
        let over_m = kind.away() * (raised_m - vertex.z_m);
        if let Some((before_m, from, before_over_m)) = before {
            let between = |share: f64, z_m: f64| {
                let at =
                    [0, 1].map(|axis| from.at[axis] + share * (vertex.at[axis] - from.at[axis]));
                (before_m + share * (at_m - before_m), Vertex { at, z_m, is_source: false })
            };
            let meets = (before_over_m < 0.0) != (over_m < 0.0);
            if meets {
                let share = before_over_m / (before_over_m - over_m);
                all.push(between(share, from.z_m + share * (vertex.z_m - from.z_m)));
            }
            while let Some(bend) = bends.next_if(|bend| bend.along_m < at_m) {
                if !meets && over_m >= 0.0 && bend.along_m > before_m {
                    all.push(between((bend.along_m - before_m) / (at_m - before_m), bend.ground_m));
                }
            }
        }
        let z_m = if over_m > 0.0 { raised_m } else { vertex.z_m };
        all.push((at_m, Vertex { z_m, ..*vertex }));
        before = Some((at_m, *vertex, over_m));
    }
    Some(without_straight(&all))
}

/// The vertices without those that are no points of the way and lie on a straight line between the others.
fn without_straight(all: &[(f64, Vertex)]) -> Vec<Vertex> {
    let mut kept: Vec<(f64, Vertex)> = Vec::with_capacity(all.len());
    for (index, &(at_m, vertex)) in all.iter().enumerate() {
        let is_straight = match (kept.last(), all.get(index + 1)) {
            (Some((from_m, from)), Some((to_m, to))) if !vertex.is_source => {
                let share = (at_m - from_m) / (to_m - from_m);
                let straight_m = from.z_m + share * (to.z_m - from.z_m);
                (vertex.z_m - straight_m).abs() < STRAIGHT_M || at_m <= *from_m
            }
            _ => false,
        };
        if !is_straight {
            kept.push((at_m, vertex));
        }
    }
    kept.into_iter().map(|(_, vertex)| vertex).collect()
}

#[cfg(test)]
#[path = "deck_lines_tests.rs"]
mod tests;
