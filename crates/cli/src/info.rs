//! `corniche info`: what a package holds and what became of its inputs.

mod words;

use std::fmt::Write as _;

use corniche_areas::{AreaClass, ClassedLayer, LineClass};
use corniche_geom::Cell;
use corniche_osm::LineLoss;
use corniche_tileset::{
    AreasRecord, Counts, DatumOperationRecord, LineLevelRecord, LinesRecord, Manifest,
    SampleErrorRecord, ScaleRecord, SpansRecord,
};

use self::words::words_of;
use crate::{
    args::InfoArgs,
    documents::info::InfoDocument,
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    messages, packages,
    presets::class_labels,
    table::{Digits, Table, bytes, length, wrapped},
};

/// Width of the names before the first lines' texts.
const NAMES: usize = 13;

pub(crate) fn run(args: &InfoArgs) -> Result<ExitCode, Failure> {
    let package = packages::open(&args.from.package)?;
    if args.json {
        let tiles: Vec<String> = package.tile_ids()?.iter().map(ToString::to_string).collect();
        let document = InfoDocument { manifest: package.manifest(), tiles };
        messages::answer_document(&document)?;
    } else {
        let size = package.bytes()?;
        messages::answer(&to_text(package.manifest(), size, Digits::of_answers()))?;
    }
    Ok(ExitCode::Done)
}

/// A manifest for people.
pub(crate) fn to_text(manifest: &Manifest, package_bytes: u64, digits: Digits) -> String {
    let mut text = String::new();
    let mut say = |line: String| {
        text.push_str(&line);
        text.push('\n');
    };
    let frame = &manifest.frame;
    let [west, south, east, north] = manifest.wgs84_bounds.to_array();
    say(format!(
        "package      {}, format {}, by {}",
        bytes(package_bytes),
        manifest.format_version,
        in_line(&manifest.generator)
    ));
    say(format!("CRS          {}, {}", in_line(&manifest.crs), factors(manifest.metres_per_unit)));
    say(format!("scale        {}", scales(&manifest.scale)));
    say(format!(
        "extent       {west:.5} {south:.5} {east:.5} {north:.5} (west south east north, degrees)"
    ));
    if let Some([west, south, east, north]) = manifest.settings.bounds_deg {
        say(format!("bounds       {west} {south} {east} {north}, a part of the elevation data"));
    }
    if let Some(polygon) = &manifest.settings.polygon {
        say(format!("polygon      {}, a part of the elevation data", in_line(&polygon.name)));
    }
    say(format!("grid         cell {} m, {}", sides(frame.cell()), in_line(&manifest.resampling)));
    let vertical = &manifest.vertical;
    let [lowest_m, highest_m] = vertical.range_m;
    say(format!(
        "heights      {lowest_m:.1} to {highest_m:.1} m, quantum {} m{}",
        vertical.quantum_m,
        match vertical.height_step_m {
            step_m if step_m > 0.0 => format!("; the DEM's are multiples of {step_m} m"),
            _ => String::new(),
        }
    ));
    say(format!(
        "datum        {}; heights {}",
        in_line(&vertical.datum),
        in_line(&vertical.treatment)
    ));
    for found in &manifest.datum_operations {
        say(format!("positions    {}", datum_operation(found)));
    }
    if let Some(warning) = odd_heights(manifest) {
        say(format!("warning: {warning}"));
    }
    let samples = &manifest.counts.samples;
    say(format!(
        "nodes        {}: {} with data, {} filled, {} void",
        digits.count(samples.nodes),
        digits.count(samples.with_data),
        digits.count(samples.filled),
        digits.count(samples.void)
    ));
    for input in &manifest.inputs {
        let hash = match input.sha256.get(..12) {
            Some(hash) => format!("sha256 {}…", in_line(hash)),
            None => "outside the bounds, not used".to_owned(),
        };
        say(format!(
            "input        {} {}, {}, {hash}",
            in_line(&input.kind),
            in_line(&input.name),
            bytes(input.bytes)
        ));
    }
    for credit in &manifest.attribution {
        say(format!("attribution  {}", in_line(credit)));
    }
    say(format!("\n{}", levels(manifest, digits).to_text()));
    if !manifest.photos.is_empty() {
        say(format!("Photos:\n{}", photos(manifest, digits).to_text()));
    }
    if let Some(areas) = &manifest.areas {
        say(area_texts(areas, digits));
    }
    for layer in ClassedLayer::ALL {
        if let Some(lines) = manifest.lines(layer) {
            say(line_texts(layer, lines, digits));
        }
    }
    if let Some(spans) = &manifest.spans {
        say(span_texts(spans, digits));
    }
    say(format!("Errors of the tiles:\n{}", tile_errors(manifest).to_text()));
    text.push_str(&sample_errors(manifest, digits));
    text.push_str(&roads(manifest, digits));
    text.push_str(&words_of(&text));
    narrow(&text)
}

