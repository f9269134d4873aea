//! A class of a layer of a package, by numbers.

use std::cmp::Reverse;

use corniche_tileset::LayerSlot;
use serde::{Deserialize, Serialize};

/// A class of a layer of a package.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct LayerClass {
    /// The layer.
    pub layer: LayerSlot,
    /// The number of the class in the layer's table.
    pub class: u8,
}

impl LayerClass {
    /// Returns classes, each once, the topmost first: those of the highest layer, and the first
    /// class of a layer.
    pub(crate) fn topmost_first(classes: impl Iterator<Item = Self>) -> Vec<Self> {
        let mut classes: Vec<Self> = classes.collect();
        classes.sort_unstable_by_key(|of| (Reverse(of.layer), of.class));
        classes.dedup();
        classes
    }
}
