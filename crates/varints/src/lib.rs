//! Integers of variable length: seven bits per byte, lowest bits first, the top bit set on all
//! bytes but the last.
//!
//! They are used in extracts, directories of packages, tiles and the intermediate results of a
//! build. A signed number has its sign in the lowest bit (zigzag).
//!
//! Source: Google, *Protocol Buffers Documentation* (2024), "Encoding".
//!
//! This crate knows no files and no messages.

mod records;

pub use records::{
    push_bytes, push_signed, take_array, take_bytes, take_number, take_signed, take_text,
};

/// Why bytes do not begin with a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadVarint {
    /// The bytes end within the number.
    Cut,
    /// The number does not fit in 64 bits.
    TooLarge,
}

/// Takes a number from the front of some bytes.
///
/// # Errors
/// See [`BadVarint`]; the bytes do not change.
#[inline]
pub fn varint(rest: &mut &[u8]) -> Result<u64, BadVarint> {
    // Most numbers are small, so this much code is worth inlining in every loop.
    match **rest {
        [first, ref after @ ..] if first < 0x80 => {
            *rest = after;
            Ok(u64::from(first))
        }
        [first, second, ref after @ ..] if second < 0x80 => {
            *rest = after;
            Ok(u64::from(first & 0x7f) | u64::from(second) << 7)
        }
        _ => long_varint(rest),
    }
}

/// A number of three bytes or more.
fn long_varint(rest: &mut &[u8]) -> Result<u64, BadVarint> {
    const TOP_BITS: u64 = 0x8080_8080_8080_8080;
    // Up to eight bytes are read at once: their number differs from number to number, so a
    // processor would mispredict a loop over them.
    if let Some(&eight) = rest.first_chunk::<8>() {
        let word = u64::from_le_bytes(eight);
        let ends = !word & TOP_BITS;
        if ends != 0 {
            let own = word & (ends ^ (ends - 1)) & !TOP_BITS;
            let own = (own & 0x007f_007f_007f_007f) | (own & 0x7f00_7f00_7f00_7f00) >> 1;
            let own = (own & 0x0000_3fff_0000_3fff) | (own & 0x3fff_0000_3fff_0000) >> 2;
            let own = (own & 0x0000_0000_0fff_ffff) | (own & 0x0fff_ffff_0000_0000) >> 4;
            *rest = &rest[ends.trailing_zeros() as usize / 8 + 1..];
            return Ok(own);
        }
    }
    let mut number = 0;
    for (place, &byte) in rest.iter().take(10).enumerate() {
        // The tenth byte has space for one bit.
        if place == 9 && byte > 1 {
            return Err(BadVarint::TooLarge);
        }
        number |= u64::from(byte & 0x7f) << (7 * place);
        if byte < 0x80 {
            *rest = &rest[place + 1..];
            return Ok(number);
        }
    }
    Err(BadVarint::Cut)
}

/// Appends a number.
#[inline]
pub fn push_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// Decodes the zigzag code 0, 1, 2, 3 … of a signed number: 0, −1, 1, −2 …
#[must_use]
#[inline]
pub const fn zigzag(number: u64) -> i64 {
    (number >> 1).cast_signed() ^ -(number & 1).cast_signed()
}

/// Returns the zigzag code of a signed number: the inverse of [`zigzag`].
#[must_use]
#[inline]
pub const fn to_zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)).cast_unsigned()
}

#[cfg(test)]
#[path = "lib_tests.rs"]
mod tests;
