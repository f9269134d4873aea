//! A recorded flight follows the camera, including its pauses.

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
    let mut recorder = FlightRecorder::new(50.0, at(0.0));
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
    let mut recorder = FlightRecorder::new(0.0, at(0.0));
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
    let mut recorder = FlightRecorder::new(0.0, at(0.0));
    recorder.note(0.1, at(10.0));
    recorder.note(0.15, at(15.0));
    let flight = recorder.finish(2.0).unwrap();
    assert!((x_at(&flight, 1.0) - 15.0).abs() < 1e-9);
}

#[test]
fn a_recording_of_no_time_is_no_flight() {
    assert!(FlightRecorder::new(3.0, at(0.0)).finish(3.0).is_err());
}
