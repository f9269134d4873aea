//! The queue of candidates for the next vertex of a TIN, the greatest error first.

use std::collections::BinaryHeap;

/// The node of a face that lies farthest from it. Candidates compare by error, then by node (of equals the
/// first is the greater), then by face: insertion takes the same way on every run.
///
/// ```text
///   bits  127 … 96        95 … 64          63 … 32    31 … 0
///         error as f32    node, flipped    face       apex
/// ```
/// An error is not negative, and such floats order like their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Candidate(u128);

impl Candidate {
    pub(crate) fn new(error_m: f64, node: u32, face: u32, apex: u32) -> Self {
        let error = (error_m as f32).to_bits();
        Self(
            u128::from(error) << 96
                | u128::from(!node) << 64
                | u128::from(face) << 32
                | u128::from(apex),
        )
    }

    /// Index of the node, row by row.
    pub(crate) fn node(self) -> u32 {
        !((self.0 >> 64) as u32)
    }

    /// Index of the face it was found in.
    pub(crate) fn face(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The face's apex when the candidate was made: if the face has another one now, the candidate is outdated.
    pub(crate) fn apex(self) -> u32 {
        self.0 as u32
    }

    /// Exponent and upper bits of the mantissa: errors of one band differ by at most an eighth.
    fn band(self) -> usize {
        (self.0 >> (96 + 20)) as usize
    }
}

/// Candidates, the greatest first.
///
/// Most candidates are outdated before they are taken. So only the uppermost band of errors is a heap, and the bands
/// below are unsorted: when the next band is needed, the candidates that are still valid become the new heap. The
/// order is the same as with one heap for all candidates, but the heap is small enough for the caches of the
/// processor.
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

    /// Takes the greatest candidate that is `fresh`.
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
