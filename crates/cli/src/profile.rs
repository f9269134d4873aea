//! `corniche profile`: height and grade along roads and other lines.

use std::{fmt::Write as _, path::Path};

use corniche_export::{Profile, ProfilePoint, profile, profile_of_lines};
use corniche_geom::LatticePoint;
use corniche_tileset::FilePackage;
use plotters::prelude::RGBColor;

use crate::{
    args::ProfileArgs,
    chart::{Axes, Axis, Curve, Marks, Ticks, draw_below_each_other},
    exit::ExitCode,
    failure::Failure,
    messages,
    output::existing_of,
    overlays, packages,
    progress::Progress,
    report_files::ReportFiles,
};

const HEIGHT: RGBColor = RGBColor(90, 60, 30);
const GRADE: RGBColor = RGBColor(200, 30, 40);

pub(crate) fn run(args: &ProfileArgs) -> Result<ExitCode, Failure> {
    let package = packages::open(&args.from.package)?;
    let list = ("--csv", args.csv.as_deref());
    let existing = existing_of(args.overwrite);
    // Both places are looked at before any work is done.
    let inputs: Vec<&Path> =
        [args.from.package.name()].into_iter().chain(args.line.as_deref()).collect();
    let files = ReportFiles::begin(args.svg.as_deref(), list, &inputs, existing)?;
    let placed = |path| placed_lines(path, args.allow_ballpark, &package);
    let lines = args.line.as_deref().map(placed).transpose()?;
    let progress = Progress::new();
    let found = match &lines {
        Some(lines) => profile_of_lines(&package, lines, args.at.level, &progress),
        None => profile(&package, &args.way, args.at.level, &progress),
    };
    progress.finish();
    let found = found?;
    if let Some(output) = files.list {
        output.write_whole(to_csv(&found).as_bytes())?;
    }
    if let Some(output) = files.svg {
        let credits = package.manifest().attribution.join(", ");
        let name = if let Some(path) = &args.line {
            path.file_name().unwrap_or_default().to_string_lossy().into_owned()
        } else {
            let ways: Vec<String> = args.way.iter().map(i64::to_string).collect();
            format!("Way {}", ways.join(", "))
        };
        let svg = to_svg(&found, &name, &credits);
        let svg = svg.map_err(|error| Failure::new(ExitCode::Failed, error))?;
        output.write_whole(svg.as_bytes())?;
    }
    messages::answer(&to_text(&found))?;
    Ok(ExitCode::Done)
}

/// The lines of a file on the package's lattice.
fn placed_lines(
    path: &Path,
    allow_ballpark: bool,
    package: &FilePackage,
) -> Result<Vec<Vec<LatticePoint>>, Failure> {
    let found = corniche_overlay::read(path, allow_ballpark)?;
    overlays::tell(path, &found);
    let placed = corniche_overlay::place(&found.lines, package.manifest())?;
    Ok(placed.into_iter().map(|line| line.points).collect())
}

fn points(found: &Profile) -> impl Iterator<Item = &ProfilePoint> {
    found.parts.iter().flat_map(|part| &part.points)
}

fn to_text(found: &Profile) -> String {
    let heights = || points(found).map(|point| point.height_m);
    let [lowest, highest] =
        [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    let steepest = found.steepest.map_or_else(
        || "no part is 20 m long".to_owned(),
        |grade| format!("{:.1} % over 20 m", 100.0 * grade),
    );
    let gaps = match found.parts.len() {
        0 | 1 => String::new(),
        parts => format!(", in {parts} parts with gaps between them"),
    };
    format!(
        "Length   {:.1} m in plan, {:.1} m on the ground{gaps}\n\
         Heights  {lowest:.1} to {highest:.1} m ({})\n\
         Up       {:.1} m\n\
         Down     {:.1} m\n\
         Steepest {steepest}\n\
         Level    {}, {} vertices\n",
        found.length_2d_m,
        found.length_3d_m,
        found.heights,
        found.ascent_m,
        found.descent_m,
        found.level,
        points(found).count(),
    )
}

/// A line for each vertex; parts are numbered from 0.
fn to_csv(found: &Profile) -> String {
    let mut text = "part,way_id,distance_m,height_m,grade_pct,lon,lat\n".to_owned();
    for (part, points) in found.parts.iter().enumerate() {
        for point in &points.points {
            let [lon, lat] = point.position_deg;
            // Writing to a String cannot fail.
            let _ = writeln!(
                text,
                "{part},{},{:.3},{:.3},{:.2},{lon:.8},{lat:.8}",
                point.way_id,
                point.distance_m,
                point.height_m,
                100.0 * point.grade
            );
        }
    }
    text
}

fn to_svg(found: &Profile, name: &str, credits: &str) -> anyhow::Result<String> {
    let kilometres = |point: &ProfilePoint| point.distance_m / 1e3;
    let curves = |value: fn(&ProfilePoint) -> f64, color: RGBColor, name: &str| -> Vec<Curve> {
        let curve = |(number, part): (usize, &corniche_export::ProfilePart)| Curve {
            // One name in the list.
            name: if number == 0 { name.to_owned() } else { String::new() },
            color,
            points: part.points.iter().map(|point| (kilometres(point), value(point))).collect(),
            marks: Marks::None(0),
        };
        found.parts.iter().enumerate().map(curve).collect()
    };
    let heights = curves(|point| point.height_m, HEIGHT, "height");
    let grades = curves(|point| 100.0 * point.grade, GRADE, "grade");
    let range = |curves: &[Curve], least: f64| {
        let values = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.1);
        let (low, high) =
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let margin = ((high - low) * 0.08).max(least);
        low - margin..high + margin
    };
    let end = points(found).last().map_or(1.0, kilometres).max(1e-3);
    let axes = |caption: String, description, y, height_px| Axes {
        size_px: (1000, height_px),
        caption,
        x: Axis { description: "distance, km", range: 0.0..end, ticks: Ticks::Round },
        y: Axis { description, range: y, ticks: Ticks::Round },
    };
    let caption = format!("{name} on level {}", found.level);
    let above = axes(caption, "height, m", range(&heights, 1.0), 380);
    let below = axes(format!("Grade over 20 m. {credits}"), "grade, %", range(&grades, 1.0), 260);
    draw_below_each_other(&[(&above, &heights), (&below, &grades)])
}
