//! How many ways of boundaries an extract had, and how many were kept or lost.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;

use crate::boundary_loss::BoundaryLoss;

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
