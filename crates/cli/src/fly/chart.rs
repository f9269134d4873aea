use corniche_viewer::FrameRecord;
use plotters::prelude::RGBColor;

use super::measured_run::{MeasuredRun, gpu_ms};
use crate::chart::{Axes, Axis, Curve, Marks, Ticks, draw};

/// People with red-green colour blindness can distinguish the first seven (Okabe & Ito 2008, *Color Universal Design*).
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

/// Milliseconds to draw each frame over the time in the flight, one curve a run: what Vaaraniemi, Treib & Westermann 2011
/// show in Figures 13 and 14. By the graphics card's clock where there is one.
pub(crate) fn frame_times(runs: &[MeasuredRun], adapter: &str) -> anyhow::Result<String> {
    let times = |frame: &FrameRecord| frame.passes.as_ref().map(gpu_ms);
    let mut frames = runs.iter().flat_map(MeasuredRun::counted);
    let has_clock = frames.all(|frame| frame.passes.is_some());
    let point = |frame: &FrameRecord| {
        let frame_ms = times(frame).filter(|_| has_clock).unwrap_or(frame.draw_ms);
        (frame.time_s, frame_ms)
    };
    let points =
        |run: &MeasuredRun| -> Vec<(f64, f64)> { run.counted().iter().map(point).collect() };
    let all: Vec<(f64, f64)> = runs.iter().flat_map(points).collect();
    let begin_s = all.iter().map(|(time_s, _)| *time_s).fold(f64::INFINITY, f64::min);
    let end_s = all.iter().map(|(time_s, _)| *time_s).fold(f64::NEG_INFINITY, f64::max);
    let most_ms = all.iter().map(|(_, frame_ms)| *frame_ms).fold(0.0, f64::max);
    let axes = Axes {
        size_px: (1000, 560),
        caption: format!("Time to draw a frame ({adapter})"),
        x: Axis {
            description: "time in the flight, s",
            range: if begin_s < end_s { begin_s..end_s } else { 0.0..1.0 },
            ticks: Ticks::Round,
        },
        y: Axis {
            description: if has_clock { "ms by the graphics card's clock" } else { "ms" },
            range: 0.0..most_ms.max(0.001) * 1.1,
            ticks: Ticks::Round,
        },
    };
    let curve = |(number, run): (usize, &MeasuredRun)| Curve {
        name: run.name(),
        color: COLORS[number % COLORS.len()],
        points: points(run),
        marks: Marks::None(number),
    };
    let curves: Vec<Curve> = runs.iter().enumerate().map(curve).collect();
    draw(&axes, &curves)
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
