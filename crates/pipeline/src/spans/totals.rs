//! What is known of all bridges and tunnels together.

use std::collections::{BTreeMap, BTreeSet};

use corniche_spans::{Decks, SpanKind, SpanProblem};
use corniche_tileset::SpanCounts;
use serde::{Deserialize, Serialize};

/// Counts of bridges and tunnels, and what is to be told of them. They are kept after all sections.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct SpanTotals {
    bridges: u64,
    tunnels: u64,
    bridges_um: u64,
    tunnels_um: u64,
    crossings: u64,
    /// What is to be told of spans: the reason and a way.
    pub(crate) problems: Vec<(String, i64)>,
}

impl SpanTotals {
    /// Counts solved decks; `within` are those that the ground is on the wrong side of.
    pub(crate) fn of(decks: &Decks, within: BTreeSet<SpanProblem>) -> Self {
        let spans = decks.spans();
        let mut problems: Vec<SpanProblem> = decks.problems().to_vec();
        problems.extend(within);
        problems.sort_unstable();
        let kinds = [SpanKind::Bridge, SpanKind::Tunnel];
        let [bridges, tunnels] = kinds.map(|kind| spans.count_of(kind));
        let [bridges_um, tunnels_um] = kinds.map(|kind| spans.length_um_of(kind));
        let problems = problems.iter();
        Self {
            bridges,
            tunnels,
            bridges_um,
            tunnels_um,
            crossings: decks.free_heights().len() as u64,
            problems: problems.map(|own| (own.reason.id().to_owned(), own.way_id)).collect(),
        }
    }

    /// What the manifest says of them.
    pub(crate) fn counts(&self) -> SpanCounts {
        let mut reasons: BTreeMap<String, u64> = BTreeMap::new();
        for (reason, _) in &self.problems {
            *reasons.entry(reason.clone()).or_default() += 1;
        }
        let &Self { bridges, tunnels, bridges_um, tunnels_um, crossings, .. } = self;
        let reasons = reasons.into_iter().collect();
        SpanCounts { bridges, tunnels, bridges_um, tunnels_um, crossings, reasons }
    }
}
