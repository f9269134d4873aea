//! Charts for reports, as SVG: curves over a common axis, with a legend next to them.

use std::ops::Range;

use anyhow::Result;
use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        BLACK, ChartBuilder, Color as _, DrawingArea, EmptyElement, IntoDrawingArea as _,
        PathElement, Polygon, RGBColor, SVGBackend, ShapeStyle, Text, TextStyle, WHITE,
    },
};

use crate::info::rounded;

/// The caption and the axes of a chart.
pub(crate) struct Axes {
    pub size_px: (u32, u32),
    pub caption: String,
    pub x: ChartAxis,
    /// The vertical axis, with ticks at round numbers or counts.
    pub y: ChartAxis,
}

/// One of the two axes.
pub(crate) struct ChartAxis {
    /// The quantity, with its unit.
    pub description: &'static str,
    pub range: Range<f64>,
    pub ticks: Ticks,
}

/// The positions of an axis's numbers and lines.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Ticks {
    /// At round numbers, with finer lines between them.
    Round,
    /// At round numbers of a count: only whole numbers are labelled.
    Counts,
    /// At this number of whole numbers, with nothing between them.
    Whole(usize),
    /// At whole numbers at which the quantity doubles with each step; at 0 it is `unit`. The labels
    /// are the quantities.
    Doubled { count: usize, unit: f64 },
}

/// A line from point to point. Its dashes and marks distinguish it from the other curves without
/// colours.
pub(crate) struct Curve {
    pub name: String,
    pub color: RGBColor,
    pub points: Vec<(f64, f64)>,
    pub marks: Marks,
}

/// Whether the points of a curve have marks.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marks {
    /// No marks; the line has the dashes and the width with this index.
    None(usize),
    /// Marks of the shape with this index, and a line with its dashes.
    Shape(usize),
}

/// Outlines of marks, in pixels around the point, and whether they are filled: neighbours in the
/// list differ most.
const SHAPES: [(&[(i32, i32)], bool); 9] = [
    (&ROUND, true),
    (&SQUARE, false),
    (&UP, true),
    (&DIAMOND, false),
    (&SQUARE, true),
    (&ROUND, false),
    (&DIAMOND, true),
    (&UP, false),
    (&DOWN, true),
];
const ROUND: [(i32, i32); 8] =
    [(4, 2), (2, 4), (-2, 4), (-4, 2), (-4, -2), (-2, -4), (2, -4), (4, -2)];
const SQUARE: [(i32, i32); 4] = [(-4, -4), (4, -4), (4, 4), (-4, 4)];
const UP: [(i32, i32); 3] = [(0, -5), (5, 4), (-5, 4)];
const DOWN: [(i32, i32); 3] = [(0, 5), (5, -4), (-5, -4)];
const DIAMOND: [(i32, i32); 4] = [(0, -6), (6, 0), (0, 6), (-6, 0)];
/// Lengths of dashes and of the gaps between them, pixels; 0: a solid line.
const DASHES: [(i32, i32); 3] = [(0, 0), (9, 4), (3, 3)];

/// The number of curves with marks that can be distinguished without colours: after all shapes, the
/// same shapes follow with other dashes.
pub(crate) const MOST_SHAPES: usize = SHAPES.len() * DASHES.len();

/// Width of a line, pixels.
const LINE_PX: u32 = 2;
/// Height of a row in the legend, and the width of a character, pixels.
const ROW_PX: i32 = 24;
const CHARACTER_PX: i32 = 8;
/// Length of the line before a name, pixels.
const SAMPLE_PX: i32 = 34;
const MARGIN_PX: i32 = 16;

/// The minimum and the maximum of some values; infinite, with the maximum below the minimum, for no
/// values.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(nothing, |[least, most], value| [least.min(value), most.max(value)])
}

/// Draws the curves as SVG, with a legend on the right. Curves without points are in the legend as
/// well.
pub(crate) fn draw(axes: &Axes, curves: &[Curve]) -> Result<String> {
    draw_below_each_other(&[(axes, curves)])
}

/// Draws several charts of one width, the first on top. All show the same curves; the legend is
/// next to the first.
pub(crate) fn draw_below_each_other(drawings: &[(&Axes, &[Curve])]) -> Result<String> {
    let width = drawings.iter().map(|(axes, _)| axes.size_px.0).max().unwrap_or(0);
    let height = drawings.iter().map(|(axes, _)| axes.size_px.1).sum();
    let names = drawings.iter().flat_map(|(_, curves)| *curves).map(|curve| &curve.name);
    let longest = names.map(|name| name.chars().count()).max().unwrap_or(0);
    let names_px = SAMPLE_PX + CHARACTER_PX * longest as i32 + 2 * MARGIN_PX;
    let mut svg = String::new();
    {
        let whole = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        whole.fill(&WHITE)?;
        let mut rest = whole.clone();
        for (number, (axes, curves)) in drawings.iter().enumerate() {
            let (area, below) = rest.split_vertically(axes.size_px.1);
            let (plot, names) = area.split_horizontally(width as i32 - names_px);
            draw_curves(&plot, axes, curves)?;
            if number == 0 {
                draw_names(&names, curves)?;
            }
            rest = below;
        }
        whole.present()?;
    }
    Ok(in_xml(&svg))
}

