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
    /// Bridges and tunnels of roads, and those of railways alone.
    of_roads: [u64; 2],
    of_railways: [u64; 2],
    /// Crossings by what is above and what is below: roads or railways.
    crossings: BTreeMap<[String; 2], u64>,
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
    /// Counts solved decks with a road of the package or a railway in the requested region;
    /// `within` are those with the ground on the wrong side.
    #[must_use]
    pub fn from_network(
        network: &SpanNetwork,
        decks: &Decks,
        within: BTreeSet<SpanProblem>,
        (mut outer, without_ground): (Vec<OuterGround>, u64),
    ) -> Self {
        let spans = decks.spans();
        let own: BTreeMap<usize, SpanKind> =
            spans.chains().map(|chain| (chain.span, chain.kind)).collect();
        let count_of = |is_of: &dyn Fn([bool; 2]) -> bool| {
            [SpanKind::Bridge, SpanKind::Tunnel].map(|kind| {
                let own = own.iter().filter(|&(_, own)| *own == kind);
                own.filter(|&(&span, _)| is_of(network.is_counted[span])).count() as u64
            })
        };
        let is_counted = |way_id: &i64| network.counted_ways.binary_search(way_id).is_ok();
        let mut problems = decks.problems(&|way_id| is_counted(&way_id));
        problems.extend(within.into_iter().filter(|problem| is_counted(&problem.way_id)));
        problems.sort_unstable();
        let crossings = decks.free_heights().iter().filter(|found| {
            let both = [found.crossing.upper, found.crossing.lower];
            both.iter().any(|place| place.kind.is_some() && is_counted(&place.way_id))
        });
        let mut by_layers: BTreeMap<[String; 2], u64> = BTreeMap::new();
        for found in crossings {
            let both = [found.crossing.upper, found.crossing.lower];
            let layers = both.map(|place| if place.is_railway { "railways" } else { "roads" });
            *by_layers.entry(layers.map(str::to_owned)).or_default() += 1;
        }
        outer.sort_unstable_by_key(|own| own.at);
        outer.dedup_by_key(|own| own.at);
        let problems = problems.iter();
        Self {
            of_roads: count_of(&|[by_roads, _]| by_roads),
            of_railways: count_of(&|[by_roads, by_railways]| by_railways && !by_roads),
            crossings: by_layers,
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
        let &Self { of_roads: [bridges, tunnels], of_railways, .. } = self;
        let [railway_bridges, railway_tunnels] = of_railways;
        let crossings = self.crossings.iter();
        let crossings =
            crossings.map(|([upper, lower], count)| (upper.clone(), lower.clone(), *count));
        let [bridges_um, tunnels_um] = [Structure::Bridge, Structure::Tunnel]
            .map(|structure| kept.kept_by_structure_um[structure as usize]);
        let reasons = reasons.into_iter().collect();
        SpanCounts {
            bridges,
            tunnels,
            bridges_um,
            tunnels_um,
            railway_bridges,
            railway_tunnels,
            crossings: crossings.collect(),
            reasons,
        }
    }
}
