//! Packed numbers, and statements about them that do not need each number to be read.

use std::borrow::Cow;

use crate::wire::{self, WireValue, push_varint, varint, zigzag};

/// The numbers of a repeated field, one after the other: as they are in the message, or joined if
/// the message contains them in parts.
#[derive(Default)]
pub(crate) struct PackedField<'a>(Cow<'a, [u8]>);

impl<'a> PackedField<'a> {
    /// Returns the numbers in a field of a message.
    pub(crate) fn from_message(message: &'a [u8], number: u32) -> Self {
        let mut packed = Self::default();
        let fields = wire::fields(message).flatten().filter(|field| field.number == number);
        fields.for_each(|field| packed.add(field.value));
        packed
    }

    pub(crate) fn add(&mut self, value: WireValue<'a>) {
        match value {
            WireValue::Bytes(bytes) if self.0.is_empty() => self.0 = Cow::Borrowed(bytes),
            WireValue::Bytes(bytes) => self.0.to_mut().extend(bytes),
            WireValue::Varint(number) => push_varint(self.0.to_mut(), number),
            WireValue::Fixed => {}
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns how many numbers there are.
    pub(crate) fn len(&self) -> usize {
        count(&self.0)
    }

    pub(crate) fn numbers(&self) -> impl Iterator<Item = u64> {
        let mut rest = &*self.0;
        std::iter::from_fn(move || varint(&mut rest).ok())
    }

    /// Returns the running sums of the numbers, which are differences.
    pub(crate) fn sums(&self) -> impl Iterator<Item = i64> {
        self.numbers().scan(0_i64, |sum, step| {
            *sum = sum.wrapping_add(zigzag(step));
            Some(*sum)
        })
    }
}

/// Counts the numbers that are packed in some bytes: each number ends in a byte without the top
/// bit.
fn count(packed: &[u8]) -> usize {
    // So few at a time that a byte holds their count: one instruction then counts many of them.
    let ends = |some: &[u8]| some.iter().map(|byte| 1 - (byte >> 7)).sum::<u8>();
    packed.chunks(128).map(|some| usize::from(ends(some))).sum()
}

/// A number of at most this many bytes is short: it is less than [`SHORT_LIMIT`], as ids, times and
/// differences of coordinates are.
const SHORT_BYTES: usize = 5;
/// The upper limit of a short number, which is twice the upper limit of a short difference.
pub(crate) const SHORT_LIMIT: u64 = 1 << (7 * SHORT_BYTES);
/// With fewer bytes, it is as fast to read each number alone.
const WORTHWHILE_BYTES: usize = 64;

/// Counts the numbers that are packed in some bytes, if all of them are complete and short;
/// otherwise `None`.
pub(crate) fn count_short(packed: &[u8]) -> Option<u64> {
    if packed.len() < WORTHWHILE_BYTES || packed.last().is_some_and(|&last| last >= 0x80) {
        return None;
    }
    // A longer number has this many consecutive bytes with the top bit.
    let starts = packed.len() + 1 - SHORT_BYTES;
    let [first, second, third, fourth, fifth] = std::array::from_fn(|at| &packed[at..at + starts]);
    let mut all = 0;
    for at in 0..starts {
        all |= first[at] & second[at] & third[at] & fourth[at] & fifth[at];
    }
    (all < 0x80).then(|| count(packed) as u64)
}

#[cfg(test)]
#[path = "packed_tests.rs"]
mod tests;
