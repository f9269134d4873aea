//! The time of the next frame, and the durations of frames.

use std::collections::VecDeque;

/// After a pause longer than this, the time between two frames is not the duration of a frame.
const PAUSE_S: f64 = 0.5;

/// The number of frames whose times are kept.
const REMEMBERED: usize = 240;

/// The durations of the last consecutive frames.
#[derive(Debug, Clone, Default)]
pub struct FrameTimes {
    ms: VecDeque<f64>,
}

impl FrameTimes {
    /// Adds the duration of a frame.
    pub fn push(&mut self, ms: f64) {
        if self.ms.len() == REMEMBERED {
            self.ms.pop_front();
        }
        self.ms.push_back(ms);
    }

    /// The duration of the last frame.
    #[must_use]
    pub fn last_ms(&self) -> Option<f64> {
        self.ms.back().copied()
    }

    /// The smallest duration that this share (above 0) of the frames did not exceed; `None` without
    /// frames.
    #[must_use]
    pub fn quantile_ms(&self, share: f64) -> Option<f64> {
        let mut sorted: Vec<f64> = self.ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let rank = (share * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.saturating_sub(1)).copied()
    }

    /// All durations, oldest first.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = f64> {
        self.ms.iter().copied()
    }
}

/// When the next frame is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Redraw {
    /// The next frame is due as soon as possible.
    Now,
    /// The next frame is due at this time, unless something happens before.
    At(f64),
    /// The next frame is due when something happens.
    Asked,
}

impl Redraw {
    /// The next frame is due after the shortest of these times; without any, when something
    /// happens.
    #[must_use]
    pub fn after<const N: usize>(now_s: f64, rests_s: [Option<f64>; N]) -> Self {
        let soonest_s = rests_s.into_iter().flatten().reduce(f64::min);
        soonest_s.map_or(Self::Asked, |rest_s| Self::At(now_s + rest_s))
    }
}

/// Measures how long frames take.
#[derive(Default)]
pub struct FramePace {
    /// The durations of the last frames.
    pub times: FrameTimes,
    /// The time at which the last frame began, if it drew the map and another frame was to follow;
    /// and how much later that next frame may begin.
    drawing_since_s: Option<(f64, f64)>,
}

impl FramePace {
    /// Notes a frame that began at `now_s`. `is_one_of_many` means that it drew the map and that
    /// another frame is to follow, `is_busy` that the next frame is requested at once.
    ///
    /// Only consecutive frames show how long a frame takes.
    pub fn note(&mut self, now_s: f64, is_one_of_many: bool, is_busy: bool) {
        if let Some((since_s, most_s)) = self.drawing_since_s
            && now_s - since_s <= most_s
        {
            self.times.push((now_s - since_s) * 1e3);
        }
        // A frame that is requested at once begins as soon as the last one is shown, however long
        // that takes.
        let most_s = if is_busy { f64::INFINITY } else { PAUSE_S };
        self.drawing_since_s = is_one_of_many.then_some((now_s, most_s));
    }
}

#[cfg(test)]
#[path = "frame_pace_tests.rs"]
mod tests;
