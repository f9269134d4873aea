//! Figures of the bridges and tunnels (spans) of a network.

use std::collections::{BTreeMap, BTreeSet};

use corniche_spans::{Decks, FreeHeight, SpanProblem, SpanReason};

/// The bridges and tunnels of a network, counted, with the reasons to inspect them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SpanFacts {
    /// Bridges and tunnels, each with all ways that it connects.
    pub spans: u64,
    /// Crossings of spans with other roads or with each other.
    pub crossings: u64,
    /// The number of reasons to inspect a span, by name.
    pub reasons: BTreeMap<&'static str, u64>,
    /// The OSM nodes at which a road on the ground meets a span without supporting it, in order.
    pub ground_nodes: Vec<i64>,
}

/// The bridges and tunnels that are reported: those of a package. Others are solved because these
/// depend on them.
#[derive(Default)]
pub(crate) struct ToldSpans {
    /// The numbers of these spans.
    pub(crate) spans: BTreeSet<usize>,
    /// The ids of all ways of these spans.
    pub(crate) ways: BTreeSet<i64>,
}

impl SpanFacts {
    pub(crate) fn from_decks(decks: &Decks, told: &ToldSpans) -> Self {
        let problems = decks.problems(&|way_id| told.ways.contains(&way_id));
        let mut reasons = BTreeMap::new();
        for problem in &problems {
            *reasons.entry(problem.reason.id()).or_default() += 1;
        }
        let is_told =
            |found: &&FreeHeight| ways_of(found).any(|way_id| told.ways.contains(&way_id));
        let crossings = decks.free_heights().iter().filter(is_told).count() as u64;
        let ground = |own: &&SpanProblem| own.reason == SpanReason::GroundWayOnDeck;
        let nodes = problems.iter().filter(ground).filter_map(|own| own.node_id);
        let ground_nodes = nodes.collect::<BTreeSet<i64>>().into_iter().collect();
        Self { spans: told.spans.len() as u64, crossings, reasons, ground_nodes }
    }
}

/// Returns the least clearance between each bridge or tunnel and the roads that it crosses, by way.
pub(crate) fn least_free_heights(decks: &Decks) -> BTreeMap<i64, f64> {
    let mut least: BTreeMap<i64, f64> = BTreeMap::new();
    for found in decks.free_heights() {
        let Some(free_m) = found.free_m else { continue };
        for way_id in ways_of(found) {
            let own_m = least.entry(way_id).or_insert(free_m);
            *own_m = own_m.min(free_m);
        }
    }
    least
}

/// The ways of the bridges and tunnels at a crossing.
fn ways_of(found: &FreeHeight) -> impl Iterator<Item = i64> {
    let both = [found.crossing.upper, found.crossing.lower].into_iter();
    both.filter(|place| place.kind.is_some()).map(|place| place.way_id)
}
