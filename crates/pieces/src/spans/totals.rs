//! The totals of all bridges and tunnels.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use corniche_roads::Structure;
use corniche_spans::{Decks, SpanKind, SpanProblem};
use corniche_tileset::{InputRecord, OuterGround, SpanCounts};
use serde::{Deserialize, Serialize};

use super::span_network::SpanNetwork;
use crate::roads::losses;

/// Counts of bridges and tunnels, and the notes about them. They are stored after all sections.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SpanTotals {
    bridges: u64,
    tunnels: u64,
    crossings: u64,
    /// Notes about spans: the reason, a way, and the node if the note concerns a node.
    pub problems: Vec<(String, i64, Option<i64>)>,
    /// Ground that is not the package's own, in ascending order of position.
    pub outer: Vec<OuterGround>,
    /// The number of places without ground that spans need.
    pub without_ground: u64,
    /// Inputs that are used for this ground alone: their indices in the plan, and their records.
    pub inputs: Vec<(u32, InputRecord)>,
}

impl SpanTotals {
    /// Counts solved decks with a road of the package in the requested region; `within` are those
    /// with the ground on the wrong side.
    #[must_use]
    pub fn from_network(
        network: &SpanNetwork,
        decks: &Decks,
        within: BTreeSet<SpanProblem>,
        (mut outer, without_ground): (Vec<OuterGround>, u64),
    ) -> Self {
        let spans = decks.spans();
        let own: BTreeMap<usize, SpanKind> = spans
            .chains()
            .filter(|chain| network.is_counted[chain.span])
            .map(|chain| (chain.span, chain.kind))
            .collect();
        let count_of = |kind| own.values().filter(|&&own| own == kind).count() as u64;
        let is_counted = |way_id: &i64| network.counted_ways.binary_search(way_id).is_ok();
        let mut problems = decks.problems(&|way_id| is_counted(&way_id));
        problems.extend(within.into_iter().filter(|problem| is_counted(&problem.way_id)));
        problems.sort_unstable();
        let crossings = decks.free_heights().iter().filter(|found| {
            let both = [found.crossing.upper, found.crossing.lower];
            both.iter().any(|place| place.kind.is_some() && is_counted(&place.way_id))
        });
        outer.sort_unstable_by_key(|own| own.at);
        outer.dedup_by_key(|own| own.at);
        let problems = problems.iter();
        Self {
            bridges: count_of(SpanKind::Bridge),
            tunnels: count_of(SpanKind::Tunnel),
            crossings: crossings.count() as u64,
            problems: problems
                .map(|own| (own.reason.id().to_owned(), own.way_id, own.node_id))
                .collect(),
            outer,
            without_ground,
            inputs: Vec::new(),
        }
    }

    /// The warning that a package whose terrain is reused lacks ground that spans need.
    #[must_use]
    pub fn told_without_ground(&self, package: &Path) -> String {
        format!(
            "bridges and tunnels need ground at {} points, but {package:?} has none there; if these points are outside its bounds, and it was built with another extract or other classes, build from the elevation files with --dem",
            self.without_ground
        )
    }

    /// The manifest's record of these totals; the lengths follow from the kept lengths of all
    /// roads.
    #[must_use]
    pub fn counts(&self, kept: &losses::Sums) -> SpanCounts {
        let mut reasons: BTreeMap<String, u64> = BTreeMap::new();
        for (reason, ..) in &self.problems {
            *reasons.entry(reason.clone()).or_default() += 1;
        }
        let &Self { bridges, tunnels, crossings, .. } = self;
        let [bridges_um, tunnels_um] = [Structure::Bridge, Structure::Tunnel]
            .map(|structure| kept.kept_by_structure_um[structure as usize]);
        let reasons = reasons.into_iter().collect();
        SpanCounts { bridges, tunnels, bridges_um, tunnels_um, crossings, reasons }
    }
}
