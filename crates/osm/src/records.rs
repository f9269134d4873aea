//! The records that are sorted on the way from ways and nodes to roads.
//!
//! ```text
//!  WayRecord  by way id ──► Mention  by node id ──► Stop  in the order of the ways and of their nodes
//!                           Located  by node id ──┘
//! ```

use corniche_store::{SortRecord, append_record, take_record};
use serde::{Deserialize, Serialize};

use crate::{
    location::Location,
    reading::ExtractReading,
    versions::known_version,
    wire::{
        push_bytes, push_signed, push_varint, take_array, take_bytes, take_number, take_signed,
    },
};

/// A way that a layer needs, as it is in the file.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct WayRecord {
    pub(crate) way_id: i64,
    pub(crate) origin: Origin,
    /// The nodes of the way, then its properties: see [`crate::way_bytes`].
    pub(crate) bytes: Box<[u8]>,
    /// The facts that are counted for the way, if it may be in several extracts; see
    /// [`crate::way_facts`]. Otherwise empty.
    pub(crate) facts: Box<[u8]>,
}

/// The version of an object in a record, and the position of the record. The newest comes first if
/// an object may be in several extracts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Origin {
    /// The age, if an object may be in several extracts: a smaller number is newer. Otherwise 0.
    pub(crate) age: u32,
    /// The number of records of the same kind that come before this one in the extracts.
    pub(crate) order: u64,
    /// The version; 0 if it is unknown.
    pub(crate) version: i32,
    /// The number of the extract that contains the object.
    pub(crate) file: u32,
}

impl Origin {
    /// Returns the origin of an object in a block, of which only the version is known.
    pub(crate) fn of_version(version: i32) -> Self {
        Self { version: known_version(version).unwrap_or_default(), ..Self::default() }
    }

    /// Sets the position of the object among all objects of its kind, of which `count` came before.
    pub(crate) fn place(&mut self, reading: &ExtractReading<'_>, file: u32, count: &mut u64) {
        self.age = if reading.is_of_several() { i32::MAX.abs_diff(self.version) } else { 0 };
        (self.order, self.file) = (*count, file);
        *count += 1;
    }
}

impl SortRecord for WayRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_signed(bytes, self.way_id);
        append_record(bytes, self.origin);
        push_bytes(bytes, &self.bytes);
        push_bytes(bytes, &self.facts);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self {
            way_id: take_signed(bytes)?,
            origin: take_record(bytes)?,
            bytes: take_bytes(bytes)?.into(),
            facts: take_bytes(bytes)?.into(),
        })
    }

    fn extra_bytes(&self) -> usize {
        /// The overhead of the allocator for each list, with rounding, bytes.
        const OF_ALLOCATOR_BYTES: usize = 16;
        let of_facts =
            if self.facts.is_empty() { 0 } else { self.facts.len() + OF_ALLOCATOR_BYTES };
        self.bytes.len() + OF_ALLOCATOR_BYTES + of_facts
    }
}

/// The id of a node or a way to look for.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SoughtId(pub(crate) i64);

impl SortRecord for SoughtId {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_signed(bytes, self.0);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        take_signed(bytes).map(Self)
    }
}

/// The reference of a way to a node. The nodes of all ways are numbered consecutively, in the order
/// of the ways.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Mention {
    pub(crate) node_id: i64,
    /// ```text
    ///  │ number: 61 bits │ the use of its way: 2 bits │ 1 if the node before it in the way is the same │
    /// ```
    visit: u64,
}

/// The use of a way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WayUse {
    Road = 0,
    /// The way is skipped, but it carries bridges and tunnels.
    Carrier = 1,
    /// The way is skipped; only its length is needed.
    Length = 2,
}

impl Mention {
    /// Creates a reference. `is_repeat`: the way references the same node directly before.
    pub(crate) fn new(node_id: i64, number: u64, used: WayUse, is_repeat: bool) -> Self {
        let marks = ((used as u64) << 1) | u64::from(is_repeat);
        Self { node_id, visit: (number << 3) | marks }
    }

    pub(crate) fn number(&self) -> u64 {
        self.visit >> 3
    }

    pub(crate) fn way_use(&self) -> WayUse {
        match self.visit >> 1 & 3 {
            0 => WayUse::Road,
            1 => WayUse::Carrier,
            _ => WayUse::Length,
        }
    }

    /// Whether the way references the same node directly before. Both references count as one
    /// visit.
    pub(crate) fn is_repeat(&self) -> bool {
        self.visit & 1 == 1
    }
}

impl SortRecord for Mention {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_signed(bytes, self.node_id);
        push_varint(bytes, self.visit);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self { node_id: take_signed(bytes)?, visit: take_number(bytes)? })
    }
}

/// The position that a way gives for one of its nodes (`LocationsOnWays`).
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Located {
    pub(crate) node_id: i64,
    /// The number of such records that come before this one in the file.
    pub(crate) order: u64,
    pub(crate) location: Location,
    /// The number of the layer that contains the way.
    pub(crate) layer: u8,
}

impl SortRecord for Located {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_signed(bytes, self.node_id);
        push_varint(bytes, self.order);
        push_location(bytes, self.location);
        bytes.push(self.layer);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (node_id, order) = (take_signed(bytes)?, take_number(bytes)?);
        let location = take_location(bytes)?;
        let [layer] = take_array(bytes)?;
        Some(Self { node_id, order, location, layer })
    }
}

/// A node of a way with its position.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Stop {
    /// ```text
    ///  │ number of the mention: 62 bits │ 1 if ways meet there that carry │ 1 if it is a junction │
    /// ```
    visit: u64,
    pub(crate) location: Location,
}

impl Stop {
    /// Creates a stop. `is_shared`: two roads reference the node, or one road does so twice.
    /// `is_met`: the same for roads and the ways that carry them.
    pub(crate) fn new(number: u64, [is_shared, is_met]: [bool; 2], location: Location) -> Self {
        let marks = (u64::from(is_met) << 1) | u64::from(is_shared);
        Self { visit: (number << 2) | marks, location }
    }

    pub(crate) fn is_shared(&self) -> bool {
        self.visit & 1 == 1
    }

    pub(crate) fn is_met(&self) -> bool {
        self.visit & 2 == 2
    }
}

impl SortRecord for Stop {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_varint(bytes, self.visit);
        push_location(bytes, self.location);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self { visit: take_number(bytes)?, location: take_location(bytes)? })
    }
}

fn push_location(bytes: &mut Vec<u8>, location: Location) {
    bytes.extend(location.iter().flat_map(|part| part.to_le_bytes()));
}

fn take_location(bytes: &mut &[u8]) -> Option<Location> {
    let mut part = || take_array(bytes).map(i32::from_le_bytes);
    Some([part()?, part()?])
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
