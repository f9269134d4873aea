//! Reasons for which a way of a layer of lines is left out.

use corniche_areas::{ClassedLayer, line_text};
use serde::{Deserialize, Serialize};

/// Why a way of a layer of lines is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LineLoss {
    /// A relation names it, and the file does not have it.
    MissingWay,
    /// Too few of its nodes are in the file: no two that follow each other are left.
    MissingNodes,
    /// No two nodes that follow each other lie on Earth, at different places.
    OutOfRange,
    /// No two nodes that follow each other have a place in the working CRS, or different ones.
    OutsideProjection,
}

impl LineLoss {
    /// The name to count it under in a layer, in words.
    #[must_use]
    pub const fn reason(self, layer: ClassedLayer) -> &'static str {
        match self {
            Self::MissingWay => line_text!(layer, "way of a " one " is missing"),
            Self::MissingNodes => line_text!(layer, "way of a " one " lacks nodes"),
            Self::OutOfRange => line_text!(layer, "way of a " one " is out of range"),
            Self::OutsideProjection => {
                line_text!(layer, "way of a " one " is outside the projection")
            }
        }
    }
}
