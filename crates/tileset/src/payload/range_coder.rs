//! A binary arithmetic coder whose probabilities adapt to the bits coded so far.
//!
//! Source: Martin 1979, *Range encoding*, in the form that LZMA uses (32-bit range, carries through
//! a byte that is held back). Each probability is the mean of two estimates that adapt at different
//! speeds.

use crate::payload::damage::{Damage, Result};

/// The common interface of both directions of coding, so that the code which defines the order of
/// bits is written once. A writer takes `bit` and returns it; a reader ignores it and returns the
/// bit that it read.
pub(crate) trait Bits {
    /// Codes a bit with the probability of `model`, which adapts to it.
    fn bit(&mut self, model: &mut Model, bit: u32) -> u32;
    /// Codes a bit with the mean of the probabilities of two models, which both adapt to it.
    fn mixed(&mut self, models: [&mut Model; 2], bit: u32) -> u32;
    /// Codes a bit that is 0 or 1 with equal probability.
    fn even(&mut self, bit: u32) -> u32;
}

/// The probability of a 0 in 65 536ths: one estimate that adapts fast, in the upper half, and one
/// that adapts slowly.
///
/// Both are in one integer because they are read together: a processor stalls if it reads in one
/// piece what it has just written in two.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Model(u32);

impl Default for Model {
    fn default() -> Self {
        Self::NEW
    }
}

/// The smallest probability of either bit, in 65 536ths.
const LEAST: u32 = 48;

impl Model {
    /// A model that has not adapted to any bits yet.
    pub(crate) const NEW: Self = Self(1 << 31 | 1 << 15);

    /// The sum of both estimates.
    #[inline]
    fn sum(self) -> u32 {
        (self.0 >> 16) + (self.0 & 0xffff)
    }

    #[inline]
    fn of_zero(self) -> u32 {
        (self.sum() >> 1).clamp(LEAST, (1 << 16) - LEAST)
    }

    /// The mean of the estimates of two models.
    #[inline]
    fn of_zero_in_both([one, other]: [&Self; 2]) -> u32 {
        ((one.sum() + other.sum()) >> 2).clamp(LEAST, (1 << 16) - LEAST)
    }

    /// A 16th of the fast estimate, and a 128th of the slow estimate.
    #[inline]
    fn parts(estimates: u32) -> u32 {
        ((estimates >> 4) & 0x0fff_0000) | ((estimates & 0xffff) >> 7)
    }

    #[inline]
    fn learn(&mut self, bit: u32) {
        if bit == 0 {
            self.0 += Self::parts(!self.0);
        } else {
            self.0 -= Self::parts(self.0);
        }
    }
}

/// If the range is smaller than this, it is widened by a byte.
const LEAST_RANGE: u32 = 1 << 24;

/// Writes bits.
#[cfg(feature = "write")]
#[derive(Debug)]
pub(crate) struct BitWriter {
    out: Vec<u8>,
    low: u64,
    range: u32,
    /// The byte that a carry may still change, and the number of bytes of 255 that follow it.
    held: u8,
    after_held: u64,
    is_first: bool,
}

#[cfg(feature = "write")]
impl BitWriter {
    /// Begins to write after the bytes that are already in `out`.
    pub(crate) fn new(out: Vec<u8>) -> Self {
        Self { out, low: 0, range: u32::MAX, held: 0, after_held: 0, is_first: true }
    }

    /// Returns all bytes.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        for _ in 0..5 {
            self.shift();
        }
        self.out
    }

    fn shift(&mut self) {
        let carry = (self.low >> 32) as u8;
        if carry == 1 || self.low < 0xff00_0000 {
            if !self.is_first {
                self.out.push(self.held.wrapping_add(carry));
            }
            for _ in 0..self.after_held {
                self.out.push(0xff_u8.wrapping_add(carry));
            }
            (self.is_first, self.after_held) = (false, 0);
            self.held = (self.low >> 24) as u8;
        } else {
            self.after_held += 1;
        }
        self.low = (self.low & 0x00ff_ffff) << 8;
    }

    /// Narrows the range without a branch on the bit, because the processor cannot predict bits
    /// that carry information.
    #[inline]
    fn narrow(&mut self, bound: u32, bit: u32) {
        self.low += u64::from(bound & bit.wrapping_neg());
        self.range = if bit == 0 { bound } else { self.range - bound };
        while self.range < LEAST_RANGE {
            self.range <<= 8;
            self.shift();
        }
    }
}

