//! The chart of a flight names its clock, fits its axes and is readable without colours.

use std::{fs, path::PathBuf};

use corniche_viewer::{Detail, gpu::PassTimes};

use super::*;
use crate::{
    args::{DETAILS, ROADS, Roads},
    chart::draw,
    fly::measured_run::tests::frame,
};

#[test]
fn a_chart_without_frames_is_a_chart() {
    let runs = [MeasuredRun { lod: Detail::Adaptive, roads: Roads::Geo, frames: Vec::new() }];
    let svg = flights(&runs, "an adapter").unwrap();
    assert!(svg.contains("<svg") && svg.contains("lod, roads geo") && !svg.contains("NaN"));
}

#[test]
fn a_chart_says_which_clock_its_times_are_of() {
    let run = |frames| [MeasuredRun { lod: Detail::Adaptive, roads: Roads::Geo, frames }];
    let mut timed = vec![frame(1.0), frame(3.0), frame(3.0)];
    let svg = flights(&run(timed.clone()), "an adapter").unwrap();
    assert!(svg.contains("clock"), "{svg}");
    // The first frame does not count, and neither does its clock.
    timed[0].passes = None;
    assert!(flights(&run(timed.clone()), "an adapter").unwrap().contains("clock"));
    timed[2].passes = None;
    assert!(!flights(&run(timed), "an adapter").unwrap().contains("clock"));
}

/// Each part has its own axis, which ends a little above the maximum.
#[test]
fn segments_and_tiles_stand_below_the_times_and_axes_fit() {
    let counts = [(2, 50_000), (12, 400), (31, 930)];
    let frames: Vec<FrameRecord> = (0..)
        .zip(counts)
        .map(|(number, (tiles_drawn, road_segments))| FrameRecord {
            time_s: f64::from(number),
            tiles_drawn,
            road_segments,
            ..frame(2.0)
        })
        .collect();
    let runs = [MeasuredRun { lod: Detail::Adaptive, roads: Roads::Geo, frames }];
    let svg = flights(&runs, "an adapter").unwrap();
    for caption in
        ["Time to draw a frame (an adapter)", "Road segments per frame", "Tiles per frame"]
    {
        assert_eq!(svg.matches(caption).count(), 1, "{caption}");
    }
    assert_eq!(svg.matches("lod, roads geo").count(), 1, "names stand once");
    // Without the first frame, which has 50 000 segments.
    assert_eq!(range_of(&runs, &|frame| frame.road_segments as f64), 0.0..930.0 * 1.05);
    let labels: Vec<&str> = svg.lines().map(str::trim).collect();
    assert!(labels.contains(&"900") && labels.contains(&"30"), "{svg}");
    assert!(!labels.contains(&"1000") && !labels.contains(&"900.0"), "{svg}");
    assert_eq!(range_of(&runs[..0], &|_| 7.0), 0.0..1.0);
}

/// The runs in a table that `fly` wrote.
fn runs_of(list: &str) -> Vec<MeasuredRun> {
    let mut lines = list.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut runs: Vec<MeasuredRun> = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let cell =
            |name: &str| cells[headings.iter().position(|heading| *heading == name).expect(name)];
        let number = |name: &str| cell(name).parse::<f64>().unwrap();
        let passes = PassTimes {
            terrain_ms: number("terrain_ms"),
            // The table of a package without areas and bridges, from a version without those
            // columns.
            areas_ms: 0.0,
            decks_ms: 0.0,
            roads_ms: number("roads_ms"),
            composite_ms: number("composite_ms"),
        };
        let record = FrameRecord {
            time_s: number("time_s"),
            tiles_drawn: number("tiles_drawn") as usize,
            road_segments: number("road_segments") as u64,
            draw_ms: number("draw_ms"),
            passes: Some(passes),
            ..frame(0.0)
        };
        let (_, _, lod) = DETAILS.into_iter().find(|(word, ..)| *word == cell("lod")).unwrap();
        let (_, _, roads) = ROADS.into_iter().find(|(word, ..)| *word == cell("roads")).unwrap();
        match runs.last_mut().filter(|run| (run.lod, run.roads) == (lod, roads)) {
            Some(run) => run.frames.push(record),
            None => runs.push(MeasuredRun { lod, roads, frames: vec![record] }),
        }
    }
    runs
}

/// The chart in the documentation is that of the table next to it, as `fly` draws it.
/// `CORNICHE_BLESS=1` draws it again.
#[test]
fn the_chart_in_the_docs_is_that_of_its_list() {
    let docs: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", "docs", "lab"].iter().collect();
    let list = fs::read_to_string(docs.join("flight-liechtenstein.csv")).unwrap();
    let runs = runs_of(&list);
    assert_eq!(runs.iter().map(|run| run.frames.len()).collect::<Vec<_>>(), [60; 5]);
    let drawn = flights(&runs, "llvmpipe (LLVM 15.0.6, 256 bits) (vulkan)").unwrap();
    let path = docs.join("flight-liechtenstein.svg");
    if std::env::var_os("CORNICHE_BLESS").is_some() {
        fs::write(&path, &drawn).unwrap();
    }
    let stored = fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == drawn, "the chart is not that of its list; draw it with CORNICHE_BLESS=1");
}

/// Runs can be distinguished without colours: their lines differ in dashes or in width.
#[test]
fn runs_differ_without_colours() {
    let look = |number: usize| {
        let curve = Curve {
            name: String::new(),
            color: RGBColor(0, 0, 0),
            points: vec![(0.0, 1.0), (1.0, 2.0)],
            marks: Marks::None(number),
        };
        let axis = |ticks| ChartAxis { description: "", range: 0.0..3.0, ticks };
        let axes = Axes {
            size_px: (400, 300),
            caption: String::new(),
            x: axis(Ticks::Round),
            y: axis(Ticks::Round),
        };
        draw(&axes, &[curve]).unwrap()
    };
    let looks: std::collections::BTreeSet<String> = (0..COLORS.len()).map(look).collect();
    assert_eq!(looks.len(), COLORS.len());
}
