//! The records in blocks and their encoding: ways and their positions as they are sorted, positions
//! of nodes as differences.

use corniche_store::{SortRecord, append_record, take_record};

use super::blocks::BlockRecord;
use crate::{
    ExtractDefect,
    location::Location,
    wire::{push_varint, to_zigzag, varint, zigzag},
};

/// The position of a node according to the blobs of a share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PlaceRecord {
    pub(crate) node_id: i64,
    /// The first position on Earth; if none is on Earth, the last position.
    pub(crate) location: Location,
    /// Whether the blobs give several positions on Earth.
    pub(crate) is_conflicting: bool,
    /// The version of the position, if there are several extracts; otherwise 0.
    pub(crate) version: i32,
}

impl BlockRecord for PlaceRecord {
    /// The id and the position of the previous record.
    type Before = (i64, Location);

    /// ```text
    ///  │ id − the one before │ longitude − the one before │ latitude − the one before │ 1 if conflicting │ version │
    /// ```
    /// The numbers are zigzag varints; the mark is the lowest bit of the latitude's number.
    fn write(&self, before: &mut Self::Before, bytes: &mut Vec<u8>) {
        let (id, [lon, lat]) = *before;
        let difference = |own: i32, before: i32| to_zigzag(i64::from(own) - i64::from(before));
        push_varint(bytes, to_zigzag(self.node_id.wrapping_sub(id)));
        push_varint(bytes, difference(self.location[0], lon));
        let lat = difference(self.location[1], lat);
        push_varint(bytes, lat << 1 | u64::from(self.is_conflicting));
        push_varint(bytes, to_zigzag(self.version.into()));
        *before = (self.node_id, self.location);
    }

    fn take(before: &mut Self::Before, bytes: &mut &[u8]) -> Option<Self> {
        let mut number = || varint(bytes).ok();
        let (id, lon, lat, version) = (number()?, number()?, number()?, number()?);
        let sum = |before: i32, difference: u64| {
            i32::try_from(i64::from(before).checked_add(zigzag(difference))?).ok()
        };
        let own = Self {
            node_id: before.0.wrapping_add(zigzag(id)),
            location: [sum(before.1[0], lon)?, sum(before.1[1], lat >> 1)?],
            is_conflicting: lat & 1 == 1,
            version: zigzag(version).try_into().ok()?,
        };
        *before = (own.node_id, own.location);
        Some(own)
    }
}

/// Sorted records have the same bytes in blocks as in scratch space.
impl<T: SortRecord> BlockRecord for T {
    type Before = ();

    fn write(&self, (): &mut (), bytes: &mut Vec<u8>) {
        self.encode(bytes);
    }

    fn take((): &mut (), bytes: &mut &[u8]) -> Option<Self> {
        Self::decode(bytes)
    }
}

impl BlockRecord for ExtractDefect {
    type Before = ();

    fn write(&self, (): &mut (), bytes: &mut Vec<u8>) {
        append_record(bytes, self);
    }

    fn take((): &mut (), bytes: &mut &[u8]) -> Option<Self> {
        take_record(bytes)
    }
}

#[cfg(test)]
#[path = "kept_records_tests.rs"]
mod tests;
