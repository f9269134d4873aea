use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;
use serde::{Deserialize, Serialize};

/// Why a way that is a boundary is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum BoundaryLoss {
    /// A relation names it, and the file does not have it.
    MissingWay,
    /// So many of its nodes are not in the file that no two that follow each other are left.
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

    /// In words: the name to count it under.
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

/// What was in an extract and what became of it. `ways = kept + lost`, in number.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BoundarySummary {
    /// Ways and relations with the tags of a boundary.
    pub objects: u64,
    /// Ways that are boundaries: each counts once.
    pub ways: u64,
    /// Ways that were handed out, by class.
    pub kept: BTreeMap<BoundaryClass, u64>,
    /// Ways that were left out.
    pub lost: BTreeMap<BoundaryLoss, u64>,
}

impl BoundarySummary {
    /// Checks that every way is counted once.
    ///
    /// # Panics
    /// When one is not.
    pub fn check_invariants(&self) {
        let kept: u64 = self.kept.values().sum();
        assert_eq!(self.ways, kept + self.lost.values().sum::<u64>(), "each way counts once");
    }
}
