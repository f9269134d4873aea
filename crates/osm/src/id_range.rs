//! Between which ids the nodes of a block lie, so that pass 2 can leave out blobs.

use serde::{Deserialize, Serialize};

use crate::{
    block::{Packed, parts},
    wire::{self, Field, Value, zigzag},
};

/// The smallest and the largest id of a block's nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct IdRange {
    pub(crate) least: i64,
    pub(crate) most: i64,
}

impl IdRange {
    /// Looks through a block (message `PrimitiveBlock`) that was audited: all of it can be read. `None` without nodes.
    pub(crate) fn scan(block: &[u8]) -> Option<Self> {
        let mut range: Option<Self> = None;
        let mut include = |id: i64| {
            let own = range.get_or_insert(Self { least: id, most: id });
            own.least = own.least.min(id);
            own.most = own.most.max(id);
        };
        for group in parts(block, 2) {
            parts(group, 1).map(plain_id).for_each(&mut include);
            for nodes in parts(group, 2) {
                Packed::of(nodes, 1).sums().for_each(&mut include);
            }
        }
        range
    }

    /// The smallest range with both in it.
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

/// The id of a plain node; if the field comes twice, the last one counts.
fn plain_id(node: &[u8]) -> i64 {
    let id_of = |field: Field<'_>| match (field.number, field.value) {
        (1, Value::Varint(id)) => Some(zigzag(id)),
        _ => None,
    };
    wire::fields(node).flatten().filter_map(id_of).last().unwrap_or_default()
}

#[cfg(test)]
#[path = "id_range_tests.rs"]
mod tests;
