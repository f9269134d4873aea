//! What is known of all bridges and tunnels together.

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

/// Counts of bridges and tunnels, and what is to be told of them. They are kept after all sections.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SpanTotals {
    bridges: u64,
    tunnels: u64,
    crossings: u64,
    /// What is to be told of spans: the reason, a way, and the node if it is so at a node.
    pub problems: Vec<(String, i64, Option<i64>)>,
    /// Ground that is not the package's own, ascending by place.
    pub outer: Vec<OuterGround>,
    /// At how many places needed by spans there is no ground.
    pub without_ground: u64,
    /// Inputs that are used for it alone: their places in the plan, and what they are.
    pub inputs: Vec<(u32, InputRecord)>,
}

impl SpanTotals {
    /// Counts solved decks, those that a road of the package has where it was asked for; `within` are those that the ground is on the wrong side of.
    #[must_use]
    pub fn of(
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

    /// Says that a package whose terrain is taken does not have all ground that is needed.
    #[must_use]
    pub fn told_without_ground(&self, package: &Path) -> String {
        format!(
            "bridges and tunnels need ground at {} places at which {} has none; if these lie beyond its bounds, and it was made with another extract or other classes, a build from the elevation files has them",
            self.without_ground,
            package.display()
        )
    }

    /// What the manifest says of them; how long they are follows from what was kept of all roads.
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
