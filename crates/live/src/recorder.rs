//! Records the path of the camera as keyframes of a flight.

use corniche_viewer::flight::{Flight, FlightError, Keyframe, Pose};

/// Time between two keyframes of a moving camera.
const STEP_S: f64 = 0.1;

/// A recording under way. Times are seconds of one clock.
#[derive(Debug, Clone)]
pub struct Recorder {
    begun_s: f64,
    keyframes: Vec<Keyframe>,
    last: Keyframe,
}

impl Recorder {
    /// Begins a recording.
    #[must_use]
    pub fn new(now_s: f64, pose: Pose) -> Self {
        let first = Keyframe { time_s: 0.0, pose };
        Self { begun_s: now_s, keyframes: vec![first], last: first }
    }

    /// How long the recording has been going on.
    #[must_use]
    pub fn duration_s(&self, now_s: f64) -> f64 {
        now_s - self.begun_s
    }

    /// The camera is here now. If there was no frame for some time, it stood still meanwhile.
    pub fn note(&mut self, now_s: f64, pose: Pose) {
        let now = Keyframe { time_s: self.duration_s(now_s), pose };
        if pose != self.last.pose {
            // It stood still until this movement began, one step before now.
            let moved_s = now.time_s - STEP_S;
            if moved_s > self.last.time_s {
                self.push(self.last);
                self.push(Keyframe { time_s: moved_s, pose: self.last.pose });
            }
            if now.time_s - self.noted_s() >= STEP_S {
                self.push(now);
            }
        }
        self.last = now;
    }

    /// Ends the recording. The flight begins at 0 s.
    ///
    /// # Errors
    /// When no time has passed.
    pub fn finish(mut self, now_s: f64) -> Result<Flight, FlightError> {
        let end = Keyframe { time_s: self.duration_s(now_s), pose: self.last.pose };
        self.push(self.last);
        self.push(end);
        Flight::new(&self.keyframes)
    }

    fn noted_s(&self) -> f64 {
        self.keyframes.last().map_or(0.0, |keyframe| keyframe.time_s)
    }

    fn push(&mut self, keyframe: Keyframe) {
        if keyframe.time_s > self.noted_s() {
            self.keyframes.push(keyframe);
        }
    }
}

#[cfg(test)]
#[path = "recorder_tests.rs"]
mod tests;
