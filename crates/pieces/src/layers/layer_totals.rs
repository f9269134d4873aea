//! What is known of all objects of a layer together.

use std::collections::BTreeMap;

use corniche_spec::artifacts::{self, ArtifactError};
use corniche_store::Artifacts;
use corniche_tileset::{AreaClassRecord, AreaCounts, LineClassRecord, LineCounts};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::SectionLayer;

/// Counts of a layer of the extract: `objects = kept + lost`. They are kept after all sections. `M` is what its objects are measured in.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LayerTotals<M> {
    /// Objects of the layer in the extract.
    pub objects: u64,
    /// Number and measure of those of each class, by the class's number.
    pub kept: BTreeMap<u8, (u64, M)>,
    /// How many were lost, by reason.
    pub(crate) lost: BTreeMap<String, u64>,
}

/// Areas, in square metres.
pub type AreaTotals = LayerTotals<f64>;
/// Ways of a layer of lines, in micrometres.
pub type LineTotals = LayerTotals<u64>;

impl<M: Serialize + DeserializeOwned> LayerTotals<M> {
    /// Keeps them for a layer.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn put(&self, layer: SectionLayer, store: &dyn Artifacts) -> Result<(), ArtifactError> {
        artifacts::put(store, layer.totals().item(0), self)
    }

    /// `None` in a build without the layer.
    ///
    /// # Errors
    /// When it cannot be kept or read, or makes no sense.
    pub fn get(layer: SectionLayer, store: &dyn Artifacts) -> Result<Option<Self>, ArtifactError> {
        artifacts::get(store, layer.totals().item(0))
    }

    /// Whether the extract has an object that was taken.
    pub(crate) fn has_any(&self) -> bool {
        self.kept.values().any(|&(objects, _)| objects > 0)
    }

    /// How many objects were lost, by reason.
    fn lost(&self) -> Vec<(String, u64)> {
        self.lost.iter().map(|(reason, &objects)| (reason.clone(), objects)).collect()
    }
}

impl AreaTotals {
    /// What the manifest says of them.
    #[must_use]
    pub fn counts(&self) -> AreaCounts {
        let class = |(&class, &(areas, area_m2)): (&u8, &(u64, f64))| AreaClassRecord {
            class,
            areas,
            area_km2: area_m2 / 1e6,
        };
        let kept = self.kept.iter().map(class).collect();
        AreaCounts { objects: self.objects, kept, lost: self.lost() }
    }
}

impl LineTotals {
    /// What the manifest says of them.
    #[must_use]
    pub fn counts(&self) -> LineCounts {
        let class = |(&class, &(ways, length_um)): (&u8, &(u64, u64))| LineClassRecord {
            class,
            ways,
            length_um,
        };
        let kept = self.kept.iter().map(class).collect();
        LineCounts { ways: self.objects, kept, lost: self.lost() }
    }
}
