//! What is known of all bridges and tunnels together.

use std::collections::BTreeMap;

use corniche_spans::{Decks, SpanKind};
use corniche_tileset::SpanCounts;
use serde::{Deserialize, Serialize};

/// Counts of bridges and tunnels, and what is to be told of them. They are kept after all sections.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct SpanTotals {
    bridges: u64,
    tunnels: u64,
    crossings: u64,
    /// What is to be told of spans: the reason and a way.
    pub(crate) problems: Vec<(String, i64)>,
}

impl SpanTotals {
    pub(crate) fn of(decks: &Decks) -> Self {
        let problems = decks.problems().iter();
        let [bridges, tunnels] =
            [SpanKind::Bridge, SpanKind::Tunnel].map(|kind| decks.spans().count_of(kind));
        Self {
            bridges,
            tunnels,
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
        let &Self { bridges, tunnels, crossings, .. } = self;
        SpanCounts { bridges, tunnels, crossings, reasons: reasons.into_iter().collect() }
    }
}
