//! What is told of the bridges and tunnels of a network.

use std::collections::BTreeMap;

use corniche_spans::Decks;

/// How many bridges and tunnels a network has, and what is to be known of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpanFacts {
    /// Bridges and tunnels, each with all ways that it connects.
    pub spans: u64,
    /// Where they cross other roads or each other.
    pub crossings: u64,
    /// How often there is a reason to look at one, by its name.
    pub reasons: BTreeMap<&'static str, u64>,
}

impl SpanFacts {
    pub(crate) fn of(decks: &Decks) -> Self {
        let mut reasons = BTreeMap::new();
        for problem in decks.problems() {
            *reasons.entry(problem.reason.id()).or_default() += 1;
        }
        let crossings = decks.free_heights().len() as u64;
        Self { spans: decks.spans().len() as u64, crossings, reasons }
    }
}

/// The least height between each bridge or tunnel and what it crosses, by way.
pub(crate) fn least_free_heights(decks: &Decks) -> BTreeMap<i64, f64> {
    let mut least: BTreeMap<i64, f64> = BTreeMap::new();
    for found in decks.free_heights() {
        let Some(free_m) = found.free_m else { continue };
        let both = [found.crossing.upper, found.crossing.lower];
        for place in both.into_iter().filter(|place| place.kind.is_some()) {
            let own_m = least.entry(place.way_id).or_insert(free_m);
            *own_m = own_m.min(free_m);
        }
    }
    least
}
