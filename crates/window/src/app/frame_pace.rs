//! When the next frame is due, and how long frames take.

use crate::frame_times::FrameTimes;

/// After a pause longer than this between two frames, the second does not tell how long a frame takes.
const PAUSE_S: f64 = 0.5;

/// When the next frame is due.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Redraw {
    /// The next frame is due as soon as possible.
    Now,
    /// The next frame is due at a time, unless something happens before.
    At(f64),
    /// The next frame is due when something happens.
    Asked,
}

impl Redraw {
    /// The next frame is due after the shortest of these times; without any, when something happens.
    pub(crate) fn after<const N: usize>(now_s: f64, rests_s: [Option<f64>; N]) -> Self {
        let soonest_s = rests_s.into_iter().flatten().reduce(f64::min);
        soonest_s.map_or(Self::Asked, |rest_s| Self::At(now_s + rest_s))
    }
}

/// Measures how long frames take.
#[derive(Default)]
pub(crate) struct FramePace {
    times: FrameTimes,
    /// When the last frame began, if it drew the map and another frame was to follow; and how much later that may begin.
    drawing_since_s: Option<(f64, f64)>,
}

impl FramePace {
    /// A frame began at `now_s`. `is_one_of_many` says that it drew the map and that another one is to follow, `is_busy`
    /// that the next one is asked for at once.
    ///
    /// Only frames that follow one another without a pause tell how long a frame takes.
    pub(crate) fn note(&mut self, now_s: f64, is_one_of_many: bool, is_busy: bool) {
        if let Some((since_s, most_s)) = self.drawing_since_s
            && now_s - since_s <= most_s
        {
            self.times.push((now_s - since_s) * 1e3);
        }
        // A frame that is asked for at once begins as soon as the last one is shown, however long that takes.
        let most_s = if is_busy { f64::INFINITY } else { PAUSE_S };
        self.drawing_since_s = is_one_of_many.then_some((now_s, most_s));
    }

    /// How long the last frames took.
    pub(crate) fn times(&self) -> &FrameTimes {
        &self.times
    }
}

#[cfg(test)]
#[path = "frame_pace_tests.rs"]
mod tests;