/// The text without the characters that XML 1.0 (section 2.2) does not allow, even escaped.
pub(crate) fn in_xml(text: &str) -> String {
    let has_place = |character: &char| match character {
        '\t' | '\n' | '\r' => true,
        '\u{fffe}' | '\u{ffff}' => false,
        other => *other >= ' ',
    };
    text.chars().filter(has_place).collect()
}

/// Draws the curves between their axes.
fn draw_curves(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    axes: &Axes,
    curves: &[Curve],
) -> Result<()> {
    let mut chart = ChartBuilder::on(area)
        .caption(&axes.caption, ("sans-serif", 20))
        .margin(MARGIN_PX)
        .x_label_area_size(44)
        .y_label_area_size(80)
        .build_cartesian_2d(axes.x.range.clone(), axes.y.range.clone())?;
    let tick = |ticks: Ticks| {
        move |number: &f64| match ticks {
            Ticks::Doubled { unit, .. } => rounded(unit * number.exp2()),
            Ticks::Counts if number.fract() != 0.0 => String::new(),
            Ticks::Round | Ticks::Counts | Ticks::Whole(_) => format!("{number:.0}"),
        }
    };
    let (tick_x, tick_y) = (tick(axes.x.ticks), tick(axes.y.ticks));
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(axes.x.description)
        .y_desc(axes.y.description)
        .axis_desc_style(("sans-serif", 16))
        .label_style(("sans-serif", 14))
        .max_light_lines(2);
    match axes.x.ticks {
        Ticks::Round => {}
        Ticks::Counts => {
            mesh.x_label_formatter(&tick_x);
        }
        Ticks::Whole(count) | Ticks::Doubled { count, .. } => {
            mesh.x_labels(count).x_label_formatter(&tick_x).x_max_light_lines(0);
        }
    }
    if axes.y.ticks == Ticks::Counts {
        mesh.y_label_formatter(&tick_y);
    }
    mesh.draw()?;
    // Wide lines are drawn below narrow ones, which they would hide.
    let mut by_width: Vec<&Curve> = curves.iter().collect();
    by_width.sort_by_key(|curve| std::cmp::Reverse(curve.line().2.stroke_width));
    for curve in by_width {
        let (dash, gap, style) = curve.line();
        let points = curve.points.iter().copied();
        if dash == 0 {
            chart.draw_series([PathElement::new(points.collect::<Vec<_>>(), style)])?;
        } else {
            chart.draw_series([DashedPathElement::new(points, dash, gap, style)])?;
        }
    }
    // Marks are drawn above all lines.
    for curve in curves {
        let Some((outline, fill)) = curve.mark() else { continue };
        let closed: Vec<(i32, i32)> = outline.iter().chain(outline.first()).copied().collect();
        chart.draw_series(curve.points.iter().map(|&point| {
            EmptyElement::at(point)
                + Polygon::new(outline.to_vec(), fill)
                + PathElement::new(closed.clone(), curve.color.stroke_width(2))
        }))?;
    }
    Ok(())
}

/// Draws the legend: names after a piece of each line and its mark.
fn draw_names(area: &DrawingArea<SVGBackend<'_>, Shift>, curves: &[Curve]) -> Result<()> {
    let font = TextStyle::from(("sans-serif", 15)).color(&BLACK);
    // Parts of a curve after the first have no name.
    for (row, curve) in (0..).zip(curves.iter().filter(|curve| !curve.name.is_empty())) {
        let y = 3 * MARGIN_PX + ROW_PX * row;
        let (dash, gap, style) = curve.line();
        let ends = [(0, y), (SAMPLE_PX, y)];
        if dash == 0 {
            area.draw(&PathElement::new(ends, style))?;
        } else {
            area.draw(&DashedPathElement::new(ends, dash, gap, style))?;
        }
        if let Some((outline, fill)) = curve.mark() {
            let at = |&(dx, dy): &(i32, i32)| (SAMPLE_PX / 2 + dx, y + dy);
            let outline: Vec<(i32, i32)> = outline.iter().map(at).collect();
            area.draw(&Polygon::new(outline.clone(), fill))?;
            let closed: Vec<(i32, i32)> = outline.iter().chain(outline.first()).copied().collect();
            area.draw(&PathElement::new(closed, curve.color.stroke_width(2)))?;
        }
        area.draw(&Text::new(curve.name.clone(), (SAMPLE_PX + 8, y - 7), font.clone()))?;
    }
    Ok(())
}

impl Curve {
    /// Dash, gap and style of the line.
    fn line(&self) -> (i32, i32, ShapeStyle) {
        let (number, width_px) = match self.marks {
            Marks::None(number) => (number, LINE_PX * (1 + number / DASHES.len()) as u32),
            Marks::Shape(number) => (number + number / SHAPES.len(), LINE_PX),
        };
        let (dash, gap) = DASHES[number % DASHES.len()];
        (dash, gap, self.color.stroke_width(width_px))
    }

    /// Outline and filling of the marks.
    fn mark(&self) -> Option<(&'static [(i32, i32)], ShapeStyle)> {
        let Marks::Shape(number) = self.marks else { return None };
        let (outline, is_filled) = SHAPES[number % SHAPES.len()];
        Some((outline, if is_filled { self.color.filled() } else { WHITE.filled() }))
    }
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
