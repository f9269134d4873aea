//! What is told of the bridges and tunnels of a network.

use std::collections::{BTreeMap, BTreeSet};

use corniche_spans::{Decks, FreeHeight, SpanProblem, SpanReason};

/// How many bridges and tunnels a network has, and what is to be known of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SpanFacts {
    /// Bridges and tunnels, each with all ways that it connects.
    pub spans: u64,
    /// Where they cross other roads or each other.
    pub crossings: u64,
    /// How often there is a reason to look at one, by its name.
    pub reasons: BTreeMap<&'static str, u64>,
    /// The nodes at which a road on the ground meets a span and does not carry it, in order.
    pub ground_nodes: Vec<i64>,
}

/// The bridges and tunnels that are told of: those of a package. Others are solved because these depend on them.
#[derive(Default)]
pub(crate) struct ToldSpans {
    /// The numbers of these spans.
    pub(crate) spans: BTreeSet<usize>,
    /// The ids of all ways of these spans.
    pub(crate) ways: BTreeSet<i64>,
}

impl SpanFacts {
    pub(crate) fn of(decks: &Decks, told: &ToldSpans) -> Self {
        let problems = decks.problems(&|way_id| told.ways.contains(&way_id));
        let mut reasons = BTreeMap::new();
        for problem in &problems {
            *reasons.entry(problem.reason.id()).or_default() += 1;
        }
        let is_told = |found: &&FreeHeight| {
            let both = [found.crossing.upper, found.crossing.lower];
            both.iter().any(|place| place.kind.is_some() && told.ways.contains(&place.way_id))
        };
        let crossings = decks.free_heights().iter().filter(is_told).count() as u64;
        let ground = |own: &&SpanProblem| own.reason == SpanReason::GroundWayOnDeck;
        let nodes = problems.iter().filter(ground).filter_map(|own| own.node_id);
        let ground_nodes = nodes.collect::<BTreeSet<i64>>().into_iter().collect();
        Self { spans: told.spans.len() as u64, crossings, reasons, ground_nodes }
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
