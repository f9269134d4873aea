//! What is known of all boundaries together.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;
use corniche_osm::BoundarySummary;
use corniche_store::Artifacts;
use corniche_tileset::{BoundaryClassRecord, BoundaryCounts};
use serde::{Deserialize, Serialize};

use crate::{
    BuildError,
    artifacts::{self, Kind},
};

/// Counts of the extract's boundaries. It is kept after all sections.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct BoundaryTotals {
    /// Ways that are boundaries.
    ways: u64,
    /// Number of ways and micrometres of each class, by the class's number.
    kept: BTreeMap<u8, (u64, u64)>,
    /// How many were lost, by reason.
    lost: BTreeMap<String, u64>,
}

impl BoundaryTotals {
    /// `lengths_um` are the true lengths of all ways that were handed out, by class.
    pub(crate) fn of(summary: &BoundarySummary, lengths_um: &BTreeMap<BoundaryClass, u64>) -> Self {
        let kept = summary.kept.iter().map(|(class, &ways)| {
            (class.number(), (ways, lengths_um.get(class).copied().unwrap_or_default()))
        });
        let lost = summary.lost.iter();
        Self {
            ways: summary.ways,
            kept: kept.collect(),
            lost: lost.map(|(loss, &ways)| (loss.reason().to_owned(), ways)).collect(),
        }
    }

    pub(crate) fn put(&self, store: &dyn Artifacts) -> Result<(), BuildError> {
        artifacts::put(store, Kind::BoundaryTotals.item(0), self)
    }

    /// `None` in a build without boundaries.
    pub(crate) fn get(store: &dyn Artifacts) -> Result<Option<Self>, BuildError> {
        artifacts::get(store, Kind::BoundaryTotals.item(0))
    }

    /// Whether the extract has a boundary that was taken.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|&(ways, _)| ways > 0)
    }

    /// What the manifest says of them.
    pub(crate) fn counts(&self) -> BoundaryCounts {
        let class = |(&class, &(ways, length_um)): (&u8, &(u64, u64))| BoundaryClassRecord {
            class,
            ways,
            length_um,
        };
        BoundaryCounts {
            ways: self.ways,
            kept: self.kept.iter().map(class).collect(),
            lost: self.lost.iter().map(|(reason, &ways)| (reason.clone(), ways)).collect(),
        }
    }
}
