//! The drawing of a profile: height and grade over distance, with bridges, tunnels and names.
//!
//! ```text
//!   title, main figures, and legend
//!   ├ height ── the smoothed line, the ground thin behind it ┤      bridges and tunnels are bands behind both
//!   ├ names of roads, as far as they fit ────────────────────┤
//!   ├ grade ─────────────────────────────────────────────────┤
//!   attribution
//! ```

use std::ops::Range;

use anyhow::Result;
use corniche_export::{ProfileLeg, ProfilePoint, RoadProfile};
use corniche_roads::Structure;
use plotters::{
    coord::Shift,
    prelude::{
        BLACK, ChartBuilder, Color as _, DrawingArea, IntoDrawingArea as _, PathElement, RGBColor,
        Rectangle, SVGBackend, Text, TextStyle, WHITE,
    },
    style::text_anchor::{HPos, Pos, VPos},
};

use crate::chart::{ends, in_xml};

const HEIGHT: RGBColor = RGBColor(90, 60, 30);
const GRADE: RGBColor = RGBColor(200, 30, 40);
const GROUND: RGBColor = RGBColor(140, 140, 130);
const BRIDGE: RGBColor = RGBColor(196, 220, 244);
const TUNNEL: RGBColor = RGBColor(216, 216, 216);
const EDGE: RGBColor = RGBColor(120, 120, 120);

const WIDTH_PX: u32 = 1000;
const HEAD_PX: u32 = 84;
const HEIGHTS_PX: u32 = 340;
const NAMES_PX: u32 = 30;
const GRADES_PX: u32 = 230;
const FOOT_PX: u32 = 30;
const MARGIN_PX: i32 = 16;
/// Width of the numbers at an axis.
const LABELS_PX: u32 = 76;
const LEFT_PX: i32 = MARGIN_PX + LABELS_PX as i32;

/// Font sizes by use, pixels.
const TITLE_FONT: i32 = 20;
const FONT: i32 = 14;
const SMALL_FONT: i32 = 12;

/// Average width of a letter, relative to the height of its font.
const LETTER: f64 = 0.55;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws a profile as SVG. `facts` are its main figures in short; `credits` must be displayed.
pub(crate) fn to_svg(
    found: &RoadProfile,
    title: &str,
    facts: &str,
    credits: &str,
) -> Result<String> {
    let height = HEAD_PX + HEIGHTS_PX + NAMES_PX + GRADES_PX + FOOT_PX;
    let mut svg = String::new();
    {
        let whole = SVGBackend::with_string(&mut svg, (WIDTH_PX, height)).into_drawing_area();
        whole.fill(&WHITE)?;
        let (head, rest) = whole.split_vertically(HEAD_PX);
        let (heights, rest) = rest.split_vertically(HEIGHTS_PX);
        let (names, rest) = rest.split_vertically(NAMES_PX);
        let (grades, foot) = rest.split_vertically(GRADES_PX);
        let panels = panels(found);
        draw_head(&head, found, (title, facts), &panels)?;
        let [above, below] = &panels;
        draw_panel(&heights, found, above)?;
        draw_names(&names, found)?;
        draw_panel(&grades, found, below)?;
        let font = centered(SMALL_FONT, HPos::Left);
        let letters = fitting(WIDTH_PX as i32 - LEFT_PX - MARGIN_PX, SMALL_FONT);
        foot.draw(&Text::new(shortened(credits, letters), (LEFT_PX, FOOT_PX as i32 / 2), font))?;
        whole.present()?;
    }
    Ok(in_xml(&svg))
}

/// A panel of curves over distance.
struct Panel {
    description: &'static str,
    range: Range<f64>,
    has_distances: bool,
    curves: Vec<Curve>,
}

struct Curve {
    name: &'static str,
    color: RGBColor,
    width_px: u32,
    /// Lines without gaps: kilometres, and the value.
    lines: Vec<Vec<(f64, f64)>>,
}

fn panels(found: &RoadProfile) -> [Panel; 2] {
    let ground = curve_lines(found, |point| Some(point.height_m));
    let has_structures = found.legs.iter().any(|leg| leg.structure != Structure::Ground);
    let curve = |name, color, width_px, lines| Curve { name, color, width_px, lines };
    let grades = |lines: &[Vec<(f64, f64)>], over_km: f64| -> Vec<Vec<(f64, f64)>> {
        lines.iter().map(|line| grade_line(line, over_km, end_km(found))).collect()
    };
    let (heights, grades) = if found.smooth.is_some() {
        let smooth = curve_lines(found, |point| point.smooth.map(|[height_m, _]| height_m));
        let of_ground = if has_structures { "DEM, bridges and tunnels" } else { "DEM" };
        let grades = grades(&smooth, 0.05);
        (
            vec![curve(of_ground, GROUND, 1, ground), curve("smoothed line", HEIGHT, 2, smooth)],
            curve("grade over 50 m", GRADE, 2, grades),
        )
    } else {
        let grades = grades(&ground, 0.02);
        (
            vec![curve("ground of the package", HEIGHT, 2, ground)],
            curve("grade over 20 m", GRADE, 2, grades),
        )
    };
    let grades = vec![grades];
    [
        Panel {
            description: "height, m",
            range: range(&heights, None),
            has_distances: false,
            curves: heights,
        },
        Panel {
            description: "grade, %",
            range: range(&grades, Some(0.0)),
            has_distances: true,
            curves: grades,
        },
    ]
}

