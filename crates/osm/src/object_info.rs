//! What an object says of itself: its version, and whether it is deleted.

use crate::wire::{self, Value};

/// What is known of an object (message `Info`).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Info {
    /// 0 if it is not known.
    pub(crate) version: i32,
    pub(crate) is_deleted: bool,
}

impl Info {
    /// Takes what a message says.
    pub(crate) fn read(&mut self, message: &[u8]) {
        for field in wire::fields(message).flatten() {
            match (field.number, field.value) {
                (1, Value::Varint(version)) => self.version = to_version(version),
                (6, Value::Varint(is_visible)) => self.is_deleted = is_visible == 0,
                _ => {}
            }
        }
    }
}

/// An `int32`: of a negative one, ten bytes are written, and what does not fit is no version.
pub(crate) fn to_version(number: u64) -> i32 {
    i32::try_from(number.cast_signed()).unwrap_or(0)
}
