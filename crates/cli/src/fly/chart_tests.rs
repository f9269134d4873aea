use super::*;
use crate::{
    args::{Lod, Roads},
    fly::measured_run::tests::frame,
};

#[test]
fn a_chart_without_frames_is_a_chart() {
    let runs = [MeasuredRun { lod: Lod::Adaptive, roads: Roads::Geo, frames: Vec::new() }];
    let svg = frame_times(&runs, "an adapter").unwrap();
    assert!(svg.contains("<svg") && svg.contains("lod, roads geo") && !svg.contains("NaN"));
}

#[test]
fn a_chart_says_which_clock_its_times_are_of() {
    let run = |frames| [MeasuredRun { lod: Lod::Adaptive, roads: Roads::Geo, frames }];
    let mut timed = vec![frame(1.0), frame(3.0), frame(3.0)];
    let svg = frame_times(&run(timed.clone()), "an adapter").unwrap();
    assert!(svg.contains("clock"), "{svg}");
    // The first frame does not count, so neither does its clock.
    timed[0].passes = None;
    assert!(frame_times(&run(timed.clone()), "an adapter").unwrap().contains("clock"));
    timed[2].passes = None;
    assert!(!frame_times(&run(timed), "an adapter").unwrap().contains("clock"));
}