/// The grade along a line of kilometres and metres, percent over a length, pixel by pixel, because
/// a deck has few vertices.
fn grade_line(line: &[(f64, f64)], over_km: f64, all_km: f64) -> Vec<(f64, f64)> {
    let (Some(&(begin_km, _)), Some(&(end_km, _))) = (line.first(), line.last()) else {
        return Vec::new();
    };
    let height_m = |at_km: f64| {
        let after = line.partition_point(|(own_km, _)| *own_km < at_km).clamp(1, line.len() - 1);
        let ((from_km, from_m), (to_km, to_m)) = (line[after - 1], line[after]);
        let share = if to_km > from_km { (at_km - from_km) / (to_km - from_km) } else { 1.0 };
        from_m + share.clamp(0.0, 1.0) * (to_m - from_m)
    };
    let half_km = (over_km / 2.0).min((end_km - begin_km) / 2.0);
    let step_km = all_km / f64::from(WIDTH_PX);
    let steps = ((end_km - begin_km) / step_km).ceil().max(1.0);
    let grade = |k: u32| {
        let at_km = begin_km + (end_km - begin_km) * f64::from(k) / steps;
        let middle_km = at_km.min(end_km - half_km).max(begin_km + half_km);
        let rise_m = height_m(middle_km + half_km) - height_m(middle_km - half_km);
        (at_km, if half_km > 0.0 { rise_m / (20.0 * half_km) } else { 0.0 })
    };
    (0..=steps as u32).map(grade).collect()
}

/// The range from the minimum to the maximum, with a margin; `with` is always included.
fn range(curves: &[Curve], with: Option<f64>) -> Range<f64> {
    let values = curves.iter().flat_map(|curve| curve.lines.iter().flatten());
    let [low, high] = ends(values.map(|(_, value)| *value).chain(with));
    if low > high {
        return 0.0..1.0;
    }
    let margin = ((high - low) * 0.08).max(1.0);
    low - margin..high + margin
}

/// The lines of a value: they end at gaps, and where the value is missing.
fn curve_lines(
    found: &RoadProfile,
    value: impl Fn(&ProfilePoint) -> Option<f64>,
) -> Vec<Vec<(f64, f64)>> {
    let mut lines: Vec<Vec<(f64, f64)>> = Vec::new();
    for part in &found.parts {
        let mut line = Vec::new();
        for point in &part.points {
            match value(point) {
                Some(value) => line.push((point.distance_m / 1e3, value)),
                None => lines.push(std::mem::take(&mut line)),
            }
        }
        lines.push(line);
    }
    lines.retain(|line| line.len() >= 2);
    lines
}

fn end_km(found: &RoadProfile) -> f64 {
    let last = found.parts.last().and_then(|part| part.points.last());
    last.map_or(1.0, |point| point.distance_m / 1e3).max(1e-3)
}

fn style(size: i32) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size)).color(&BLACK)
}

/// The style of a text that is centred on the height of its position.
fn centered(size: i32, at: HPos) -> TextStyle<'static> {
    style(size).pos(Pos::new(at, VPos::Center))
}

/// The number of letters that fit.
fn fitting(width_px: i32, font: i32) -> usize {
    (f64::from(width_px) / (LETTER * f64::from(font))).max(0.0) as usize
}

/// The beginning of a text, with an ellipsis if it has more letters than `letters`.
fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let kept: String = text.chars().take(letters.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end_matches([' ', ',', '·']))
}

fn draw_head(
    area: &Area<'_>,
    found: &RoadProfile,
    (title, facts): (&str, &str),
    panels: &[Panel; 2],
) -> Result<()> {
    let room = WIDTH_PX as i32 - LEFT_PX - MARGIN_PX;
    let lines = [(title, TITLE_FONT, 10), (facts, FONT, 36)];
    for (text, font, y) in lines {
        let text = shortened(text, fitting(room, font));
        area.draw(&Text::new(text, (LEFT_PX, y), style(font)))?;
    }
    // The legend of lines and bands.
    let (mut x, y) = (LEFT_PX, 68);
    let write = |x: i32, text: &str| -> Result<i32> {
        let font = centered(FONT, HPos::Left);
        area.draw(&Text::new(text.to_owned(), (x, y), font))?;
        Ok(x + (text.chars().count() as f64 * LETTER * f64::from(FONT)) as i32 + 2 * MARGIN_PX)
    };
    for curve in panels.iter().flat_map(|panel| &panel.curves) {
        let sample = curve.color.stroke_width(curve.width_px);
        area.draw(&PathElement::new([(x, y), (x + 26, y)], sample))?;
        x = write(x + 32, curve.name)?;
    }
    for (structure, text, color) in
        [(Structure::Bridge, "bridge", BRIDGE), (Structure::Tunnel, "tunnel", TUNNEL)]
    {
        if found.legs.iter().any(|leg| leg.structure == structure) {
            area.draw(&Rectangle::new([(x, y - 7), (x + 26, y + 7)], color.filled()))?;
            area.draw(&Rectangle::new([(x, y - 7), (x + 26, y + 7)], EDGE.stroke_width(1)))?;
            x = write(x + 32, text)?;
        }
    }
    Ok(())
}

