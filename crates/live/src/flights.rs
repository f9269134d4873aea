//! The flight that a person records, as keyframes of the camera's path, and the one that is played.

use corniche_viewer::{
    eye_height,
    flight::{Flight, FlightError, Keyframe, Pose},
};
use glam::DVec3;

use crate::controls::{KnownGround, View};

/// Time between two keyframes of a moving camera.
const STEP_S: f64 = 0.1;

/// A recording under way. Times are seconds of one clock.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    begun_s: f64,
    keyframes: Vec<Keyframe>,
    last: Keyframe,
}

impl Recorder {
    /// Begins a recording.
    pub(crate) fn new(now_s: f64, pose: Pose) -> Self {
        let first = Keyframe { time_s: 0.0, pose };
        Self { begun_s: now_s, keyframes: vec![first], last: first }
    }

    /// How long the recording has been going on.
    pub(crate) fn duration_s(&self, now_s: f64) -> f64 {
        now_s - self.begun_s
    }

    /// The camera is here now. If there was no frame for some time, it stood still meanwhile.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
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
    pub(crate) fn finish(mut self, now_s: f64) -> Result<Flight, FlightError> {
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

/// The flight that is recorded, and the one that is played. Times are seconds of one clock.
#[derive(Default)]
pub struct Flights {
    recorder: Option<Recorder>,
    /// The flight, and when it began.
    playing: Option<(Flight, f64)>,
}

impl Flights {
    pub(crate) fn start_recording(&mut self, now_s: f64, pose: Pose) {
        self.recorder = Some(Recorder::new(now_s, pose));
    }

    /// Ends the recording; `None` where there was none.
    pub fn stop_recording(&mut self, now_s: f64) -> Option<Result<Flight, FlightError>> {
        self.recorder.take().map(|recorder| recorder.finish(now_s))
    }

    /// How long a flight has been recorded; `None` while none is.
    #[must_use]
    pub fn recording_s(&self, now_s: f64) -> Option<f64> {
        self.recorder.as_ref().map(|recorder| recorder.duration_s(now_s))
    }

    /// The camera is here in this frame.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
        if let Some(recorder) = &mut self.recorder {
            recorder.note(now_s, pose);
        }
    }

    /// Plays a flight from now on.
    pub(crate) fn play(&mut self, flight: Flight, now_s: f64) {
        self.playing = Some((flight, now_s));
    }

    pub(crate) fn stop_playing(&mut self) {
        self.playing = None;
    }

    /// Whether a flight is played.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// What is seen in a flight that is played. After its last keyframe it ends.
    pub(crate) fn view(
        &mut self,
        now_s: f64,
        vertical_scale: f64,
        ground: &dyn KnownGround,
    ) -> Option<View> {
        let (flight, begun_s) = self.playing.as_ref()?;
        let [begin_s, end_s] = flight.span_s();
        let time_s = begin_s + (now_s - begun_s).max(0.0);
        let Pose { eye_m: [x, y, height_m], orientation } = flight.at(time_s);
        if time_s >= end_s {
            self.playing = None;
        }
        let ground_m = ground.height([x, y]).unwrap_or_else(|| ground.base_height());
        let eye_in_world = DVec3::new(x, y, height_m * vertical_scale);
        let focus_m = eye_height::focus_m(eye_in_world.z - ground_m, orientation.pitch_deg);
        Some(View { eye_in_world, orientation, focus_m, from_above: None })
    }
}

#[cfg(test)]
#[path = "flights_tests.rs"]
mod tests;
