//! What is known of all areas together.

use std::collections::BTreeMap;

use corniche_osm::AreaSummary;
use corniche_store::Artifacts;
use corniche_tileset::{AreaClassRecord, AreaCounts};
use serde::{Deserialize, Serialize};

use crate::{
    BuildError,
    artifacts::{self, Kind},
};

/// Counts of the extract's areas. It is kept after all sections.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct AreaTotals {
    /// Objects with the tags of an area.
    objects: u64,
    /// Number of areas and square metres of each class, by the class's number.
    kept: BTreeMap<u8, (u64, f64)>,
    /// How many were lost, by reason.
    lost: BTreeMap<String, u64>,
}

impl AreaTotals {
    pub(crate) fn of(summary: &AreaSummary) -> Self {
        let kept = summary.kept.iter();
        let lost = summary.lost.iter();
        Self {
            objects: summary.objects,
            kept: kept.map(|(class, kept)| (class.number(), (kept.areas, kept.area_m2))).collect(),
            lost: lost.map(|(loss, &objects)| (loss.reason().to_owned(), objects)).collect(),
        }
    }

    pub(crate) fn put(&self, store: &dyn Artifacts) -> Result<(), BuildError> {
        artifacts::put(store, Kind::AreaTotals.item(0), self)
    }

    /// `None` in a build without areas.
    pub(crate) fn get(store: &dyn Artifacts) -> Result<Option<Self>, BuildError> {
        artifacts::get(store, Kind::AreaTotals.item(0))
    }

    /// Whether the extract has an area that was taken.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|&(areas, _)| areas > 0)
    }

    /// What the manifest says of them.
    pub(crate) fn counts(&self) -> AreaCounts {
        let class = |(&class, &(areas, area_m2)): (&u8, &(u64, f64))| AreaClassRecord {
            class,
            areas,
            area_km2: area_m2 / 1e6,
        };
        AreaCounts {
            objects: self.objects,
            kept: self.kept.iter().map(class).collect(),
            lost: self.lost.iter().map(|(reason, &objects)| (reason.clone(), objects)).collect(),
        }
    }
}
