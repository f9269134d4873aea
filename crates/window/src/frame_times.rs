//! How long the last frames took.

use std::collections::VecDeque;

/// How many frames are remembered.
const REMEMBERED: usize = 240;

/// Times of the last frames that followed one another without a pause.
#[derive(Debug, Clone, Default)]
pub(crate) struct FrameTimes {
    ms: VecDeque<f64>,
}

impl FrameTimes {
    /// Adds the time of a frame.
    pub(crate) fn push(&mut self, ms: f64) {
        if self.ms.len() == REMEMBERED {
            self.ms.pop_front();
        }
        self.ms.push_back(ms);
    }

    /// The time of the last frame.
    pub(crate) fn last_ms(&self) -> Option<f64> {
        self.ms.back().copied()
    }

    /// The smallest time that this share (above 0) of the frames did not exceed; `None` without frames.
    pub(crate) fn quantile_ms(&self, share: f64) -> Option<f64> {
        let mut sorted: Vec<f64> = self.ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let rank = (share * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.saturating_sub(1)).copied()
    }

    /// All times, oldest first.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = f64> {
        self.ms.iter().copied()
    }
}

#[cfg(test)]
#[path = "frame_times_tests.rs"]
mod tests;
