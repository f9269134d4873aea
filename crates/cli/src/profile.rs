//! `corniche profile`: prints height and grade along roads and other lines.

mod drawing;

use std::{collections::BTreeSet, fmt::Write as _, path::Path};

use corniche_export::{
    Course, HeightKind, NetworkRoute, ProfileGrades, ProfileLeg, ProfilePoint, RoadHeights,
    RoadProfile, RoadQuery, RouteError, RouteRequest, profile, profile_of_course, route,
};
use corniche_overlay::LatticeLine;
use corniche_tileset::FilePackage;
use corniche_verify::RecordedElevation;

use crate::{
    args::ProfileArgs,
    chart::ends,
    documents::{profile::ProfileDocument, to_line},
    escaped::in_line,
    failure::Result,
    messages,
    names::file_name,
    output::{Output, existing_of, report_files::ReportFiles},
    overlays, packages,
    progress::Progress,
    recorded,
    table::up_to,
};

pub(crate) fn run(args: &ProfileArgs) -> Result<()> {
    let usage = "corniche profile PACKAGE --way ID --dem FILE...";
    let (place, [dem, osm]) = args.recorded.files(&args.extract.osm, usage)?;
    args.refuse_idle_extract(&dem, &osm)?;
    let package = packages::open(&place)?;
    // All paths are checked before any work is done.
    let inputs: Vec<&Path> = [place.name()]
        .into_iter()
        .chain(args.line.as_deref())
        .chain(dem.iter().chain(&osm).map(AsRef::as_ref))
        .collect();
    let lists = [("--csv", args.csv.as_deref()), ("--json", args.json.as_deref())];
    let existing = existing_of(args.overwrite);
    let files = ReportFiles::begin(args.svg.as_deref(), lists, &inputs, existing)?;
    let placed = |path| placed_lines(path, args.allow_ballpark, &package);
    let lines = args.line.as_deref().map(placed).transpose()?;
    let recorded = recorded::elevation(&args.recorded, &dem, &package)?;
    let elevation = recorded.as_ref().map(recorded::for_export);
    let network = recorded::network(&args.extract, &osm, (&args.cpu, &package))?;
    let progress = Progress::new();
    let heights = RoadHeights { elevation, network: network.as_ref() };
    let level = args.at.level;
    let mut road = None;
    let found = if args.is_route() {
        let request = RouteRequest {
            level,
            road: args.road.query(),
            ends_deg: args.ends_deg(),
            classes: args.filter.of_package(package.manifest())?,
        };
        let found = route(&package, &request, network.as_ref(), &progress);
        if let Err(RouteError::SeveralRoads { roads, .. }) = &found {
            progress.finish();
            for road in roads {
                messages::warning(road);
            }
        }
        let found = found?;
        let course = &road.insert(found).course;
        profile_of_course(&package, course, level, heights, &progress)
    } else if let Some(course) = &lines {
        profile_of_course(&package, course, level, heights, &progress)
    } else {
        profile(&package, &args.way, level, heights, &progress)
    };
    progress.finish();
    // A changed file may be the cause of any other error.
    recorded.as_ref().map_or(Ok(()), RecordedElevation::check_unchanged)?;
    let found = found?;
    let title = title(args, &found);
    let make_svg = || {
        let credits = package.manifest().attribution.join(", ");
        Ok(drawing::to_svg(&found, &title, &facts(&found), &credits)?)
    };
    let fill_list = |number, output: Output| {
        if number == 0 {
            return output.fill(to_csv(&found).as_bytes());
        }
        let document =
            ProfileDocument::from_profile(&found, &title, &package.manifest().attribution);
        output.fill(format!("{}\n", to_line(&document)).as_bytes())
    };
    files.write(fill_list, make_svg)?;
    for written in [&args.csv, &args.svg, &args.json].into_iter().flatten() {
        note!("wrote {}", written.display());
    }
    let told = road.map(|road| to_text_of_route(&road, args.road.query().as_ref()));
    Ok(messages::answer(&(told.unwrap_or_default() + &to_text(&found, network.is_some())))?)
}

/// The title of a profile: a road as signed, a file, or the roads that it follows, each once.
fn title(args: &ProfileArgs, found: &RoadProfile) -> String {
    if let Some(path) = &args.line {
        return file_name(path);
    }
    let mut known = BTreeSet::new();
    let names = found.legs.iter().map(drawing::name_of);
    let names: Vec<String> =
        names.filter(|name| !name.is_empty() && known.insert(name.clone())).collect();
    if let Some(road) = args.road.query() {
        let written =
            |leg: &'_ ProfileLeg| road.written(&leg.reference, &leg.name).map(str::to_owned);
        if let Some(text) = found.legs.iter().find_map(written) {
            return match road.reference {
                Some(_) => format!("Road {text}"),
                None => text,
            };
        }
    }
    if names.is_empty() {
        let ways: BTreeSet<i64> = found.legs.iter().map(|leg| leg.way_id).collect();
        let ways: Vec<String> = ways.iter().map(i64::to_string).collect();
        return format!("Way {}", ways.join(", "));
    }
    names.join(", ")
}

