//! Notes the way of the camera as keyframes of a flight.

use corniche_viewer::flight::{Flight, FlightError, Keyframe, Pose};

/// Keyframes of a moving camera lie so far apart.
const STEP_S: f64 = 0.1;

/// A recording under way. Times are seconds of one clock.
#[derive(Debug, Clone)]
pub(crate) struct Recorder {
    begun_s: f64,
    keyframes: Vec<Keyframe>,
    last: Keyframe,
}

impl Recorder {
    /// Begins.
    pub(crate) fn new(now_s: f64, pose: Pose) -> Self {
        let first = Keyframe { time_s: 0.0, pose };
        Self { begun_s: now_s, keyframes: vec![first], last: first }
    }

    /// How long it has been going on.
    pub(crate) fn duration_s(&self, now_s: f64) -> f64 {
        now_s - self.begun_s
    }

    /// The camera is here now. No frame in between means that it stood still.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
        let now = Keyframe { time_s: self.duration_s(now_s), pose };
        if pose != self.last.pose {
            // It stood where it was until this movement began, and then some frames went by.
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

    /// Ends; the flight begins at 0 s.
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

#[cfg(test)]
mod tests {
    use corniche_viewer::camera::Orientation;

    use super::*;

    fn at(x: f64) -> Pose {
        let orientation = Orientation { heading_deg: 10.0, pitch_deg: 20.0 };
        Pose { eye_m: [x, 2.0, 300.0], orientation }
    }

    fn x_at(flight: &Flight, time_s: f64) -> f64 {
        flight.at(time_s).eye_m[0]
    }

    #[test]
    fn the_flight_goes_where_the_camera_went() {
        let mut recorder = Recorder::new(50.0, at(0.0));
        for frame in 1..=200 {
            let time_s = f64::from(frame) / 60.0;
            recorder.note(50.0 + time_s, at(100.0 * time_s));
        }
        let flight = recorder.finish(50.0 + 200.0 / 60.0).unwrap();
        assert!((flight.duration_s() - 200.0 / 60.0).abs() < 1e-9);
        for time_s in [0.0, 0.33, 1.7, 3.3] {
            assert!((x_at(&flight, time_s) - 100.0 * time_s).abs() < 0.5, "{time_s} s");
        }
    }

    #[test]
    fn a_pause_without_frames_is_a_pause_of_the_flight() {
        let mut recorder = Recorder::new(0.0, at(0.0));
        recorder.note(0.5, at(10.0));
        // Nothing is drawn for nine seconds.
        recorder.note(9.5, at(20.0));
        recorder.note(9.6, at(30.0));
        let flight = recorder.finish(12.0).unwrap();
        assert!((x_at(&flight, 0.3) - 0.0).abs() < 1e-9, "it stood at first");
        assert!((x_at(&flight, 5.0) - 10.0).abs() < 1e-9);
        assert!((x_at(&flight, 9.3) - 10.0).abs() < 1e-9);
        assert!((x_at(&flight, 9.5) - 20.0).abs() < 1e-9);
        assert!((x_at(&flight, 11.0) - 30.0).abs() < 1e-9);
        assert!((flight.duration_s() - 12.0).abs() < 1e-9);
    }

    #[test]
    fn where_a_movement_ends_is_noted_however_short_it_was() {
        let mut recorder = Recorder::new(0.0, at(0.0));
        recorder.note(0.1, at(10.0));
        recorder.note(0.15, at(15.0));
        let flight = recorder.finish(2.0).unwrap();
        assert!((x_at(&flight, 1.0) - 15.0).abs() < 1e-9);
    }

    #[test]
    fn a_recording_of_no_time_is_no_flight() {
        assert!(Recorder::new(3.0, at(0.0)).finish(3.0).is_err());
    }
}
