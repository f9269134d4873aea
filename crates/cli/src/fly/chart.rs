//! The chart of a flight: frame times, road segments and tiles over time, with one curve per
//! run.

use std::ops::Range;

use corniche_viewer::{FrameRecord, gpu::PassTimes};
use plotters::prelude::RGBColor;

use super::measured_run::MeasuredRun;
use crate::chart::{Axes, ChartAxis, Curve, Marks, Ticks, draw_below_each_other, ends};

/// People with red-green colour blindness can distinguish the first seven (Okabe & Ito 2008, *Color
/// Universal Design*).
const COLORS: [RGBColor; 9] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(136, 34, 85),
    RGBColor(110, 110, 110),
];

/// Draws the milliseconds of each frame over the time in the flight, one curve per run, as in
/// Figures 13 and 14 of Vaaraniemi, Treib & Westermann 2011. The times are the GPU's if it has a
/// clock. Below, the road segments and the tiles of the same frames explain the times.
pub(crate) fn flights(runs: &[MeasuredRun], adapter: &str) -> anyhow::Result<String> {
    let times = |frame: &FrameRecord| frame.passes.as_ref().map(PassTimes::total_ms);
    let mut frames = runs.iter().flat_map(MeasuredRun::counted);
    let has_clock = frames.all(|frame| frame.passes.is_some());
    let frame_ms =
        |frame: &FrameRecord| times(frame).filter(|_| has_clock).unwrap_or(frame.draw_ms);
    let part = |height_px, caption: String, y, ticks, of: &dyn Fn(&FrameRecord) -> f64| {
        let y = ChartAxis { description: y, range: range_of(runs, of), ticks };
        (axes(runs, height_px, caption, y), curves(runs, of))
    };
    let parts = [
        part(
            460,
            format!("Time to draw a frame ({adapter})"),
            if has_clock { "ms by the GPU's clock" } else { "ms" },
            Ticks::Round,
            &frame_ms,
        ),
        part(280, "Road segments per frame".to_owned(), "segments", Ticks::Counts, &|frame| {
            frame.road_segments as f64
        }),
        part(280, "Tiles per frame".to_owned(), "tiles", Ticks::Counts, &|frame| {
            frame.tiles_drawn as f64
        }),
    ];
    let parts: Vec<(&Axes, &[Curve])> =
        parts.iter().map(|(axes, curves)| (axes, curves.as_slice())).collect();
    draw_below_each_other(&parts)
}

/// The range from 0 to a little more than the maximum of `of` over the counted frames.
fn range_of(runs: &[MeasuredRun], of: &dyn Fn(&FrameRecord) -> f64) -> Range<f64> {
    let most = runs.iter().flat_map(MeasuredRun::counted).map(of).fold(0.0, f64::max);
    // If all values are 0, the axis ends at 1.
    0.0..if most > 0.0 { most * 1.05 } else { 1.0 }
}

/// The axes from the first counted frame to the last.
fn axes(runs: &[MeasuredRun], height_px: u32, caption: String, y: ChartAxis) -> Axes {
    let counted = runs.iter().flat_map(MeasuredRun::counted);
    let [begin_s, end_s] = ends(counted.map(|frame| frame.time_s));
    Axes {
        size_px: (1000, height_px),
        caption,
        x: ChartAxis {
            description: "flight time, s",
            range: if begin_s < end_s { begin_s..end_s } else { 0.0..1.0 },
            ticks: Ticks::Round,
        },
        y,
    }
}

/// The values of `of` for the counted frames, one curve per run.
fn curves(runs: &[MeasuredRun], of: &dyn Fn(&FrameRecord) -> f64) -> Vec<Curve> {
    let curve = |(number, run): (usize, &MeasuredRun)| Curve {
        name: run.name(),
        color: COLORS[number % COLORS.len()],
        points: run.counted().iter().map(|frame| (frame.time_s, of(frame))).collect(),
        marks: Marks::None(number),
    };
    runs.iter().enumerate().map(curve).collect()
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
