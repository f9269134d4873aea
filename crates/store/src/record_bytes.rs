//! Records as bytes by serde, for values that a step stores and reads back.

use serde::{Serialize, de::DeserializeOwned};

/// No record takes this many bytes; damaged bytes may claim a text of any length.
const MOST_BYTES: usize = 1 << 28;

/// Appends a record to `bytes`.
///
/// # Panics
/// When the type cannot be serialised, such as a list of unknown length: this is a fault of the
/// program, and half a record must not be stored.
pub fn append_record(bytes: &mut Vec<u8>, record: impl Serialize) {
    let written = bincode::serde::encode_into_std_write(record, bytes, bincode::config::standard());
    assert!(written.is_ok(), "a record cannot be written: {written:?}");
}

/// Returns a record as bytes.
#[must_use]
pub fn record_bytes(record: impl Serialize) -> Vec<u8> {
    let mut bytes = Vec::new();
    append_record(&mut bytes, record);
    bytes
}

/// Takes a record that [`append_record`] wrote from the front of `bytes`; `None` if there is no
/// such record.
pub fn take_record<T: DeserializeOwned>(bytes: &mut &[u8]) -> Option<T> {
    let limited = bincode::config::standard().with_limit::<MOST_BYTES>();
    let (record, used) = bincode::serde::decode_from_slice(bytes, limited).ok()?;
    *bytes = bytes.get(used..)?;
    Some(record)
}

#[cfg(test)]
#[path = "record_bytes_tests.rs"]
mod tests;
