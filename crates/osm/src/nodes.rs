//! The positions of the nodes that roads need: a table for some of the nodes at a time.

use std::ops::ControlFlow;

use crate::{
    block::AuditedBlock,
    location::{Location, MISSING, degrees, location_from_nano},
    search::IdSearch,
};

/// Positions by node number. They are separate from the ids, so that several threads can look up
/// ids while one thread writes positions.
#[derive(Debug, Clone)]
pub(crate) struct NodePlaces {
    locations: Vec<Location>,
    /// Marks of the nodes to which the file gives different positions.
    is_conflicting: Vec<bool>,
    /// The versions of the positions with [`Precedence::Newest`]; otherwise empty.
    versions: Vec<i32>,
}

/// The rule that decides which of several positions of a node counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precedence {
    /// The first position counts.
    First,
    /// The position of the newest version counts, or the first of several.
    Newest,
}

/// A node that was found: its number, its position, and its version or 0.
pub(crate) type FoundNode = (usize, Location, i32);

/// Returns the nodes of a block that `ids` lists in ascending order, with their positions. The
/// number of a node is its index in the list. `None` if they take more than `most_bytes`.
pub(crate) fn listed_nodes(
    ids: &[i64],
    block: &AuditedBlock<'_>,
    most_bytes: u64,
) -> Option<Vec<FoundNode>> {
    let mut found = Vec::new();
    let mut search = IdSearch::new(ids);
    let end = block.try_each_node(
        |id| search.find(id),
        |number, node| {
            let location = location_from_nano(node.lon_nano_deg, node.lat_nano_deg);
            found.push((number, location, node.version));
            let is_too_much = size_of_val(found.as_slice()) as u64 > most_bytes;
            if is_too_much { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        },
    );
    end.is_continue().then_some(found)
}

impl NodePlaces {
    /// Creates a table of `count` nodes without positions.
    pub(crate) fn new(count: usize, precedence: Precedence) -> Self {
        let versions = match precedence {
            Precedence::First => Vec::new(),
            Precedence::Newest => vec![0; count],
        };
        Self { locations: vec![MISSING; count], is_conflicting: vec![false; count], versions }
    }

    /// Stores the position of a node. The first position on Earth is kept, or the position of the
    /// newest version among those on Earth. A version of 0 is unknown.
    pub(crate) fn set(&mut self, number: usize, location: Location, version: i32) {
        let own = &mut self.locations[number];
        let is_newer = match self.versions.get_mut(number) {
            Some(own) if version > *own && degrees(location).is_some() => {
                *own = version;
                true
            }
            _ => false,
        };
        if degrees(*own).is_none() {
            *own = location;
        } else if degrees(location).is_some() && *own != location {
            self.is_conflicting[number] = true;
            if is_newer {
                *own = location;
            }
        }
    }

    /// Adds the result of later blobs for a node: the first position on Earth, or the last position
    /// if none is, and whether positions differ.
    pub(crate) fn add(
        &mut self,
        number: usize,
        (location, version): (Location, i32),
        is_conflicting: bool,
    ) {
        self.set(number, location, version);
        self.is_conflicting[number] |= is_conflicting;
    }

    /// Returns the version of a node's position; 0 if it is unknown or does not matter.
    pub(crate) fn version(&self, number: usize) -> i32 {
        self.versions.get(number).copied().unwrap_or_default()
    }

    pub(crate) fn is_conflicting(&self, number: usize) -> bool {
        self.is_conflicting[number]
    }

    pub(crate) fn location(&self, number: usize) -> Location {
        self.locations[number]
    }

    /// Returns the numbers of nodes with several positions.
    pub(crate) fn conflicts(&self) -> impl Iterator<Item = usize> {
        (0..self.is_conflicting.len()).filter(|&number| self.is_conflicting[number])
    }
}
