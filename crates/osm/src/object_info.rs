//! Metadata of an object: its version, and whether it is deleted.

use crate::wire::{self, WireValue};

/// The metadata of an object (message `Info`).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Info {
    /// The version; 0 if it is unknown.
    pub(crate) version: i32,
    pub(crate) is_deleted: bool,
}

impl Info {
    /// Reads the metadata in a message.
    pub(crate) fn read(&mut self, message: &[u8]) {
        for field in wire::fields(message).flatten() {
            match (field.number, field.value) {
                (1, WireValue::Varint(version)) => self.version = to_version(version),
                (6, WireValue::Varint(is_visible)) => self.is_deleted = is_visible == 0,
                _ => {}
            }
        }
    }
}

/// Converts an `int32`. A negative number is written as ten bytes, and a number that does not fit
/// is not a version.
pub(crate) fn to_version(number: u64) -> i32 {
    i32::try_from(number.cast_signed()).unwrap_or(0)
}
