//! Reasons for which a way that is a boundary is left out.

use serde::{Deserialize, Serialize};

/// Why a way that is a boundary is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum BoundaryLoss {
    /// A relation names it, and the file does not have it.
    MissingWay,
    /// Too few of its nodes are in the file: no two that follow each other are left.
    MissingNodes,
    /// No two nodes that follow each other lie on Earth, at different places.
    OutOfRange,
    /// No two nodes that follow each other have a place in the working CRS, or different ones.
    OutsideProjection,
}

impl BoundaryLoss {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::MissingWay, Self::MissingNodes, Self::OutOfRange, Self::OutsideProjection];

    /// The name to count it under, in words.
    #[must_use]
    pub const fn reason(self) -> &'static str {
        match self {
            Self::MissingWay => "way of a boundary is missing",
            Self::MissingNodes => "way of a boundary lacks nodes",
            Self::OutOfRange => "way of a boundary is out of range",
            Self::OutsideProjection => "way of a boundary is outside the projection",
        }
    }
}