/// How positions come from one datum to another, in words.
pub(crate) fn datum_operation(found: &DatumOperationRecord) -> String {
    let DatumOperationRecord { from, to, operation, ballpark, .. } = found;
    let accuracy = found.accuracy_text();
    let guess = if *ballpark { ", which takes one datum for the other" } else { "" };
    format!("{} to {} by {}, {accuracy}{guess}", in_line(from), in_line(to), in_line(operation))
}

/// What became of areas, and what they take on each level.
fn area_texts(areas: &AreasRecord, digits: Digits) -> String {
    let AreasRecord { counts, levels } = areas;
    let mut classes = Table::new(["areas", "number", "km²"]);
    for kept in &counts.kept {
        let name = AreaClass::from_number(kept.class).map_or("?", AreaClass::name);
        let area_km2 = format!("{:.3}", kept.area_km2);
        classes.row([name.to_owned(), digits.count(kept.areas), area_km2]);
    }
    let kept: u64 = counts.kept.iter().map(|kept| kept.areas).sum();
    let levels = levels.iter().map(|of| (of.level, [of.tiles, of.areas, of.points, of.bytes]));
    format!(
        "Areas: {} objects of the extract, of which {} became areas, wherever they lie:\n{}{}\n{}",
        digits.count(counts.objects),
        digits.count(kept),
        classes.to_text(),
        lost_text("objects", &counts.lost, digits),
        level_text("areas", levels, digits)
    )
}

/// What became of a layer of lines, and what it takes on each level.
fn line_texts(layer: ClassedLayer, lines: &LinesRecord, digits: Digits) -> String {
    let LinesRecord { counts, levels } = lines;
    let mut classes = Table::new([layer.name(), "ways", "km"]);
    for kept in &counts.kept {
        let name = layer.class(kept.class).map_or("?", LineClass::name);
        let length_km = format!("{:.1}", kept.length_um as f64 / 1e9);
        classes.row([name.to_owned(), digits.count(kept.ways), length_km]);
    }
    let levels = levels.iter().map(LineLevelRecord::figures);
    format!(
        "{}: {} ways of the extract, each once, wherever they lie:\n{}{}\n{}",
        layer.table().title,
        digits.count(counts.ways),
        classes.to_text(),
        lost_text("ways", &counts.lost, digits),
        level_text("parts", levels, digits)
    )
}

/// How many bridges and tunnels there are, and what they take on each level.
fn span_texts(spans: &SpansRecord, digits: Digits) -> String {
    let SpansRecord { counts, levels, .. } = spans;
    let levels = levels.iter().map(LineLevelRecord::figures);
    let kilometres = |length_um: u64| format!("{:.1} km", length_um as f64 / 1e9);
    let reasons = counts.reasons.iter();
    let reasons = reasons
        .map(|(reason, number)| format!("  {} × {}\n", digits.count(*number), in_line(reason)));
    format!(
        "Bridges and tunnels, heights estimated: {} bridges ({}) and {} tunnels ({}), each with all ways that it connects; they cross {} times:\n{}{}",
        digits.count(counts.bridges),
        kilometres(counts.bridges_um),
        digits.count(counts.tunnels),
        kilometres(counts.tunnels_um),
        digits.count(counts.crossings),
        reasons.collect::<String>(),
        level_text("runs", levels, digits)
    )
}