#[cfg(feature = "write")]
impl Bits for BitWriter {
    #[inline]
    fn bit(&mut self, model: &mut Model, bit: u32) -> u32 {
        self.narrow((self.range >> 16) * model.of_zero(), bit);
        model.learn(bit);
        bit
    }

    #[inline]
    fn mixed(&mut self, [one, other]: [&mut Model; 2], bit: u32) -> u32 {
        self.narrow((self.range >> 16) * Model::of_zero_in_both([one, other]), bit);
        one.learn(bit);
        other.learn(bit);
        bit
    }

    #[inline]
    fn even(&mut self, bit: u32) -> u32 {
        self.narrow(self.range >> 1, bit);
        bit
    }
}

/// Reads bits. Beyond the end it reads zeros, so that work is limited by the number of requested
/// bits; [`BitReader::is_exact`] reports afterwards whether all bytes were read, and no more.
#[derive(Debug)]
pub(crate) struct BitReader<'a> {
    bytes: &'a [u8],
    /// Number of bytes read, including those beyond the end.
    taken: usize,
    code: u32,
    range: u32,
}

impl<'a> BitReader<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let mut reader = Self { bytes, taken: 0, code: 0, range: u32::MAX };
        for _ in 0..4 {
            reader.widen();
        }
        reader
    }

    /// Whether more bytes were read than there are. A complete string is never read beyond its end.
    pub(crate) fn is_past_end(&self) -> bool {
        self.taken > self.bytes.len()
    }

    /// Whether all bytes, and no more, were read.
    pub(crate) fn is_exact(&self) -> bool {
        self.taken == self.bytes.len()
    }

    /// Fails if more bytes were read than there are: beyond the end come any number of zeros.
    pub(crate) fn check_end(&self) -> Result<()> {
        if self.is_past_end() { Err(Damage::TooShort) } else { Ok(()) }
    }

    /// Fails unless all bytes, and no more, were read.
    pub(crate) fn finish(&self) -> Result<()> {
        if self.is_exact() { Ok(()) } else { Err(Damage::Invalid("the length of the coded bits")) }
    }

    #[inline]
    fn widen(&mut self) {
        let byte = self.bytes.get(self.taken).copied().unwrap_or_default();
        self.taken += 1;
        self.code = (self.code << 8) | u32::from(byte);
    }

    /// Handles a bit of 0: the code is below the bound.
    #[inline]
    fn take_zero(&mut self, bound: u32) {
        self.range = bound;
        self.widen_range();
    }

    /// Handles a bit of 1: the code is at or above the bound.
    #[inline]
    fn take_one(&mut self, bound: u32) {
        self.code -= bound;
        self.range -= bound;
        self.widen_range();
    }

    #[inline]
    fn widen_range(&mut self) {
        while self.range < LEAST_RANGE {
            self.range <<= 8;
            self.widen();
        }
    }
}

// Each bit with a model has one branch, and everything that depends on the bit follows it: a
// processor that predicts the branch starts with the next bit before this one is computed.
impl Bits for BitReader<'_> {
    #[inline]
    fn bit(&mut self, model: &mut Model, _: u32) -> u32 {
        let bound = (self.range >> 16) * model.of_zero();
        if self.code < bound {
            model.learn(0);
            self.take_zero(bound);
            0
        } else {
            model.learn(1);
            self.take_one(bound);
            1
        }
    }

    #[inline]
    fn mixed(&mut self, [one, other]: [&mut Model; 2], _: u32) -> u32 {
        let bound = (self.range >> 16) * Model::of_zero_in_both([one, other]);
        if self.code < bound {
            one.learn(0);
            other.learn(0);
            self.take_zero(bound);
            0
        } else {
            one.learn(1);
            other.learn(1);
            self.take_one(bound);
            1
        }
    }

    /// The processor cannot predict these bits, so there is no branch.
    #[inline]
    fn even(&mut self, _: u32) -> u32 {
        let bound = self.range >> 1;
        let bit = u32::from(self.code >= bound);
        self.code -= bound & bit.wrapping_neg();
        // For an odd range, the part for a 1 is larger by one.
        self.range = bound + (self.range & bit);
        self.widen_range();
        bit
    }
}

#[cfg(all(test, feature = "write"))]
#[path = "range_coder_tests.rs"]
mod tests;
