//! Counts of the boundary ways of an extract: found, kept and lost.

use std::collections::BTreeMap;

use corniche_areas::BoundaryClass;

use crate::line_loss::LineLoss;

/// The boundaries of an extract, and what became of them. In numbers: `ways = kept + lost`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineSummary {
    /// Ways and relations with the tags of a class.
    pub objects: u64,
    /// Ways that have a class; each counts once.
    pub ways: u64,
    /// Delivered ways, by class.
    pub kept: BTreeMap<BoundaryClass, u64>,
    /// Skipped ways, by reason.
    pub lost: BTreeMap<LineLoss, u64>,
}