/// Which objects of a layer were lost, by reason.
fn lost_text(objects: &str, lost: &[(String, u64)], digits: Digits) -> String {
    let line = |(reason, number): &(String, u64)| {
        if is_beyond_extract(reason) {
            return format!("  {objects} beyond the extract: {}\n", digits.count(*number));
        }
        format!("  lost {} {objects}: {}\n", digits.count(*number), in_line(reason))
    };
    lost.iter().map(line).collect()
}

/// What a layer takes on each level: tiles, parts of objects in them, points, bytes.
fn level_text(parts: &str, levels: impl Iterator<Item = (u8, [u64; 4])>, digits: Digits) -> String {
    let mut table = Table::new(["level", "tiles", parts, "points", "bytes", "per tile"]);
    for (level, [tiles, parts, points, of_level]) in levels {
        let [tiles_text, parts, points] = [tiles, parts, points].map(|number| digits.count(number));
        let per_tile = bytes(of_level / tiles.max(1));
        table.row([level.to_string(), tiles_text, parts, points, bytes(of_level), per_tile]);
    }
    table.to_text()
}

/// Lines that are too wide are texts: they go on below the place where they began, beside their name.
fn narrow(text: &str) -> String {
    let line = |line: &str| {
        let is_named = !line.starts_with(' ') && line.get(NAMES - 2..NAMES) == Some("  ");
        let begin = line.len() - line.trim_start().len();
        let below = if is_named { NAMES } else { begin + 2 };
        format!("{}\n", wrapped(line, "", &" ".repeat(below)))
    };
    text.lines().map(line).collect()
}

/// The photos of each level. A square kilometre is one of the tiles that have a photo, whether it covers them or not.
fn photos(manifest: &Manifest, digits: Digits) -> Table {
    let mut photos = Table::new(["level", "texel m", "tiles", "photo", "per tile", "per km²"]);
    let finest = manifest.frame.max_level();
    for level in &manifest.photos {
        let cell = manifest.frame.level_cell(level.level);
        let finer = manifest.settings.photo.map_or(0, |of| of.levels_on(level.level, finest));
        let scale = f64::from(1_u32 << finer);
        let texel = Cell { east_m: cell.east_m / scale, north_m: cell.north_m / scale };
        let tile_km2 = cell.east_m * cell.north_m * 65_536.0 / manifest.point_scale.powi(2) / 1e6;
        photos.row([
            level.level.to_string(),
            sides(texel),
            digits.count(level.tiles),
            bytes(level.bytes),
            bytes(level.bytes / level.tiles.max(1)),
            bytes((level.bytes as f64 / (tile_km2 * level.tiles.max(1) as f64)).round() as u64),
        ]);
    }
    photos
}

/// What each level holds.
fn levels(manifest: &Manifest, digits: Digits) -> Table {
    let mut levels = Table::new([
        "level",
        "cell m",
        "tolerance m",
        "tiles",
        "triangles",
        "terrain",
        "B/triangle",
        "relief",
        "roads to FRC",
        "uncovered",
    ]);
    for level in &manifest.levels {
        levels.row([
            level.level.to_string(),
            sides(level.cell_m),
            rounded(level.max_error_m),
            digits.count(level.tiles),
            digits.count(level.triangles),
            bytes(level.terrain_bytes),
            format!("{:.2}", level.terrain_bytes as f64 / level.triangles.max(1) as f64),
            if level.relief_bytes == 0 { "–".to_owned() } else { bytes(level.relief_bytes) },
            level.least_class.map_or_else(|| "–".to_owned(), |class| class.to_string()),
            digits.count(level.uncovered_nodes),
        ]);
    }
    levels
}

