//! Drawings for reports, as SVG: curves over a common axis, with their names beside them.

use std::ops::Range;

use plotters::prelude::{
    BLACK, ChartBuilder, Circle, Color as _, IntoDrawingArea as _, LineSeries, PathElement,
    RGBColor, SVGBackend, SeriesLabelPosition, WHITE,
};

/// Caption, axes and legend around the curves.
pub(crate) struct Axes {
    pub(crate) size_px: (u32, u32),
    pub(crate) caption: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) names: SeriesLabelPosition,
}

/// One of the two directions.
pub(crate) struct Axis {
    /// What is counted, with its unit.
    pub(crate) description: &'static str,
    pub(crate) range: Range<f64>,
    pub(crate) ticks: Ticks,
}

/// Where an axis has numbers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ticks {
    /// At round places.
    Round,
    /// At so many whole numbers.
    Whole(usize),
}

/// A line from point to point.
pub(crate) struct Curve {
    pub(crate) name: String,
    pub(crate) color: RGBColor,
    pub(crate) points: Vec<(f64, f64)>,
    pub(crate) marks: Marks,
}

/// Whether the points of a curve show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marks {
    None,
    Dots,
}

/// The curves as SVG. A curve without points is in the legend as well.
pub(crate) fn draw(axes: &Axes, curves: &[Curve]) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, axes.size_px).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(&axes.caption, ("sans-serif", 20))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(80)
            .build_cartesian_2d(axes.x.range.clone(), axes.y.range.clone())?;
        let whole = |number: &f64| format!("{number:.0}");
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(axes.x.description)
            .y_desc(axes.y.description)
            .axis_desc_style(("sans-serif", 16))
            .label_style(("sans-serif", 14))
            .max_light_lines(2);
        if let Ticks::Whole(count) = axes.x.ticks {
            mesh.x_labels(count).x_label_formatter(&whole);
        }
        if let Ticks::Whole(count) = axes.y.ticks {
            mesh.y_labels(count).y_label_formatter(&whole);
        }
        mesh.draw()?;
        for Curve { name, color, points, marks } in curves {
            let color = *color;
            chart
                .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 18, y)], color.stroke_width(3))
                });
            if *marks == Marks::Dots {
                let dots = points.iter().map(|&point| Circle::new(point, 3, color.filled()));
                chart.draw_series(dots)?;
            }
        }
        chart
            .configure_series_labels()
            .position(axes.names.clone())
            .label_font(("sans-serif", 15))
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        area.present()?;
    }
    Ok(svg)
}
