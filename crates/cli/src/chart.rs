//! Drawings for reports.

use corniche_tileset::Manifest;
use plotters::prelude::{
    BLACK, ChartBuilder, Circle, Color as _, IntoDrawingArea as _, LineSeries, RGBColor,
    SVGBackend, WHITE,
};

/// One colour a class, as on a road atlas: red for motorways down to grey for tracks.
const CLASS_COLOURS: [RGBColor; 9] = [
    RGBColor(200, 30, 40),
    RGBColor(230, 100, 30),
    RGBColor(235, 160, 30),
    RGBColor(190, 170, 20),
    RGBColor(110, 150, 50),
    RGBColor(40, 140, 140),
    RGBColor(50, 90, 170),
    RGBColor(110, 110, 120),
    RGBColor(160, 120, 160),
];

/// Growth of clipped vertices over the level's own simplified line, one curve a class over the levels, as SVG.
pub(crate) fn growth(manifest: &Manifest) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (900, 520)).into_drawing_area();
        area.fill(&WHITE)?;
        let factor = |geo: u64, simplified: u64| geo as f64 / simplified as f64;
        let rows: Vec<_> =
            manifest.growth.iter().filter(|row| row.simplified_vertices > 0).collect();
        let highest = rows
            .iter()
            .map(|row| factor(row.geo_vertices, row.simplified_vertices))
            .fold(1.0_f64, f64::max);
        let last = manifest.levels.last().map_or(0, |level| level.level);
        let mut chart = ChartBuilder::on(&area)
            .caption(
                "Vertices of clipped roads over the level's simplified lines",
                ("sans-serif", 20),
            )
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(56)
            .build_cartesian_2d(-0.3..f64::from(last) + 1.4, 0.0..highest * 1.08)?;
        chart
            .configure_mesh()
            .x_desc("level (0 = root)")
            .y_desc("times the vertices")
            .x_labels(usize::from(last) + 1)
            .x_label_formatter(&|level| format!("{level:.0}"))
            .draw()?;
        for (class, colour) in (0_u8..).zip(CLASS_COLOURS) {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .filter(|row| row.class == class)
                .map(|row| {
                    (f64::from(row.level), factor(row.geo_vertices, row.simplified_vertices))
                })
                .collect();
            if points.is_empty() {
                continue;
            }
            chart
                .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?
                .label(format!("FRC {class}"))
                .legend(move |(x, y)| Circle::new((x + 8, y), 4, colour.filled()));
            chart
                .draw_series(points.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
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