/// What the tiles of each level store as their errors, and how much larger that is than the true ones.
fn tile_errors(manifest: &Manifest) -> Table {
    let mut errors =
        Table::new(["level", "error m", "median", "p95", "stored/true p95", "stored/true max"]);
    for level in &manifest.levels {
        errors.row([
            level.level.to_string(),
            format!("{:.2}", level.geometric_error_m),
            or_dash(level.errors_m.map(|errors_m| errors_m.median), 2),
            or_dash(level.errors_m.map(|errors_m| errors_m.p95), 2),
            or_dash(level.tightness.map(|tightness| tightness.p95), 3),
            or_dash(level.tightness.map(|tightness| tightness.max), 3),
        ]);
    }
    errors
}

/// How far each level is from the DEM's own samples.
fn sample_errors(manifest: &Manifest, digits: Digits) -> String {
    let mut table = Table::new(["level", "samples on TIN", "off TIN", "max m", "RMS m", "p99 m"]);
    for level in &manifest.levels {
        let SampleErrorRecord { on_tin, off_tin, max_m, rms_m, p99_m } = level.sample_error;
        table.row([
            level.level.to_string(),
            digits.count(on_tin),
            digits.count(off_tin),
            format!("{max_m:.2}"),
            format!("{rms_m:.3}"),
            format!("{p99_m:.2}"),
        ]);
    }
    let what = if manifest.nodes_are_samples {
        "At the DEM's own samples, which are the nodes"
    } else {
        "At the DEM's own samples, which are not the nodes"
    };
    format!("{what}:\n{}\n", table.to_text())
}

/// What makes working metres of a CRS's coordinates.
fn factors([east, north]: [f64; 2]) -> String {
    if [east, north].iter().all(|factor| factor.to_bits() == 1.0_f64.to_bits()) {
        return "working metres are its coordinates".to_owned();
    }
    format!("working metres are its coordinates times {east} (east) and {north} (north)")
}

/// The scale along both axes, as text.
fn scales(scale: &ScaleRecord) -> String {
    let along = |axis: usize, name: &str| {
        format!(
            "{name} {:.4} at the centre, {:.4} to {:.4} over the rim",
            scale.center[axis], scale.least[axis], scale.largest[axis]
        )
    };
    format!("working metres to a true metre: {}; {}", along(0, "east"), along(1, "north"))
}

/// A cell's sides: "30", "63.1 × 92.7".
pub(crate) fn sides(cell: Cell) -> String {
    let [east, north] = cell.to_array().map(rounded);
    if east == north { north } else { format!("{east} × {north}") }
}

