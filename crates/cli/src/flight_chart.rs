//! Frame times along a flight, one curve a run: what Vaaraniemi, Treib & Westermann 2011 show in Figures 13 and 14.

use plotters::prelude::{
    BLACK, ChartBuilder, Circle, Color as _, IntoDrawingArea as _, LineSeries, RGBColor,
    SVGBackend, WHITE,
};

use crate::fly::Run;

/// The first seven are told apart also by those who see no red or green (Okabe & Ito 2008, *Color Universal Design*).
const COLOURS: [RGBColor; 9] = [
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

/// Milliseconds to draw each frame over the time in the flight, as SVG. The first frame of a run is left out: what is made
/// once is made there.
pub(crate) fn frame_times(runs: &[Run], adapter: &str) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (1000, 560)).into_drawing_area();
        area.fill(&WHITE)?;
        let points = |run: &Run| -> Vec<(f64, f64)> {
            run.frames.iter().skip(1).map(|frame| (frame.time_s, frame.draw_ms)).collect()
        };
        let all: Vec<(f64, f64)> = runs.iter().flat_map(points).collect();
        let begin_s = all.iter().map(|(time_s, _)| *time_s).fold(f64::INFINITY, f64::min);
        let end_s = all.iter().map(|(time_s, _)| *time_s).fold(f64::NEG_INFINITY, f64::max);
        let most_ms = all.iter().map(|(_, draw_ms)| *draw_ms).fold(0.0, f64::max);
        let times_s = if begin_s < end_s { begin_s..end_s } else { 0.0..1.0 };
        let mut chart = ChartBuilder::on(&area)
            .caption(format!("Time to draw a frame ({adapter})"), ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(60)
            .build_cartesian_2d(times_s, 0.0..most_ms.max(0.001) * 1.08)?;
        chart.configure_mesh().x_desc("time in the flight, s").y_desc("ms").draw()?;
        for (run, colour) in runs.iter().zip(COLOURS.iter().cycle()) {
            chart
                .draw_series(LineSeries::new(points(run), colour.stroke_width(2)))?
                .label(run.name())
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
        }
        chart
            .configure_series_labels()
            .background_style(WHITE.mix(0.9))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        area.present()?;
    }
    Ok(svg)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Lod, Roads};

    #[test]
    fn a_chart_without_frames_is_a_chart() {
        let runs = [Run { lod: Lod::Adaptive, roads: Roads::Geo, frames: Vec::new() }];
        let svg = frame_times(&runs, "an adapter").unwrap();
        assert!(svg.contains("<svg") && svg.contains("lod, roads geo") && !svg.contains("NaN"));
    }
}
