//! A class of a layer of a package, by numbers.

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
