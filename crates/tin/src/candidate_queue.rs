//! The queue of candidates for the next vertex of a TIN, the largest error first.

use std::collections::BinaryHeap;

/// A face with a node too far from it. Candidates are compared by this distance, then by face
/// (among equal distances the first face is the greater one), so that insertion has the same order
/// in every run.
///
/// ```text
///   bits  63 … 32            31 … 0
///         distance as f32    face, flipped
/// ```
/// A distance is never negative, and non-negative floats have the same order as their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Candidate(u64);

impl Candidate {
    pub(crate) fn new(far_m: f32, face: u32) -> Self {
        Self(u64::from(far_m.to_bits()) << 32 | u64::from(!face))
    }

    pub(crate) fn face(self) -> u32 {
        !(self.0 as u32)
    }

    /// The distance at the time when the candidate was created: if the face has another distance
    /// now, the candidate is outdated.
    pub(crate) fn far_m(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    /// The exponent and the upper bits of the mantissa: errors in one band differ by at most an
    /// eighth.
    fn band(self) -> usize {
        (self.0 >> (32 + 20)) as usize
    }
}

/// Candidates, the greatest first.
///
/// Most candidates are outdated before they are taken. So only the uppermost band of errors is a
/// heap, and the bands below are unsorted: when the next band is needed, its candidates that are
/// still valid become the new heap. The order is the same as with one heap for all candidates, but
/// the heap is small enough for the processor's caches.
pub(crate) struct CandidateQueue {
    heap: BinaryHeap<Candidate>,
    /// Candidates below the heap's band, by band.
    waiting: Vec<Vec<Candidate>>,
    /// The lowest band in the heap.
    band: usize,
}

impl CandidateQueue {
    pub(crate) fn new() -> Self {
        Self { heap: BinaryHeap::new(), waiting: Vec::new(), band: usize::MAX }
    }

    pub(crate) fn push(&mut self, candidate: Candidate) {
        let band = candidate.band();
        if band >= self.band {
            self.heap.push(candidate);
            return;
        }
        if self.waiting.len() <= band {
            self.waiting.resize_with(band + 1, Vec::new);
        }
        self.waiting[band].push(candidate);
    }

    /// Takes the greatest candidate for which `fresh` returns true.
    pub(crate) fn pop(&mut self, fresh: impl Fn(Candidate) -> bool) -> Option<Candidate> {
        loop {
            while let Some(candidate) = self.heap.pop() {
                if fresh(candidate) {
                    return Some(candidate);
                }
            }
            self.band = self.band.min(self.waiting.len()).checked_sub(1)?;
            let mut next = std::mem::take(&mut self.waiting[self.band]);
            next.retain(|&candidate| fresh(candidate));
            self.heap = BinaryHeap::from(next);
        }
    }
}

#[cfg(test)]
#[path = "candidate_queue_tests.rs"]
mod tests;
