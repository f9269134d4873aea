//! The flight that is being recorded, as keyframes of the camera's path, and the flight that is
//! being played.

use corniche_viewer::{
    eye_height,
    flight::{Flight, FlightError, Keyframe, Pose},
};
use glam::DVec3;

use crate::controls::{CameraView, KnownGround};

/// The time between two keyframes of a moving camera.
const STEP_S: f64 = 0.1;

/// A recording under way. Times are seconds of one clock.
#[derive(Debug, Clone)]
pub(crate) struct FlightRecorder {
    begun_s: f64,
    keyframes: Vec<Keyframe>,
    last: Keyframe,
}

impl FlightRecorder {
    /// Begins a recording.
    pub(crate) fn new(now_s: f64, pose: Pose) -> Self {
        let first = Keyframe { time_s: 0.0, pose };
        Self { begun_s: now_s, keyframes: vec![first], last: first }
    }

    /// The duration of the recording so far.
    pub(crate) fn duration_s(&self, now_s: f64) -> f64 {
        now_s - self.begun_s
    }

    /// Notes the position of the camera. If there was no frame for some time, the camera stood
    /// still meanwhile.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
        let now = Keyframe { time_s: self.duration_s(now_s), pose };
        if pose != self.last.pose {
            // The camera stood still until this movement began, one step before now.
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

/// The flight that is being recorded, and the one that is being played. Times are seconds of one
/// clock.
#[derive(Default)]
pub struct Flights {
    recorder: Option<FlightRecorder>,
    /// The flight, and the time at which it began.
    pub(crate) playing: Option<(Flight, f64)>,
}

impl Flights {
    pub(crate) fn start_recording(&mut self, now_s: f64, pose: Pose) {
        self.recorder = Some(FlightRecorder::new(now_s, pose));
    }

    /// Ends the recording; `None` if there was none.
    pub fn stop_recording(&mut self, now_s: f64) -> Option<Result<Flight, FlightError>> {
        self.recorder.take().map(|recorder| recorder.finish(now_s))
    }

    /// The duration of the recording so far; `None` if there is none.
    #[must_use]
    pub fn recording_s(&self, now_s: f64) -> Option<f64> {
        self.recorder.as_ref().map(|recorder| recorder.duration_s(now_s))
    }

    /// Notes the position of the camera in this frame.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
        if let Some(recorder) = &mut self.recorder {
            recorder.note(now_s, pose);
        }
    }

    /// Whether a flight is being played.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// The view of the flight that is being played. The flight ends after its last keyframe.
    pub(crate) fn view(
        &mut self,
        now_s: f64,
        vertical_scale: f64,
        ground: &dyn KnownGround,
    ) -> Option<CameraView> {
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
        Some(CameraView { eye_in_world, orientation, focus_m, from_above: None })
    }
}

#[cfg(test)]
#[path = "flights_tests.rs"]
mod tests;
