//! The summary of a flight counts the right frames, and compares only comparable runs.

use corniche_viewer::{Detail, gpu::PassTimes};

use super::*;
use crate::fly::measured_run::tests::frame;

fn run(lod: Detail, roads: Roads, times_ms: [f64; 2]) -> MeasuredRun {
    let frames = [1000.0].into_iter().chain(times_ms).map(frame).collect();
    MeasuredRun { lod, roads, frames }
}

/// The summary with working metres equal to true metres.
fn to_text(runs: &[MeasuredRun]) -> String {
    super::to_text(runs, 1.0, Digits::Plain)
}

/// The cells of the line that begins with `name` in the table whose headings begin with `part`; if
/// a wide table is folded, those of all its parts.
fn cells<'a>(text: &'a str, part: &str, name: &str) -> Vec<&'a str> {
    let mut cells = Vec::new();
    let mut is_part = false;
    for line in text.lines() {
        let of_line = || line.split("  ").filter(|cell| !cell.is_empty()).map(str::trim);
        is_part = if line.is_empty() { false } else { is_part || line.starts_with(part) };
        if is_part && line.strip_prefix(name).is_some_and(|rest| rest.starts_with("  ")) {
            cells.extend(of_line().skip(1));
        }
    }
    assert!(!cells.is_empty(), "no {name:?} below {part:?} in {text}");
    cells
}

#[test]
fn losses_are_of_frame_rates_and_against_the_same_tiles_without_roads() {
    let mut runs = [
        run(Detail::Adaptive, Roads::None, [6.0, 8.0]),
        run(Detail::Adaptive, Roads::Geo, [8.0, 10.0]),
        run(Detail::Full, Roads::Geo, [100.0, 100.0]),
    ];
    // 6 of 8 ms are left, so a quarter of the frames is lost; then a fifth. In total, 14 of 18 ms
    // are left.
    let Loss { total, mean, most } = loss(&runs[1], &runs[0], |frame| Some(frame.draw_ms)).unwrap();
    assert!((mean - 0.225).abs() < 1e-12 && (most - 0.25).abs() < 1e-12);
    assert!((total - 4.0 / 18.0).abs() < 1e-12);
    // On the GPU 3.5 ms are left of 7, then of 3.5.
    runs[1].frames[1].passes = Some(PassTimes {
        terrain_ms: 1.0,
        roads_ms: 5.0,
        composite_ms: 1.0,
        ..PassTimes::default()
    });
    let text = to_text(&runs);
    let geo = cells(&text, "loss %", "lod, roads geo");
    assert_eq!(geo, ["22.2", "22.5", "25.0", "33.3", "25.0", "50.0", "26", "30"], "{text}");
    let losses = &text[text.find("loss %").unwrap()..];
    assert!(!losses.contains("roads none") && !losses.contains("full"), "{text}");
    assert!(losses.contains("35 and 40") && losses.contains("42 and 55"), "{text}");
}

#[test]
fn the_first_frame_counts_nowhere() {
    let text = to_text(&[run(Detail::Adaptive, Roads::Sv, [8.0, 10.0])]);
    let sv = cells(&text, "milliseconds", "lod, roads sv");
    assert_eq!(sv[..5], ["9.00", "8.00", "10.00", "10.00", "111.1"], "{text}");
    assert!(!text.contains("1000.00") && !text.contains("loss"), "{text}");
    assert_eq!(text.matches("without first frame").count(), 2, "{text}");
    // A single frame leaves nothing to count.
    let mut single = run(Detail::Adaptive, Roads::Sv, [8.0, 10.0]);
    single.frames.truncate(1);
    let text = to_text(&[single]);
    assert!(!text.contains("NaN") && text.contains('–'), "{text}");
}

#[test]
fn without_a_clock_on_the_card_there_are_no_times_of_it() {
    let mut runs = [
        run(Detail::Adaptive, Roads::None, [6.0, 8.0]),
        run(Detail::Adaptive, Roads::SvNoCaps, [8.0, 10.0]),
    ];
    runs[0].frames[2].passes = None;
    let text = to_text(&runs);
    let name = "lod, roads sv-no-caps";
    let losses = cells(&text, "loss %", name);
    assert_eq!(losses, ["22.2", "22.5", "25.0", "–", "–", "–", "35", "40"], "{text}");
    assert_eq!(cells(&text, "milliseconds", "lod, roads none")[5..], ["–"; 4], "{text}");
    assert_eq!(cells(&text, "milliseconds", name)[5..], ["3.50", "1.00", "2.00", "0.50"], "{text}");
}

