//! The layers of a package: their tables, and what became of the objects of the extract.

use corniche_layers::LayerForm;
use serde::{Deserialize, Serialize};

use crate::manifest::levels::SectionLevelRecord;

/// A layer of a package.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LayerRecord {
    /// The table of the layer, as it was read.
    pub table: LayerForm,
    /// Numbers of objects read, kept and lost.
    pub counts: LayerCounts,
    /// The objects of the tiles, by level; levels without objects are omitted.
    pub levels: Vec<SectionLevelRecord>,
}

/// Objects of the extract that belong to a layer: `objects` = objects of `kept` + objects of
/// `lost`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LayerCounts {
    /// Number of objects; a way of several relations counts once.
    pub objects: u64,
    /// The objects that were read, by class, inside and outside the built region.
    pub kept: Vec<LayerClassRecord>,
    /// The objects that were lost, by reason.
    pub lost: Vec<(String, u64)>,
    /// Values of attributes that are not of the attribute's kind, by key.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unread_values: Vec<(String, u64)>,
}

/// Objects of one class.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LayerClassRecord {
    /// The number of the class in the table.
    pub class: u8,
    /// Number of objects.
    pub objects: u64,
    /// The true length of lines in plan, in micrometres, inside and outside the built region.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub length_um: u64,
    /// The true area in square kilometres, inside and outside the built region; where areas
    /// overlap, each of them counts.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub area_km2: f64,
}

/// For serde: only lines have a length, and only areas an area.
fn is_zero<Measure: Default + PartialEq>(measure: &Measure) -> bool {
    *measure == Measure::default()
}
