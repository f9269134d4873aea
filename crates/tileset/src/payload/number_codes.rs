//! The codes for numbers that all sections use: varints and byte planes.

use corniche_varints::{BadVarint, varint};

use crate::payload::damage::{Damage, Result};

/// Writes the number of bytes that the largest value needs, then the lowest byte of all values,
/// then their second bytes, and so on: high bytes are nearly all equal and take almost no space
/// after compression.
///
/// ```text
///   n │ byte 0 of v0 v1 v2 … │ byte 1 of v0 v1 v2 … │ … n planes
/// ```
#[cfg(any(feature = "write", test))]
pub(crate) fn put_planes(out: &mut Vec<u8>, values: &[u64]) {
    let all = values.iter().fold(0, |all, value| all | value);
    let planes = (64 - all.leading_zeros()).div_ceil(8);
    out.push(planes as u8);
    for plane in 0..planes {
        out.extend(values.iter().map(|value| (value >> (8 * plane)) as u8));
    }
}

/// Numbers in byte planes, decoded one by one, so that a large count without bytes takes no memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Planes<'a> {
    bytes: &'a [u8],
    count: usize,
}

impl<'a> Planes<'a> {
    /// Iterates over the numbers.
    pub(crate) fn iter(self) -> impl Iterator<Item = u64> + 'a {
        (0..self.count).map(move |index| {
            let bytes = self.bytes.iter().skip(index).step_by(self.count.max(1));
            bytes.zip(0..).fold(0, |value, (&byte, plane)| value | u64::from(byte) << (8 * plane))
        })
    }

    /// The sum of the numbers with `each` added to every number; fails if it is larger than `most`,
    /// before memory is allocated for it.
    pub(crate) fn total(self, each: u64, most: usize, what: &'static str) -> Result<usize> {
        let mut sum = 0_u64;
        for number in self.iter() {
            sum = sum.saturating_add(number).saturating_add(each);
            Damage::limit(what, sum, most)?;
        }
        Ok(sum as usize)
    }

    /// Whether all numbers are 0 because there are no planes.
    pub(crate) fn is_absent(self) -> bool {
        self.bytes.is_empty()
    }
}

/// The largest spacing of the points of a section's lattice: a tile has 2^40 steps.
pub(crate) const MOST_SPACING: i64 = 1 << 40;

/// Takes values from the front of a byte slice.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
}

impl<'a> Cursor<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    pub(crate) fn take(&mut self, length: usize) -> Result<&'a [u8]> {
        let (head, rest) = self.bytes.split_at_checked(length).ok_or(Damage::TooShort)?;
        self.bytes = rest;
        Ok(head)
    }

    pub(crate) fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let (head, rest) = self.bytes.split_first_chunk().ok_or(Damage::TooShort)?;
        self.bytes = rest;
        Ok(*head)
    }

    pub(crate) fn byte(&mut self) -> Result<u8> {
        self.array().map(|[byte]| byte)
    }

    pub(crate) fn varint(&mut self) -> Result<u64> {
        varint(&mut self.bytes).map_err(|bad| match bad {
            BadVarint::Cut => Damage::TooShort,
            BadVarint::TooLarge => Damage::Invalid("a varint of more than 64 bits"),
        })
    }

    /// Takes a varint that is at most `limit`; `what` names it in the error.
    pub(crate) fn bounded(&mut self, limit: usize, what: &'static str) -> Result<usize> {
        let value = self.varint()?;
        usize::try_from(value).ok().filter(|&value| value <= limit).ok_or(Damage::Invalid(what))
    }

    /// Takes the spacing of a section's lattice of points; `what` names it in the error.
    pub(crate) fn spacing(&mut self, what: &'static str) -> Result<i64> {
        let step = i64::try_from(self.varint()?).ok();
        step.filter(|step| (1..=MOST_SPACING).contains(step)).ok_or(Damage::Invalid(what))
    }

    /// Takes the planes that [`put_planes`] wrote for `count` values. The caller limits `count`.
    pub(crate) fn planes(&mut self, count: usize) -> Result<Planes<'a>> {
        let planes = self.byte()?;
        Damage::invalid_if(planes > 8, "more than eight byte planes")?;
        Ok(Planes { bytes: self.take(count * usize::from(planes))?, count })
    }

    /// Takes several planes, one after another.
    pub(crate) fn columns<const N: usize>(&mut self, count: usize) -> Result<[Planes<'a>; N]> {
        let mut columns = [Planes { bytes: &[], count }; N];
        for column in &mut columns {
            *column = self.planes(count)?;
        }
        Ok(columns)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// The number of remaining bytes.
    pub(crate) fn left(&self) -> usize {
        self.bytes.len()
    }

    /// Fails if bytes remain.
    pub(crate) fn finish(&self) -> Result<()> {
        if self.is_empty() { Ok(()) } else { Err(Damage::Invalid("bytes left over at the end")) }
    }
}

/// Subtracts from `room`, the remainder of the section's limit `most`; `what` names the limited
/// value in the error.
pub(crate) fn take_room(
    room: &mut usize,
    taken: usize,
    most: usize,
    what: &'static str,
) -> Result<()> {
    let limit = most as u64;
    let too_large = Damage::TooLarge { what, length: limit + 1, limit };
    *room = room.checked_sub(taken).ok_or(too_large)?;
    Ok(())
}

#[cfg(test)]
#[path = "number_codes_tests.rs"]
mod tests;
