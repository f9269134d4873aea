//! Where the nodes lie that roads need: a table of some of them at a time.

use std::ops::ControlFlow;

use crate::{
    block::Block,
    location::{Location, MISSING, degrees, location_from_nano},
    search::Search,
};

/// Ids in ascending order; a node's number is its index here.
#[derive(Debug)]
pub(crate) struct NodeIds {
    ids: Vec<i64>,
}

/// Places by number. They are separate from the ids, so that several threads can look up ids while one thread writes
/// places.
#[derive(Debug, Clone)]
pub(crate) struct NodePlaces {
    locations: Vec<Location>,
    /// Marks nodes to which the file gives different places.
    is_conflicting: Vec<bool>,
    /// The versions of the places with [`Precedence::Newest`]; else empty.
    versions: Vec<i32>,
}

/// Which of several places of a node counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precedence {
    /// The first.
    First,
    /// The place of the newest version, or of the first of these.
    Newest,
}

/// A node that was found: its number, its place, its version or 0.
pub(crate) type FoundNode = (usize, Location, i32);

impl NodeIds {
    /// `ids` ascend, each of them once.
    pub(crate) fn new(ids: Vec<i64>) -> Self {
        Self { ids }
    }

    /// The listed nodes of a block, by number, with their places; `None` if they take more than `most_bytes`.
    pub(crate) fn scan(&self, block: &Block<'_>, most_bytes: u64) -> Option<Vec<FoundNode>> {
        let mut found = Vec::new();
        let mut search = self.search();
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

    /// The number of a node.
    pub(crate) fn number(&self, id: i64) -> Option<usize> {
        self.ids.binary_search(&id).ok()
    }

    pub(crate) fn ids(&self) -> &[i64] {
        &self.ids
    }

    /// Looks up the numbers of nodes that mostly ascend.
    pub(crate) fn search(&self) -> Search<'_> {
        Search::new(&self.ids)
    }
}

impl NodePlaces {
    /// A table of `count` nodes, none of them known.
    pub(crate) fn new(count: usize, precedence: Precedence) -> Self {
        let versions = match precedence {
            Precedence::First => Vec::new(),
            Precedence::Newest => vec![0; count],
        };
        Self { locations: vec![MISSING; count], is_conflicting: vec![false; count], versions }
    }

    /// Takes the place of a node; the first that is on Earth stays, or of these that of the newest version. A version of 0 is not known.
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

    /// Takes what is known of later places of a node: the first on Earth, or the last if none is, and whether there are several.
    pub(crate) fn add(
        &mut self,
        number: usize,
        (location, version): (Location, i32),
        is_conflicting: bool,
    ) {
        self.set(number, location, version);
        self.is_conflicting[number] |= is_conflicting;
    }

    /// The version of a node's place; 0 if it is not known or does not matter.
    pub(crate) fn version(&self, number: usize) -> i32 {
        self.versions.get(number).copied().unwrap_or_default()
    }

    pub(crate) fn is_conflicting(&self, number: usize) -> bool {
        self.is_conflicting[number]
    }

    pub(crate) fn location(&self, number: usize) -> Location {
        self.locations[number]
    }

    /// Whether a node has no place.
    pub(crate) fn is_missing(&self, number: usize) -> bool {
        self.locations[number] == MISSING
    }

    /// Numbers of nodes with several places.
    pub(crate) fn conflicts(&self) -> impl Iterator<Item = usize> {
        (0..self.is_conflicting.len()).filter(|&number| self.is_conflicting[number])
    }
}
