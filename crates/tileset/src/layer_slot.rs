//! The position of a layer among the layers of a package.

use corniche_layers::MAX_LAYERS;
use serde::{Deserialize, Serialize};

/// The position of a layer in the list of a package's layers, from 0: it determines which sections
/// the layer's objects are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct LayerSlot(u8);

impl LayerSlot {
    /// Returns the position; `None` if a package cannot have that many layers.
    #[must_use]
    pub fn new(index: impl TryInto<u8>) -> Option<Self> {
        index.try_into().ok().filter(|&index| usize::from(index) < MAX_LAYERS).map(Self)
    }

    /// Returns the index in the list of layers.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}
