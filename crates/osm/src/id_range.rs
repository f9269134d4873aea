//! The range of node ids in a block, so that pass 2 can skip blobs.

use serde::{Deserialize, Serialize};

use crate::block::AuditedBlock;

/// The smallest and the largest id of a block's nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct IdRange {
    pub(crate) least: i64,
    pub(crate) most: i64,
}

impl IdRange {
    /// Returns the range; `None` if the block has no nodes.
    pub(crate) fn scan(block: &AuditedBlock<'_>) -> Option<Self> {
        let dense = block.dense().iter().flat_map(|nodes| &nodes.ids).copied();
        let all = dense.chain(block.plain_nodes().map(|node| node.id));
        all.map(|id| Self { least: id, most: id }).reduce(Self::union)
    }

    /// Returns the smallest range that contains both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    pub(crate) fn contains(self, id: i64) -> bool {
        (self.least..=self.most).contains(&id)
    }

    /// Whether the ranges have an id in common.
    pub(crate) fn meets(self, other: Self) -> bool {
        self.least <= other.most && other.least <= self.most
    }
}

#[cfg(test)]
#[path = "id_range_tests.rs"]
mod tests;