/// A length to three digits at least, without zeros at its end.
pub(crate) fn rounded(metres: f64) -> String {
    let digits = (2.0 - metres.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{metres:.digits$}");
    if digits == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number with so many digits after the point; a dash where there is none.
pub(crate) fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
}

/// What heights tell of an undeclared "no data": no land or sea floor lies so low or so high.
///
/// Challenger Deep lies some 10 935 m below the sea, Everest 8 849 m above it.
/// What was said to be allowed is not odd. A build refuses samples outside; what remains comes of a shift or of another
/// vertical CRS, or of an older package.
pub(crate) fn odd_heights(manifest: &Manifest) -> Option<String> {
    const PLAUSIBLE_M: [f64; 2] = [-12_000.0, 9_500.0];
    let [lowest_m, highest_m] = manifest.vertical.range_m;
    let plausible_m = manifest.settings.height_range_m.map_or(PLAUSIBLE_M, |[low_m, high_m]| {
        [low_m.min(PLAUSIBLE_M[0]), high_m.max(PLAUSIBLE_M[1])]
    });
    let odd_m = if lowest_m < plausible_m[0] {
        lowest_m
    } else if highest_m > plausible_m[1] {
        highest_m
    } else {
        return None;
    };
    Some(format!(
        "a height of {odd_m} m is none of this earth; is --vertical-shift right? If the files store a value that means \"no data\", give it \
         with --nodata as they store it (before scale, unit and shift)"
    ))
}

/// What is wrong with an extract. Ways that are no road, and values that are read as others, are counted with their reasons, too, but are no
/// faults: they are told elsewhere.
pub(crate) fn defects(counts: &Counts) -> impl Iterator<Item = &(String, u64)> {
    const TOLD_ELSEWHERE: [&str; 3] =
        ["area", "unknown highway value", "tag taken for another value"];
    counts
        .defects
        .iter()
        .filter(|(name, _)| !TOLD_ELSEWHERE.contains(&name.as_str()) && !is_beyond_extract(name))
}

/// Whether a reason says that ways lie beyond the extract, where a line of it goes on.
fn is_beyond_extract(reason: &str) -> bool {
    ClassedLayer::ALL.into_iter().any(|layer| LineLoss::MissingWay.reason(layer) == reason)
}

/// How many ways of a layer of lines lie beyond the extract.
pub(crate) fn beyond_extract(lines: &LinesRecord) -> u64 {
    let lost = lines.counts.lost.iter().filter(|(reason, _)| is_beyond_extract(reason));
    lost.map(|(_, number)| number).sum()
}

fn roads(manifest: &Manifest, digits: Digits) -> String {
    let counts = &manifest.counts;
    if counts.roads_in == 0 && counts.highways_in == 0 {
        return "no roads: built without an extract, or from one without them\n".to_owned();
    }
    let mut text = String::new();
    let mut table = Table::new(["roads", "count", "length"]);
    let labels = class_labels(manifest);
    table.row(["read".into(), digits.count(counts.roads_in), length(counts.roads_in_um)]);
    for (class, &(roads, length_um)) in counts.classes.iter().enumerate() {
        if roads > 0 {
            table.row([
                format!("  FRC {class} {}", in_line(&labels[class])),
                digits.count(roads),
                length(length_um),
            ]);
        }
    }
    table.row([
        "kept at the finest level".into(),
        digits.count(counts.roads_kept),
        length(counts.roads_kept_um),
    ]);
    if !counts.roads_lost.is_empty() {
        // What is lost of a road that is kept in part is in the lengths alone.
        table.row(["lost, by reason", "whole roads", "length"].map(str::to_owned));
    }
    for loss in &counts.roads_lost {
        table.row([
            format!("lost {}", in_line(&loss.reason)),
            digits.count(loss.roads),
            length(loss.length_um),
        ]);
    }
    text.push_str(&table.to_text());
    let _ = writeln!(text, "FRC table: {}", in_line(&manifest.settings.frc_table));
    let _ = writeln!(text, "highway ways in the extract: {}", digits.count(counts.highways_in));
    if counts.blobs_passed_over > 0 {
        let _ = writeln!(
            text,
            "blobs of the extract of an unknown type, passed over: {}",
            digits.count(counts.blobs_passed_over)
        );
    }
    for (reason, number) in &counts.highways_left_out {
        let of_reason = || counts.left_out.iter().filter(|left_out| &left_out.reason == reason);
        let length_um: u64 = of_reason().map(|left_out| left_out.length_um).sum();
        let whole = if length_um > 0 { format!(", {}", length(length_um)) } else { String::new() };
        let _ =
            writeln!(text, "  not taken, {}: {}{whole}", in_line(reason), digits.count(*number));
        for left_out in of_reason() {
            let (ways, length) = (digits.count(left_out.ways), length(left_out.length_um));
            let _ = writeln!(text, "    highway={}: {ways}, {length}", in_line(&left_out.highway));
        }
    }
    for (name, number) in defects(counts) {
        let _ = writeln!(text, "defect: {}: {}", in_line(name), digits.count(*number));
    }
    for (value, number) in &counts.unknown_highways {
        let _ =
            writeln!(text, "highway={} is in no class: {}", in_line(value), digits.count(*number));
    }
    for (tag, number) in &counts.tags_taken_otherwise {
        let _ = writeln!(
            text,
            "{} is taken for another value: {}",
            in_line(tag),
            digits.count(*number)
        );
    }
    text
}

#[cfg(test)]
#[path = "info_tests.rs"]
mod tests;