/// The main figures of a profile, in short.
fn facts(found: &RoadProfile) -> String {
    let (grades, over) = match &found.smooth {
        Some((grades, _)) => (grades, "50 m"),
        None => (&found.grades, "20 m"),
    };
    let steepest = grades
        .steepest
        .map(|grade| format!(" · steepest {:.1} % over {over}", 100.0 * grade))
        .unwrap_or_default();
    let heights = match &found.smooth {
        Some(_) => "heights of the DEM".to_owned(),
        None => format!("heights of the package, level {}", found.level),
    };
    let without = match found.on_structures_m {
        without_m if without_m > 0.0 => ", excluding bridges and tunnels",
        _ => "",
    };
    format!(
        "{:.2} km · up {:.0} m, down {:.0} m{steepest}{without} · {heights}",
        found.length_2d_m / 1e3,
        grades.ascent_m,
        grades.descent_m,
    )
}

/// The route that was found for a road, as text.
fn to_text_of_route(road: &NetworkRoute, query: Option<&RoadQuery>) -> String {
    let mut text = String::new();
    if let (Some(road_m), Some(query)) = (road.road_m, query) {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "Road     {}: {:.1} km from end to end; its OSM ways have {:.1} km in total{}",
            in_line(&query.text()),
            road.length_m / 1e3,
            road_m / 1e3,
            if road.length_m < 0.999 * road_m {
                "; other carriageways, arms of roundabouts and branches are skipped"
            } else {
                ""
            },
        );
    }
    if road.others_m > 0.0 && query.is_some() {
        let _ = writeln!(
            text,
            "         {:.0} m of other roads close gaps in this road",
            road.others_m
        );
    }
    if !road.same_name.is_empty() {
        let _ = writeln!(text, "         skipped, because not connected with this route:");
        for other in &road.same_name {
            let _ = writeln!(text, "         {other}");
        }
    }
    if road.off_m.iter().any(|off_m| *off_m >= 0.5) {
        let [from_m, to_m] = road.off_m;
        let _ = writeln!(
            text,
            "Ends     on the nearest roads, {from_m:.0} m and {to_m:.0} m from the given positions"
        );
    }
    text
}

/// The lines of a file on the package's lattice, with their numbers in the file, from 1.
fn placed_lines(path: &Path, allow_ballpark: bool, package: &FilePackage) -> Result<Course> {
    let found = corniche_overlay::read(path, allow_ballpark)?;
    overlays::tell(path, &found);
    let placed = corniche_overlay::place(&found.lines, package.manifest())?;
    let line = |placed: LatticeLine| {
        (placed.line as i64 + 1, found.lines[placed.line].name.clone(), placed.points)
    };
    let begins_deg = found.lines.first().and_then(|line| line.positions_deg.first()).copied();
    Ok(Course { begins_deg, ..Course::of_lines(placed.into_iter().map(line)) })
}

fn points(found: &RoadProfile) -> impl Iterator<Item = &ProfilePoint> {
    found.parts.iter().flat_map(|part| &part.points)
}

/// The profile as text; `has_network` means that the roads of the extract are available.
fn to_text(found: &RoadProfile, has_network: bool) -> String {
    let [lowest, highest] = ends(points(found).map(|point| point.height_m));
    let gaps = match found.parts.len() {
        0 | 1 => String::new(),
        parts => format!(", in {parts} parts with gaps between them"),
    };
    let mut text = format!(
        "Length   {:.1} m in plan, {:.1} m on the ground{gaps}\n\
         Heights  {lowest:.1} to {highest:.1} m ({})\n",
        found.length_2d_m,
        found.length_3d_m,
        in_line(&found.heights),
    );
    // Writing to a String cannot fail.
    let _ = if found.smooth.is_some() {
        let within_m = up_to(found.height_tolerance_m, 3);
        let is_deck = |point: &ProfilePoint| {
            matches!(point.height_source, HeightKind::Deck | HeightKind::Tunnel)
        };
        let decks =
            if points(found).any(is_deck) { "; bridges and tunnels are estimates" } else { "" };
        writeln!(text, "         from the DEM, within {within_m} m between vertices{decks}")
    } else {
        let within_m = up_to(found.height_tolerance_m, 1);
        writeln!(
            text,
            "         within {within_m} m of the DEM at its samples; use --dem FILE for the DEM's own heights"
        )
    };
    let has_grades = found.on_structures_m < found.length_2d_m;
    if let (Some((smooth, most_off_m)), true) = (found.smooth, has_grades) {
        text.push_str(&grades_text(&smooth, "50 m"));
        let _ = writeln!(
            text,
            "         along a smoothed line, which is up to {} m from the ground; along the ground itself:",
            up_to(most_off_m, 1)
        );
    }
    if has_grades {
        text.push_str(&grades_text(&found.grades, "20 m"));
    }
    if found.on_structures_m > 0.0 {
        let hint =
            if has_network { "" } else { "; --dem with --osm estimates the heights of decks" };
        let begin = if has_grades { "         excluding" } else { "Up, down unknown on" };
        let _ = writeln!(
            text,
            "{begin} {:.1} m of bridges and tunnels, which have the heights of the ground below or above{hint}",
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

/// The profile as CSV, one line per vertex; parts are numbered from 0.
fn to_csv(found: &RoadProfile) -> String {
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
                point.height_source.name(),
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
