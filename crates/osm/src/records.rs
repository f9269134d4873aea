//! What is sorted on the way from ways and nodes to roads.
//!
//! ```text
//!  WayRecord  by way id ──► Mention  by node id ──► Stop  in the order of the ways and of their nodes
//!                           Located  by node id ──┘
//! ```

use corniche_store::SortRecord;
use serde::{Deserialize, Serialize};

use crate::{
    location::Location,
    reading::Reading,
    versions::known_version,
    wire::{
        push_bytes, push_signed, push_varint, take_array, take_bytes, take_number, take_signed,
    },
};

/// A way that a layer wants, as it stands in the file.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct WayRecord {
    pub(crate) way_id: i64,
    pub(crate) origin: Origin,
    /// Its nodes, then what it is: see [`crate::way_bytes`].
    pub(crate) bytes: Box<[u8]>,
    /// What is counted of it, where it may be in several extracts; see [`crate::way_facts`]. Else empty.
    pub(crate) facts: Box<[u8]>,
}

/// Which version of an object a record is, and where it stands. The newest comes first where an object may be in several extracts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Origin {
    /// Where an object may be in several extracts: the smaller, the newer. Else 0.
    pub(crate) age: u32,
    /// How many records of its kind come before it in the extracts.
    pub(crate) order: u64,
    /// 0 if it is not known.
    pub(crate) version: i32,
    /// Which extract it is from.
    pub(crate) file: u32,
}

impl Origin {
    /// The origin of an object of a block, of which its version alone is known.
    pub(crate) fn of_version(version: i32) -> Self {
        Self { version: known_version(version).unwrap_or_default(), ..Self::default() }
    }

    /// Puts it in its place among all of its kind, of which there were `count` before.
    pub(crate) fn place(&mut self, reading: &Reading<'_>, file: u32, count: &mut u64) {
        self.age = if reading.is_of_several() { i32::MAX.abs_diff(self.version) } else { 0 };
        (self.order, self.file) = (*count, file);
        *count += 1;
    }

    fn encode(self, bytes: &mut Vec<u8>) {
        push_varint(bytes, self.age.into());
        push_varint(bytes, self.order);
        push_signed(bytes, self.version.into());
        push_varint(bytes, self.file.into());
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self {
            age: take_number(bytes)?,
            order: take_number(bytes)?,
            version: take_signed(bytes)?.try_into().ok()?,
            file: take_number(bytes)?,
        })
    }
}

impl SortRecord for WayRecord {
    fn encode(&self, bytes: &mut Vec<u8>) {
        push_signed(bytes, self.way_id);
        self.origin.encode(bytes);
        push_bytes(bytes, &self.bytes);
        push_bytes(bytes, &self.facts);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some(Self {
            way_id: take_signed(bytes)?,
            origin: Origin::decode(bytes)?,
            bytes: take_bytes(bytes)?.into(),
            facts: take_bytes(bytes)?.into(),
        })
    }

    fn extra_bytes(&self) -> usize {
        /// What the allocator keeps of each list, and rounds up to.
        const OF_ALLOCATOR_BYTES: usize = 16;
        let of_facts =
            if self.facts.is_empty() { 0 } else { self.facts.len() + OF_ALLOCATOR_BYTES };
        self.bytes.len() + OF_ALLOCATOR_BYTES + of_facts
    }
}

/// The id of a node or a way that is looked for.
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

/// A node that a way names. The nodes of all ways are numbered through, in the order of the ways.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Mention {
    pub(crate) node_id: i64,
    /// ```text
    ///  │ number: 61 bits │ the use of its way: 2 bits │ 1 if the node before it in the way is the same │
    /// ```
    visit: u64,
}

/// What a way is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WayUse {
    Road = 0,
    /// It is left out, but carries bridges and tunnels.
    Carrier = 1,
    /// It is left out: only its length is asked for.
    Length = 2,
}

impl Mention {
    /// `is_repeat`: the way names the same node directly before.
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

    /// A node that is repeated directly counts as one visit, not two.
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

/// Where a way says that one of its nodes lies (`LocationsOnWays`).
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Located {
    pub(crate) node_id: i64,
    /// How many of these come before it in the file.
    pub(crate) order: u64,
    pub(crate) location: Location,
    /// The number of the layer whose way says so.
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

/// A node of a way with its place.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Stop {
    /// ```text
    ///  │ number of the mention: 62 bits │ 1 if ways meet there that carry │ 1 if it is a junction │
    /// ```
    visit: u64,
    pub(crate) location: Location,
}

impl Stop {
    /// `is_shared`: two roads name the node, or one does twice. `is_met`: the same of roads and ways that carry them.
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