fn draw_panel(area: &Area<'_>, found: &RoadProfile, panel: &Panel) -> Result<()> {
    let foot_px = if panel.has_distances { 44 } else { 4 };
    let mut chart = ChartBuilder::on(area)
        .margin_left(MARGIN_PX)
        .margin_right(MARGIN_PX)
        .margin_top(4)
        .x_label_area_size(foot_px)
        .y_label_area_size(LABELS_PX)
        .build_cartesian_2d(0.0..end_km(found), panel.range.clone())?;
    let km_px = f64::from(WIDTH_PX as i32 - LEFT_PX - MARGIN_PX) / end_km(found);
    for leg in &found.legs {
        let color = match leg.structure {
            Structure::Ground => continue,
            Structure::Bridge => BRIDGE,
            Structure::Tunnel => TUNNEL,
        };
        // A short stretch is visible, too.
        let [from, to] = leg.range_m.map(|at_m| at_m / 1e3);
        let least = 2.0 / km_px;
        let (from, to) = if to - from < least {
            (f64::midpoint(from, to) - least / 2.0, f64::midpoint(from, to) + least / 2.0)
        } else {
            (from, to)
        };
        let corners = [(from, panel.range.start), (to, panel.range.end)];
        chart.draw_series([Rectangle::new(corners, color.filled())])?;
    }
    let label = |number: &f64| tick(*number);
    let mut mesh = chart.configure_mesh();
    mesh.y_desc(panel.description)
        .axis_desc_style(("sans-serif", 16))
        .label_style(("sans-serif", FONT))
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .max_light_lines(1);
    if panel.has_distances {
        mesh.x_desc("distance, km");
    } else {
        mesh.x_labels(0);
    }
    mesh.draw()?;
    if panel.range.contains(&0.0) && panel.has_distances {
        let level = [(0.0, 0.0), (end_km(found), 0.0)];
        chart.draw_series([PathElement::new(level, EDGE.stroke_width(1))])?;
    }
    for curve in &panel.curves {
        let stroke = curve.color.stroke_width(curve.width_px);
        chart.draw_series(curve.lines.iter().map(|line| PathElement::new(line.clone(), stroke)))?;
    }
    Ok(())
}

/// A number at an axis: with as few decimals as possible, at most three.
fn tick(number: f64) -> String {
    let text = format!("{number:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// Draws the names of roads below the panels.
fn draw_names(area: &Area<'_>, found: &RoadProfile) -> Result<()> {
    let room_px = f64::from(WIDTH_PX as i32 - LEFT_PX - MARGIN_PX);
    let x = |at_m: f64| LEFT_PX + (room_px * at_m / 1e3 / end_km(found)).round() as i32;
    let middle = NAMES_PX as i32 / 2;
    for (name, [from_m, to_m]) in named_stretches(&found.legs) {
        let [from, to] = [x(from_m), x(to_m)];
        for end in [from, to] {
            area.draw(&PathElement::new(
                [(end, 4), (end, NAMES_PX as i32 - 4)],
                EDGE.stroke_width(1),
            ))?;
        }
        let letters = fitting(to - from - 8, SMALL_FONT);
        if letters >= 4 {
            let font = centered(SMALL_FONT, HPos::Center);
            let text = shortened(&name, letters);
            area.draw(&Text::new(text, (i32::midpoint(from, to), middle), font))?;
        }
    }
    Ok(())
}

/// The names along a profile; neighbouring legs with the same name are one stretch.
fn named_stretches(legs: &[ProfileLeg]) -> Vec<(String, [f64; 2])> {
    let mut stretches: Vec<(String, [f64; 2])> = Vec::new();
    for leg in legs {
        // The number of a road changes less often than its name, and needs space.
        let name = if leg.name.is_empty() { name_of(leg) } else { leg.name.clone() };
        match stretches.last_mut() {
            Some((before, range_m)) if *before == name => range_m[1] = leg.range_m[1],
            _ => stretches.push((name, leg.range_m)),
        }
    }
    stretches.retain(|(name, _)| !name.is_empty());
    stretches
}

/// The label of a leg: its number and its name; empty if it has neither.
pub(crate) fn name_of(leg: &ProfileLeg) -> String {
    let reference = leg.reference.replace(';', ", ");
    match (reference.is_empty(), leg.name.is_empty()) {
        (false, false) => format!("{reference} · {}", leg.name),
        (false, true) => reference,
        (true, _) => leg.name.clone(),
    }
}

#[cfg(test)]
#[path = "drawing_tests.rs"]
mod tests;
