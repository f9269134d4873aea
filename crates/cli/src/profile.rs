//! `corniche profile`: height and grade along roads and other lines.

use std::{fmt::Write as _, path::Path};

use corniche_export::{
    Profile, ProfileGrades, ProfilePoint, RoadHeights, profile, profile_of_lines,
};
use corniche_geom::LatticePoint;
use corniche_pipeline::RecordedElevation;
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
    recorded,
    report_files::ReportFiles,
};

const HEIGHT: RGBColor = RGBColor(90, 60, 30);
const GRADE: RGBColor = RGBColor(200, 30, 40);

pub(crate) fn run(args: &ProfileArgs) -> Result<ExitCode, Failure> {
    let usage = "corniche profile PACKAGE --way ID --dem FILE...";
    let (place, [dem, osm]) = args.from.files(&args.extract.osm, usage)?;
    let package = packages::open(&place)?;
    let list = ("--csv", args.csv.as_deref());
    let existing = existing_of(args.overwrite);
    // Both places are looked at before any work is done.
    let inputs: Vec<&Path> = [place.name()]
        .into_iter()
        .chain(args.line.as_deref())
        .chain(dem.iter().chain(&osm).map(AsRef::as_ref))
        .collect();
    let files = ReportFiles::begin(args.svg.as_deref(), list, &inputs, existing)?;
    let placed = |path| placed_lines(path, args.allow_ballpark, &package);
    let lines = args.line.as_deref().map(placed).transpose()?;
    let recorded = recorded::elevation(&args.from, &dem, &package)?;
    let elevation = recorded.as_ref().map(recorded::for_export);
    let network = recorded::network(&args.extract, &osm, (&args.cpu, &package))?;
    let progress = Progress::new();
    let found = if let Some(lines) = &lines {
        profile_of_lines(&package, lines, args.at.level, elevation, &progress)
    } else {
        let heights = RoadHeights { elevation, network: network.as_ref() };
        profile(&package, &args.way, args.at.level, heights, &progress)
    };
    progress.finish();
    // A file that changed may be the cause of any other error.
    recorded.as_ref().map_or(Ok(()), RecordedElevation::check_unchanged)?;
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
    messages::answer(&to_text(&found, network.is_some()))?;
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

/// What a profile is; `has_network` says whether the roads of the extract were at hand.
fn to_text(found: &Profile, has_network: bool) -> String {
    let heights = || points(found).map(|point| point.height_m);
    let [lowest, highest] =
        [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
    let gaps = match found.parts.len() {
        0 | 1 => String::new(),
        parts => format!(", in {parts} parts with gaps between them"),
    };
    let mut text = format!(
        "Length   {:.1} m in plan, {:.1} m on the ground{gaps}\n\
         Heights  {lowest:.1} to {highest:.1} m ({})\n",
        found.length_2d_m, found.length_3d_m, found.heights,
    );
    // Writing to a String cannot fail.
    let _ = if found.smooth.is_some() {
        let within_m = found.height_tolerance_m;
        let is_deck = |point: &ProfilePoint| matches!(point.height_source, "deck" | "tunnel");
        let decks =
            if points(found).any(is_deck) { "; bridges and tunnels are estimates" } else { "" };
        writeln!(text, "         those of the DEM, within {within_m:.3} m between vertices{decks}")
    } else {
        let within_m = found.height_tolerance_m;
        writeln!(
            text,
            "         within {within_m:.1} m of the DEM at its samples; --dem FILE gives the DEM's own"
        )
    };
    let has_grades = found.on_structures_m < found.length_2d_m;
    if let (Some((smooth, most_off_m)), true) = (found.smooth, has_grades) {
        text.push_str(&grades_text(&smooth, "50 m"));
        let _ = writeln!(
            text,
            "         of a smooth line, which is up to {most_off_m:.1} m from the ground; of the ground itself:"
        );
    }
    if has_grades {
        text.push_str(&grades_text(&found.grades, "20 m"));
    }
    if found.on_structures_m > 0.0 {
        let hint = if has_network { "" } else { "; --dem with --osm estimates their own" };
        let begin = if has_grades { "         without" } else { "Up, down not known of" };
        let _ = writeln!(
            text,
            "{begin} {:.1} m of bridges and tunnels: heights there are those of the ground below or above{hint}",
            found.on_structures_m
        );
    }
    let _ = writeln!(text, "Level    {}, {} vertices", found.level, points(found).count());
    text
}

fn grades_text(grades: &ProfileGrades, over: &str) -> String {
    let steepest = grades.steepest.map_or_else(
        || format!("no part is {over} long"),
        |grade| format!("{:.1} % over {over}", 100.0 * grade),
    );
    format!(
        "Up       {:.1} m\nDown     {:.1} m\nSteepest {steepest}\n",
        grades.ascent_m, grades.descent_m
    )
}

/// A line for each vertex; parts are numbered from 0.
fn to_csv(found: &Profile) -> String {
    let mut text = "part,way_id,distance_m,height_m,grade_pct,lon,lat,height_source".to_owned();
    if found.smooth.is_some() {
        text.push_str(",smooth_m,smooth_grade_pct");
    }
    text.push('\n');
    for (part, points) in found.parts.iter().enumerate() {
        for point in &points.points {
            let [lon, lat] = point.position_deg;
            // Writing to a String cannot fail.
            let _ = write!(
                text,
                "{part},{},{:.3},{:.3},{:.2},{lon:.8},{lat:.8},{}",
                point.way_id,
                point.distance_m,
                point.height_m,
                100.0 * point.grade,
                point.height_source,
            );
            let _ = match point.smooth {
                Some([height_m, grade]) => write!(text, ",{height_m:.3},{:.2}", 100.0 * grade),
                None if found.smooth.is_some() => write!(text, ",,"),
                None => Ok(()),
            };
            text.push('\n');
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
