//! Appends numbers, texts and bytes of records one after another, and takes them again.

use crate::{push_varint, to_zigzag, varint, zigzag};

/// Appends a number that may be negative.
pub fn push_signed(bytes: &mut Vec<u8>, number: i64) {
    push_varint(bytes, to_zigzag(number));
}

/// Appends the number of bytes, and then the bytes.
pub fn push_bytes(bytes: &mut Vec<u8>, own: &[u8]) {
    push_varint(bytes, own.len() as u64);
    bytes.extend(own);
}

/// Takes a number that must fit in the type.
pub fn take_number<T: TryFrom<u64>>(bytes: &mut &[u8]) -> Option<T> {
    varint(bytes).ok()?.try_into().ok()
}

/// Takes a number that [`push_signed`] wrote.
pub fn take_signed(bytes: &mut &[u8]) -> Option<i64> {
    varint(bytes).ok().map(zigzag)
}

/// Takes bytes that [`push_bytes`] wrote.
pub fn take_bytes<'b>(bytes: &mut &'b [u8]) -> Option<&'b [u8]> {
    let length = take_number(bytes)?;
    bytes.split_off(..length)
}

/// Takes a text whose bytes [`push_bytes`] wrote.
pub fn take_text<'b>(bytes: &mut &'b [u8]) -> Option<&'b str> {
    str::from_utf8(take_bytes(bytes)?).ok()
}

/// Takes a fixed number of bytes.
pub fn take_array<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (own, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*own)
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
