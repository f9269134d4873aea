//! Recording and playing flights.

use corniche_live::{Recorder, controls::View};
use corniche_tileset::Manifest;
use corniche_viewer::{
    eye_height,
    flight::{Flight, FlightRecord, Pose, WorkingCrs},
};
use glam::DVec3;

/// The flight that is recorded, and the one that is played.
#[derive(Default)]
pub(crate) struct Flights {
    recorder: Option<Recorder>,
    playing: Option<(Flight, f64)>,
}

impl Flights {
    pub(crate) fn start_recording(&mut self, now_s: f64, pose: Pose) {
        self.recorder = Some(Recorder::new(now_s, pose));
    }

    /// Ends the recording; the flight as JSON, with the fields of its TOML.
    ///
    /// # Errors
    /// In words, when nothing was recorded.
    pub(crate) fn stop_recording(
        &mut self,
        now_s: f64,
        manifest: &Manifest,
    ) -> Result<String, String> {
        let recorder = self.recorder.take().ok_or("no flight is being recorded")?;
        let flight = recorder.finish(now_s).map_err(|error| error.to_string())?;
        serde_json::to_string(&flight.record(WorkingCrs::of(manifest)))
            .map_err(|error| error.to_string())
    }

    /// How long a flight has been recorded.
    pub(crate) fn recording_s(&self, now_s: f64) -> Option<f64> {
        self.recorder.as_ref().map(|recorder| recorder.duration_s(now_s))
    }

    /// The camera is here in this frame.
    pub(crate) fn note(&mut self, now_s: f64, pose: Pose) {
        if let Some(recorder) = &mut self.recorder {
            recorder.note(now_s, pose);
        }
    }

    /// Plays a flight from now on.
    ///
    /// # Errors
    /// In words, when the text is none for this package.
    pub(crate) fn play(
        &mut self,
        text: &str,
        now_s: f64,
        manifest: &Manifest,
    ) -> Result<(), String> {
        let record: FlightRecord = serde_json::from_slice(text.as_bytes())
            .map_err(|error| format!("this is no flight: {error}"))?;
        let flight = Flight::of_record(&record, WorkingCrs::of(manifest), &manifest.coordinates);
        self.playing = Some((flight.map_err(|error| error.to_string())?, now_s));
        Ok(())
    }

    pub(crate) fn stop_playing(&mut self) {
        self.playing = None;
    }

    pub(crate) fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Where the camera is in a flight that is played. After its last keyframe it ends.
    pub(crate) fn pose(&mut self, now_s: f64) -> Option<Pose> {
        let (flight, begun_s) = self.playing.as_ref()?;
        let [begin_s, end_s] = flight.span_s();
        let time_s = begin_s + (now_s - begun_s).max(0.0);
        let pose = flight.at(time_s);
        if time_s >= end_s {
            self.playing = None;
        }
        Some(pose)
    }
}

/// The view of a pose, over ground at this world height.
pub(crate) fn view_of_pose(pose: Pose, vertical_scale: f64, ground_m: f64) -> View {
    let [x, y, height_m] = pose.eye_m;
    let eye_in_world = DVec3::new(x, y, height_m * vertical_scale);
    let focus_m = eye_height::focus_m(eye_in_world.z - ground_m, pose.orientation.pitch_deg);
    View { eye_in_world, orientation: pose.orientation, focus_m, from_above: None }
}
