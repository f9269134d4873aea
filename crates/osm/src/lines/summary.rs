//! Counts of the ways of a layer of lines: found, kept and lost.

use std::collections::BTreeMap;

use crate::line_loss::LineLoss;

/// The ways of a layer of lines, and what became of them. In numbers: `ways = kept + lost`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineSummary {
    /// Ways and relations with the tags of a class.
    pub objects: u64,
    /// Ways that have a class; each counts once.
    pub ways: u64,
    /// Delivered ways, by the number of their class.
    pub kept: BTreeMap<u8, u64>,
    /// Skipped ways, by reason.
    pub lost: BTreeMap<LineLoss, u64>,
    /// Values that are not of the kinds of their attributes, by key.
    pub unread: BTreeMap<String, u64>,
}
