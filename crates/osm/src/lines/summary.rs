//! How many ways of a layer of lines an extract had, and how many were kept or lost.

use std::collections::BTreeMap;

use corniche_areas::LineClass;

use crate::line_loss::LineLoss;

/// What was in an extract and what became of it. `ways = kept + lost`, in number.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LineSummary {
    /// Ways and relations with the tags of a class.
    pub objects: u64,
    /// Ways that have a class: each counts once.
    pub ways: u64,
    /// Ways that were handed out, by class.
    pub kept: BTreeMap<LineClass, u64>,
    /// Ways that were left out.
    pub lost: BTreeMap<LineLoss, u64>,
}
