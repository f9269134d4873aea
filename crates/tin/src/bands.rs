//! The order of insertion: by bands of errors, and within a band by place.

/// A node to insert: the farthest one of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Candidate {
    /// The square of nodes it lies in: those of one square are inserted together.
    pub(crate) place: u32,
    /// Index of the node, row by row.
    pub(crate) node: u32,
    /// Index of the face it was found in.
    pub(crate) face: u32,
    /// The face's apex when the candidate was made: if the face has another one now, the candidate is outdated.
    pub(crate) apex: u32,
    /// A corner of the face, to start from when the node is inserted.
    pub(crate) hint: u32,
}

/// Candidates by bands of errors.
///
/// ```text
///   error / tolerance    1   1.125   1.25 …   1.875   2   2.25   2.5  …   4   4.5  …
///   band                   0       1               7   8      9             16
/// ```
///
/// Within a band, candidates come in the order of their places and not of their errors. So one insertion follows another nearby, and
/// what it needs of mesh and heights is in the caches of the processor. This costs 0.6 to 2.1 % more triangles than the strict order.
pub(crate) struct Bands {
    max_error_m: f64,
    /// Candidates below the band at work, by band.
    waiting: Vec<Vec<Candidate>>,
    /// The band at work; before the first one, all candidates wait.
    current: usize,
}

/// A band's error has these bits of the mantissa in common, and its exponent.
const MANTISSA_BITS: u32 = 3;

impl Bands {
    pub(crate) fn new(max_error_m: f64) -> Self {
        Self { max_error_m, waiting: Vec::new(), current: usize::MAX }
    }

    /// Keeps a candidate for its band; gives it back if that is at work already, or was. `error_m` is above the tolerance.
    pub(crate) fn push(&mut self, error_m: f64, candidate: Candidate) -> Option<Candidate> {
        let ratio = ((error_m / self.max_error_m) as f32).max(1.0);
        let band = (ratio.to_bits() - 1.0_f32.to_bits()) as usize
            >> (f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS);
        if band >= self.current {
            return Some(candidate);
        }
        if self.waiting.len() <= band {
            self.waiting.resize_with(band + 1, Vec::new);
        }
        self.waiting[band].push(candidate);
        None
    }

    /// The candidates of the highest band that has a `fresh` one, in the order of their places; that band is at work from now on.
    pub(crate) fn next(&mut self, fresh: impl Fn(&Candidate) -> bool) -> Option<Vec<Candidate>> {
        loop {
            self.current = self.current.min(self.waiting.len()).checked_sub(1)?;
            let mut candidates = std::mem::take(&mut self.waiting[self.current]);
            candidates.retain(&fresh);
            if !candidates.is_empty() {
                candidates.sort_unstable();
                return Some(candidates);
            }
        }
    }
}

#[cfg(test)]
#[path = "bands_tests.rs"]
mod tests;
