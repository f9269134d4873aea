use corniche_viewer::gpu::PassTimes;

use super::*;
use crate::{args::Lod, fly::measured_run::tests::frame};

fn run(lod: Lod, roads: Roads, times_ms: [f64; 2]) -> MeasuredRun {
    let frames = [1000.0].into_iter().chain(times_ms).map(frame).collect();
    MeasuredRun { lod, roads, frames }
}

/// The cells of the line that begins with `name` in the part of the text that begins with `part`.
fn cells<'a>(text: &'a str, part: &str, name: &str) -> Vec<&'a str> {
    let from = text.find(part).unwrap_or_else(|| panic!("no {part:?} in {text}"));
    let line = text[from..].lines().find(|line| line.starts_with(name));
    let line = line.unwrap_or_else(|| panic!("no {name:?} in {text}"));
    line.split("  ").filter(|cell| !cell.is_empty()).map(str::trim).collect()
}

#[test]
fn losses_are_of_frame_rates_and_against_the_same_tiles_without_roads() {
    let mut runs = [
        run(Lod::Adaptive, Roads::None, [6.0, 8.0]),
        run(Lod::Adaptive, Roads::Geo, [8.0, 10.0]),
        run(Lod::Full, Roads::Geo, [100.0, 100.0]),
    ];
    // 6 of 8 ms are left, so a quarter of the frames is lost; then a fifth.
    let [average, most] = loss(&runs[1], &runs[0], |frame| Some(frame.draw_ms)).unwrap();
    assert!((average - 0.225).abs() < 1e-12 && (most - 0.25).abs() < 1e-12);
    // On the card 3.5 ms are left of 7, then of 3.5.
    runs[1].frames[1].passes =
        Some(PassTimes { terrain_ms: 1.0, roads_ms: 5.0, composite_ms: 1.0 });
    let text = to_text(&runs, Digits::Plain);
    let geo = cells(&text, "loss %", "lod, roads geo");
    assert_eq!(geo[1..], ["22.5", "25.0", "25.0", "50.0", "26", "30"], "{text}");
    let losses = &text[text.find("loss %").unwrap()..];
    assert!(!losses.contains("roads none") && !losses.contains("full"), "{text}");
    assert!(losses.contains("35 and 40") && losses.contains("42 and 55"), "{text}");
}

#[test]
fn the_first_frame_counts_nowhere() {
    let text = to_text(&[run(Lod::Adaptive, Roads::Sv, [8.0, 10.0])], Digits::Plain);
    let sv = cells(&text, "milliseconds", "lod, roads sv");
    assert_eq!(sv[1..6], ["9.00", "8.00", "10.00", "10.00", "111.1"], "{text}");
    assert!(!text.contains("1000.00") && !text.contains("loss"), "{text}");
    assert_eq!(text.matches("first frame left out").count(), 2, "{text}");
    // Nothing is left of a single frame.
    let mut single = run(Lod::Adaptive, Roads::Sv, [8.0, 10.0]);
    single.frames.truncate(1);
    let text = to_text(&[single], Digits::Plain);
    assert!(!text.contains("NaN") && text.contains('–'), "{text}");
}

#[test]
fn without_a_clock_on_the_card_there_are_no_times_of_it() {
    let mut runs = [
        run(Lod::Adaptive, Roads::None, [6.0, 8.0]),
        run(Lod::Adaptive, Roads::SvNoCaps, [8.0, 10.0]),
    ];
    runs[0].frames[2].passes = None;
    let text = to_text(&runs, Digits::Plain);
    let name = "lod, roads sv-no-caps";
    assert_eq!(cells(&text, "loss %", name)[1..], ["22.5", "25.0", "–", "–", "35", "40"], "{text}");
    assert_eq!(cells(&text, "milliseconds", "lod, roads none")[6..], ["–"; 4], "{text}");
    assert_eq!(cells(&text, "milliseconds", name)[6..], ["3.50", "1.00", "2.00", "0.50"], "{text}");
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