#[test]
fn areas_have_a_column_where_there_are_some() {
    let mut runs = [run(Detail::Adaptive, Roads::Sv, [8.0, 10.0])];
    assert!(!to_text(&runs).contains("areas  "));
    for frame in &mut runs[0].frames {
        frame.passes = Some(PassTimes {
            terrain_ms: 1.0,
            areas_ms: 0.25,
            roads_ms: 2.0,
            decks_ms: 0.0,
            composite_ms: 0.5,
        });
    }
    let text = to_text(&runs);
    let found = cells(&text, "milliseconds", "lod, roads sv");
    assert_eq!(found[5..], ["3.75", "1.00", "0.25", "2.00", "0.50"], "{text}");
}

#[test]
fn percentiles_are_values_that_were_measured() {
    let values: Vec<f64> = (1..=20).rev().map(f64::from).collect();
    for (percent, expected) in [(0, 1.0), (5, 1.0), (50, 10.0), (95, 19.0), (96, 20.0), (100, 20.0)]
    {
        assert_eq!(percentile(&values, percent), Some(expected), "{percent}");
    }
    assert_eq!(percentile(&[], 50), None);
}

/// In a mean over frames, a few slow frames have the same weight as fast ones; in the total they do
/// not.
#[test]
fn a_dense_part_of_a_flight_shows_in_the_total() {
    let bare = run(Detail::Adaptive, Roads::None, [10.0, 10.0]);
    let dense = run(Detail::Adaptive, Roads::Sv, [10.0, 90.0]);
    let Loss { total, mean, most } = loss(&dense, &bare, |frame| Some(frame.draw_ms)).unwrap();
    assert!((total - 0.8).abs() < 1e-12, "{total}");
    assert!((mean - 4.0 / 9.0).abs() < 1e-12, "{mean}");
    assert!((most - 8.0 / 9.0).abs() < 1e-12, "{most}");
}

#[test]
fn what_caps_cost_is_a_share_of_the_roads_pass_of_the_same_tiles() {
    let mut runs = [
        run(Detail::Adaptive, Roads::Sv, [8.0, 8.0]),
        run(Detail::Adaptive, Roads::SvNoCaps, [8.0, 8.0]),
        run(Detail::Full, Roads::SvNoCaps, [8.0, 8.0]),
        run(Detail::Adaptive, Roads::Geo, [8.0, 8.0]),
    ];
    for (run, roads_ms) in runs.iter_mut().zip([8.0, 6.0, 1.0, 3.0]) {
        for frame in &mut run.frames {
            frame.passes = Some(PassTimes {
                terrain_ms: 1.0,
                roads_ms,
                composite_ms: 0.5,
                ..PassTimes::default()
            });
        }
    }
    let text = to_text(&runs);
    assert_eq!(cells(&text, "caps", "lod, roads sv"), ["8.00", "6.00", "25.0"], "{text}");
    let caps = &text[text.find("caps, roads pass").unwrap()..];
    assert!(!caps.contains("geo") && !caps.contains("no-caps"), "{text}");
    runs[1].frames[1].passes = None;
    let text = to_text(&runs);
    assert_eq!(cells(&text, "caps", "lod, roads sv"), ["8.00", "–", "–"], "{text}");
    // The same flight was not flown without roads.
    assert!(!to_text(&runs[..1]).contains("share of caps"));
}

#[test]
fn the_most_of_a_frame_stands_beside_the_average() {
    let mut runs = [run(Detail::Full, Roads::Sv, [8.0, 8.0])];
    for (frame, count) in runs[0].frames.iter_mut().zip([9000, 100, 300]) {
        (frame.triangles, frame.road_segments) = (count, 2 * count);
    }
    let text = to_text(&runs);
    let sv = cells(&text, "average", "full, roads sv");
    assert_eq!(sv[2..6], ["200", "300", "400", "600"], "{text}");
}

#[test]
fn the_speed_is_that_over_true_ground_and_of_the_whole_flight() {
    let mut runs = [run(Detail::Adaptive, Roads::Sv, [8.0, 8.0])];
    let eyes_m = [[0.0, 0.0, 0.0], [600.0, 800.0, 0.0], [600.0, 800.0, 1000.0]];
    for ((frame, eye_m), time_s) in runs[0].frames.iter_mut().zip(eyes_m).zip([1.0, 3.0, 6.0]) {
        (frame.pose.eye_m, frame.time_s) = (eye_m, time_s);
    }
    assert!(to_text(&runs).contains("average speed 400 m/s: 2.0 km in 5.0 s"));
    // In a projection that draws everything twice as large, a distance in plan is half as long.
    let scaled = super::to_text(&runs, 2.0, Digits::Plain);
    assert!(scaled.contains("average speed 300 m/s: 1.5 km in 5.0 s"), "{scaled}");
    // A flight without duration has no speed.
    for frame in &mut runs[0].frames {
        frame.time_s = 1.0;
    }
    assert!(!to_text(&runs).contains("speed"));
}
