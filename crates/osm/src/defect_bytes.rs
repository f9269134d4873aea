//! Defects are written as bytes and read back.

use crate::Defect;

/// More than any defect takes: its text is a key and a value of 255 characters each at most.
const MOST_DEFECT_BYTES: usize = 1 << 16;

/// Appends a defect.
pub(crate) fn push_defect(bytes: &mut Vec<u8>, defect: &Defect) {
    // Writing to a list cannot fail, and every defect can be written.
    let written = bincode::serde::encode_into_std_write(defect, bytes, bincode::config::standard());
    debug_assert!(written.is_ok(), "{defect:?}");
}

/// Takes a defect from the front; `None` where the bytes hold none.
pub(crate) fn take_defect(bytes: &mut &[u8]) -> Option<Defect> {
    // Damaged bytes may claim a text of any length.
    let limited = bincode::config::standard().with_limit::<MOST_DEFECT_BYTES>();
    let (defect, used) = bincode::serde::decode_from_slice(bytes, limited).ok()?;
    *bytes = bytes.get(used..)?;
    Some(defect)
}
