//! The times of the frames of a flight.

use crate::flight::Flight;

/// The times of the frames of a flight.
#[derive(Clone, Copy)]
pub(crate) struct Timetable<'a> {
    pub(crate) flight: &'a Flight,
    pub(crate) frames: u32,
}

impl Timetable<'_> {
    /// Seconds between two frames.
    pub(crate) fn step_s(&self) -> f64 {
        self.flight.duration_s() / f64::from(self.frames.saturating_sub(1).max(1))
    }

    /// Time of a frame in the flight.
    pub(crate) fn time_s(&self, frame: u32) -> f64 {
        self.flight.span_s()[0] + f64::from(frame) * self.step_s()
    }

    /// The frame nearest to a time.
    pub(crate) fn frame_at(&self, time_s: f64) -> u32 {
        let steps = (time_s - self.flight.span_s()[0]) / self.step_s();
        (steps.round() as u32).min(self.frames - 1)
    }
}
