//! Surprises, which are vertices of lines that differ from their guesses, in both forms of the
//! section.

use crate::{
    limits::MAX_LINE_VERTICES,
    payload::{
        damage::{Damage, Result},
        magnitudes::Magnitudes,
        number_codes::Cursor,
        range_coder::{BitReader, Bits, Model},
    },
};

/// Kinds of surprises.
pub(crate) const END: u8 = 0;
pub(crate) const SOURCE: u8 = 1;
pub(crate) const CROSSING: u8 = 2;
pub(crate) const VERTEX: u8 = 3;

const COUNT: Damage = Damage::Invalid("number of surprises");
const GAP: Damage = Damage::Invalid("position of a surprise");

/// The surprises of a line while they are read: their number; then for each surprise a gap, a kind
/// and indices.
pub(crate) trait Surprises {
    fn count(&mut self) -> Result<usize>;
    /// Reads the number of vertices that are as guessed before the next surprise.
    fn gap(&mut self) -> Result<usize>;
    fn kind(&mut self) -> Result<u8>;
    /// Reads a number of at most `last`; `what` names it in errors.
    fn index(&mut self, last: usize, what: &'static str) -> Result<u32>;
}

impl Surprises for Cursor<'_> {
    fn count(&mut self) -> Result<usize> {
        self.bounded(MAX_LINE_VERTICES, "number of surprises")
    }

    fn gap(&mut self) -> Result<usize> {
        self.bounded(MAX_LINE_VERTICES, "position of a surprise")
    }

    fn kind(&mut self) -> Result<u8> {
        self.byte()
    }

    fn index(&mut self, last: usize, what: &'static str) -> Result<u32> {
        self.bounded(last, what).map(|index| index as u32)
    }
}

/// The state of a coder of the surprises of a class.
#[derive(Default)]
pub(crate) struct SurpriseCoder {
    /// The numbers of surprises, by the flags of the line: a line with a lead-in always has one.
    counts: Magnitudes<4, 1>,
    gaps: Magnitudes<1, 1>,
    kinds: [Model; 4],
    indices: Magnitudes<1, 1>,
}

impl SurpriseCoder {
    fn code_count<B: Bits>(&mut self, bits: &mut B, flags: u8, count: u64) -> u64 {
        self.counts.code_magnitude(bits, [usize::from(flags), 0], count)
    }

    fn code_gap<B: Bits>(&mut self, bits: &mut B, gap: u64) -> u64 {
        self.gaps.code_magnitude(bits, [0; 2], gap)
    }

    fn code_kind<B: Bits>(&mut self, bits: &mut B, kind: u8) -> u8 {
        let high = bits.bit(&mut self.kinds[1], u32::from(kind >> 1));
        let low = bits.bit(&mut self.kinds[2 + high as usize], u32::from(kind & 1));
        (high << 1 | low) as u8
    }

    fn code_index<B: Bits>(&mut self, bits: &mut B, index: u64) -> u64 {
        self.indices.code_magnitude(bits, [0; 2], index)
    }

    /// Begins to read the surprises of the next line, which has these flags.
    pub(crate) fn reading<'c, 'b>(
        &'c mut self,
        bits: &'c mut BitReader<'b>,
        flags: u8,
    ) -> CodedSurprises<'c, 'b> {
        CodedSurprises { coder: self, bits, flags }
    }
}

/// The surprises of a line in range-coded bits.
pub(crate) struct CodedSurprises<'c, 'b> {
    coder: &'c mut SurpriseCoder,
    bits: &'c mut BitReader<'b>,
    flags: u8,
}

impl CodedSurprises<'_, '_> {
    fn check(&self, number: u64, last: usize, damage: Damage) -> Result<usize> {
        self.bits.check_end()?;
        usize::try_from(number).ok().filter(|&number| number <= last).ok_or(damage)
    }
}

impl Surprises for CodedSurprises<'_, '_> {
    fn count(&mut self) -> Result<usize> {
        let count = self.coder.code_count(self.bits, self.flags, 0);
        self.check(count, MAX_LINE_VERTICES, COUNT)
    }

    fn gap(&mut self) -> Result<usize> {
        let gap = self.coder.code_gap(self.bits, 0);
        self.check(gap, MAX_LINE_VERTICES, GAP)
    }

    fn kind(&mut self) -> Result<u8> {
        Ok(self.coder.code_kind(self.bits, 0))
    }

    fn index(&mut self, last: usize, what: &'static str) -> Result<u32> {
        let index = self.coder.code_index(self.bits, 0);
        self.check(index, last, Damage::Invalid(what)).map(|index| index as u32)
    }
}

#[cfg(feature = "write")]
pub(crate) use write::{Surprise, put_surprises};

#[cfg(feature = "write")]
mod write {
    use corniche_drape::DrapedVertex;
    use corniche_varints::push_varint;

    use super::{CROSSING, END, SOURCE, SurpriseCoder, VERTEX};

    use crate::payload::range_coder::BitWriter;

    /// A vertex that differs from its guess, or the end of the line.
    pub(crate) struct Surprise {
        /// The number of vertices between the previous surprise and this one, which are as guessed.
        pub as_guessed: u64,
        pub vertex: Option<DrapedVertex>,
    }

    impl Surprise {
        /// The kind and the indices of the surprise.
        fn parts(&self) -> (u8, Vec<u64>) {
            match self.vertex {
                None => (END, vec![]),
                Some(DrapedVertex::Source { triangle, .. }) => (SOURCE, vec![u64::from(triangle)]),
                Some(DrapedVertex::Crossing { a, b }) => {
                    (CROSSING, vec![u64::from(a), u64::from(b)])
                }
                Some(DrapedVertex::Vertex { vertex }) => (VERTEX, vec![u64::from(vertex)]),
            }
        }
    }

    /// Writes the surprises of a line.
    pub(crate) fn put_surprises(out: &mut Vec<u8>, surprises: &[Surprise]) {
        push_varint(out, surprises.len() as u64);
        for surprise in surprises {
            let (kind, indices) = surprise.parts();
            push_varint(out, surprise.as_guessed);
            out.push(kind);
            for index in indices {
                push_varint(out, index);
            }
        }
    }

    impl SurpriseCoder {
        /// Writes the surprises of a line with these flags.
        pub(crate) fn write(&mut self, bits: &mut BitWriter, flags: u8, surprises: &[Surprise]) {
            self.code_count(bits, flags, surprises.len() as u64);
            for surprise in surprises {
                let (kind, indices) = surprise.parts();
                self.code_gap(bits, surprise.as_guessed);
                self.code_kind(bits, kind);
                for index in indices {
                    self.code_index(bits, index);
                }
            }
        }
    }
}
