//! Numbers packed one after the other, and what can be said of them without reading each.

use std::borrow::Cow;

use crate::wire::{self, Value, push_varint, varint, zigzag};

/// The numbers of a repeated field, one after the other: as they stand in the message, or joined if they stand there in parts.
#[derive(Default)]
pub(crate) struct Packed<'a>(Cow<'a, [u8]>);

impl<'a> Packed<'a> {
    /// The numbers in a field of a message.
    pub(crate) fn of(message: &'a [u8], number: u32) -> Self {
        let mut packed = Self::default();
        let fields = wire::fields(message).flatten().filter(|field| field.number == number);
        fields.for_each(|field| packed.add(field.value));
        packed
    }

    pub(crate) fn add(&mut self, value: Value<'a>) {
        match value {
            Value::Bytes(bytes) if self.0.is_empty() => self.0 = Cow::Borrowed(bytes),
            Value::Bytes(bytes) => self.0.to_mut().extend(bytes),
            Value::Varint(number) => push_varint(self.0.to_mut(), number),
            Value::Fixed => {}
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        count(&self.0)
    }

    pub(crate) fn numbers(&self) -> impl Iterator<Item = u64> {
        let mut rest = &*self.0;
        std::iter::from_fn(move || varint(&mut rest).ok())
    }

    /// What they add up to, one after the other, as differences.
    pub(crate) fn sums(&self) -> impl Iterator<Item = i64> {
        self.numbers().scan(0_i64, |sum, step| {
            *sum = sum.wrapping_add(zigzag(step));
            Some(*sum)
        })
    }
}

/// How many numbers are packed in some bytes: each ends in a byte without the top bit.
fn count(packed: &[u8]) -> usize {
    // So few at a time that a byte holds their count: then many are counted by one instruction.
    let ends = |some: &[u8]| some.iter().map(|byte| 1 - (byte >> 7)).sum::<u8>();
    packed.chunks(128).map(|some| usize::from(ends(some))).sum()
}

/// A number of at most this many bytes is short: it is less than [`SHORT_LIMIT`], as ids and times are, and steps between places.
const SHORT_BYTES: usize = 5;
/// What a short number is less than, and twice what a short difference is at most.
pub(crate) const SHORT_LIMIT: u64 = 1 << (7 * SHORT_BYTES);
/// With fewer bytes, reading each number alone is as fast.
const WORTHWHILE_BYTES: usize = 64;

/// How many numbers are packed in some bytes, if all of them are whole and short; `None` says nothing.
pub(crate) fn count_short(packed: &[u8]) -> Option<u64> {
    if packed.len() < WORTHWHILE_BYTES || packed.last().is_some_and(|&last| last >= 0x80) {
        return None;
    }
    // A longer number has so many bytes with the top bit beside each other.
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
