//! How long the last frames took.

use std::collections::VecDeque;

/// So many frames are remembered.
const REMEMBERED: usize = 240;

/// Times of the last frames that followed one another without a pause.
#[derive(Debug, Clone, Default)]
pub(crate) struct FrameTimes {
    ms: VecDeque<f64>,
}

impl FrameTimes {
    /// A frame took so long.
    pub(crate) fn push(&mut self, ms: f64) {
        if self.ms.len() == REMEMBERED {
            self.ms.pop_front();
        }
        self.ms.push_back(ms);
    }

    /// The last one.
    pub(crate) fn last_ms(&self) -> Option<f64> {
        self.ms.back().copied()
    }

    /// The least time that this share of the frames, above 0, did not exceed; `None` without frames.
    pub(crate) fn quantile_ms(&self, share: f64) -> Option<f64> {
        let mut sorted: Vec<f64> = self.ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let rank = (share * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.saturating_sub(1)).copied()
    }

    /// Oldest first.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = f64> {
        self.ms.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_frames_took_no_longer_than_the_median() {
        let mut times = FrameTimes::default();
        assert_eq!(times.quantile_ms(0.5), None);
        for ms in [5.0, 1.0, 4.0, 2.0, 3.0] {
            times.push(ms);
        }
        assert_eq!(times.quantile_ms(0.5), Some(3.0));
        assert_eq!(times.quantile_ms(0.95), Some(5.0));
        assert_eq!(times.quantile_ms(0.2), Some(1.0));
        assert_eq!(times.last_ms(), Some(3.0));
    }

    #[test]
    fn old_frames_are_forgotten() {
        let mut times = FrameTimes::default();
        for ms in 0..1000 {
            times.push(f64::from(ms));
        }
        assert_eq!(times.iter().len(), REMEMBERED);
        assert_eq!(times.quantile_ms(1e-9), Some(1000.0 - REMEMBERED as f64));
    }
}
