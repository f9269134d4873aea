//! `corniche info`: the contents of a package, and what became of its inputs.

mod words;

use std::{borrow::Cow, fmt::Write as _};

use corniche_geom::Cell;
use corniche_layers::LayerGeometry;
use corniche_osm::LineLoss;
use corniche_roads::LossReason;
use corniche_tileset::{
    DatumOperationRecord, LayerRecord, Manifest, ManifestCounts, SampleErrorRecord, ScaleRecord,
    SectionLevelRecord, SpansRecord,
};

use self::words::words_of;
use crate::{
    args::InfoArgs,
    documents::info::InfoDocument,
    escaped::in_line,
    failure::Result,
    messages, packages,
    presets::class_labels,
    table::{Digits, Table, bytes, length, wrapped},
};

/// Width of the label column in the first lines.
const NAMES: usize = 13;
/// What layers count.
const ALL: &str = "numbers include objects outside the package's extent";

pub(crate) fn run(args: &InfoArgs) -> Result<()> {
    let package = packages::open(&args.from.package)?;
    if args.json {
        let tiles: Vec<String> = package.tile_ids()?.iter().map(ToString::to_string).collect();
        let document = InfoDocument { manifest: package.manifest(), tiles };
        messages::answer_document(&document)?;
    } else {
        let size = package.bytes()?;
        messages::answer(&to_text(package.manifest(), size, Digits::of_answers()))?;
    }
    Ok(())
}

/// A manifest as text.
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
            step_m if step_m > 0.0 => format!("; heights of the DEM are multiples of {step_m} m"),
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
    for layer in &manifest.layers {
        say(layer_text(layer, digits));
    }
    if let Some(spans) = &manifest.spans {
        say(span_texts(spans, digits));
    }
    say(format!(
        "Errors of the tiles, at all nodes of the finest level. The tolerance applies only to the nodes of a level's \
         own grid (every 2nd, 4th, … node), so errors of coarse levels may be much larger:\n{}",
        tile_errors(manifest).to_text()
    ));
    text.push_str(&sample_errors(manifest, digits));
    text.push_str(&roads(manifest, digits));
    text.push_str(&words_of(&text));
    narrow(&text)
}

/// The operation that converts positions between datums, in words.
pub(crate) fn datum_operation(found: &DatumOperationRecord) -> String {
    let DatumOperationRecord { from, to, operation, ballpark, .. } = found;
    let accuracy = found.accuracy_text();
    let guess = if *ballpark { ", a ballpark transformation without datum shift" } else { "" };
    format!("{} to {} by {}, {accuracy}{guess}", in_line(from), in_line(to), in_line(operation))
}

/// The numbers of kept and lost objects of a layer, and its sizes on each level.
fn layer_text(layer: &LayerRecord, digits: Digits) -> String {
    let LayerRecord { table, counts, levels } = layer;
    let (objects, measure) = match table.geometry {
        LayerGeometry::Line => ("ways", "km"),
        LayerGeometry::Area => ("objects", "km²"),
        LayerGeometry::Point => ("objects", ""),
    };
    let mut classes = Table::new(["class", objects, measure]);
    for kept in &counts.kept {
        let class = table.classes.get(usize::from(kept.class)).map_or("?", |class| &class.id);
        let measure = match table.geometry {
            LayerGeometry::Line => format!("{:.1}", kept.length_um as f64 / 1e9),
            LayerGeometry::Area => format!("{:.3}", kept.area_km2),
            LayerGeometry::Point => String::new(),
        };
        classes.row([class.to_owned(), digits.count(kept.objects), measure]);
    }
    let kept: u64 = counts.kept.iter().map(|kept| kept.objects).sum();
    let unread = counts.unread_values.iter().map(|(key, values)| {
        format!("  values of {} that could not be read: {}\n", in_line(key), digits.count(*values))
    });
    format!(
        "Layer {}: {} {objects} of the extract, {} of them converted ({ALL}):\n{}{}{}\n{}",
        table.id,
        digits.count(counts.objects),
        digits.count(kept),
        classes.to_text(),
        lost_text(objects, &counts.lost, digits),
        unread.collect::<String>(),
        level_text("parts", levels.iter().map(SectionLevelRecord::figures), digits)
    )
}

/// The numbers of bridges and tunnels, and their sizes on each level.
fn span_texts(spans: &SpansRecord, digits: Digits) -> String {
    let SpansRecord { counts, levels, .. } = spans;
    let levels = levels.iter().map(SectionLevelRecord::figures);
    let kilometres = |length_um: u64| format!("{:.1} km", length_um as f64 / 1e9);
    let reasons = counts.reasons.iter();
    let reasons = reasons
        .map(|(reason, number)| format!("  {} × {}\n", digits.count(*number), in_line(reason)));
    let crossings = counts.crossings.iter();
    let crossings = crossings.map(|(upper, lower, number)| {
        format!("  {} over {}: {}\n", in_line(upper), in_line(lower), digits.count(*number))
    });
    let railways = match (counts.railway_bridges, counts.railway_tunnels) {
        (0, 0) => String::new(),
        (bridges, tunnels) => {
            let [bridges, tunnels] = [bridges, tunnels].map(|number| digits.count(number));
            format!("; railways: {bridges} bridges and {tunnels} tunnels")
        }
    };
    format!(
        "Bridges and tunnels (spans), heights estimated: {} bridges ({}) and {} tunnels ({}), connected ways counted as one{railways}; {} crossings{}:\n{}{}{}",
        digits.count(counts.bridges),
        kilometres(counts.bridges_um),
        digits.count(counts.tunnels),
        kilometres(counts.tunnels_um),
        digits.count(counts.crossings()),
        if counts.reasons.is_empty() { "" } else { "; to check" },
        crossings.collect::<String>(),
        reasons.collect::<String>(),
        level_text("runs", levels, digits)
    )
}

/// The numbers of lost objects of a layer, by reason.
fn lost_text(objects: &str, lost: &[(String, u64)], digits: Digits) -> String {
    let line = |(reason, number): &(String, u64)| {
        if is_beyond_extract(reason) {
            return format!("  {objects} missing from the extract: {}\n", digits.count(*number));
        }
        format!("  lost {} {objects}: {}\n", digits.count(*number), in_line(reason))
    };
    lost.iter().map(line).collect()
}

/// The size of a layer on each level: tiles, parts of objects in them, points, bytes.
fn level_text(parts: &str, levels: impl Iterator<Item = (u8, [u64; 4])>, digits: Digits) -> String {
    let mut table = Table::new(["level", "tiles", parts, "points", "bytes", "per tile"]);
    for (level, [tiles, parts, points, of_level]) in levels {
        let [tiles_text, parts, points] = [tiles, parts, points].map(|number| digits.count(number));
        let per_tile = bytes(of_level / tiles.max(1));
        table.row([level.to_string(), tiles_text, parts, points, bytes(of_level), per_tile]);
    }
    table.to_text()
}

/// Wraps lines that are too wide: they continue below the start of their text, next to their label.
fn narrow(text: &str) -> String {
    let line = |line: &str| {
        let is_named = !line.starts_with(' ') && line.get(NAMES - 2..NAMES) == Some("  ");
        let begin = line.len() - line.trim_start().len();
        let below = if is_named { NAMES } else { begin + 2 };
        format!("{}\n", wrapped(line, "", &" ".repeat(below)))
    };
    text.lines().map(line).collect()
}

/// The photos of each level. Square kilometres are those of the tiles with a photo, even where it
/// does not cover them.
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

/// The contents of each level.
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
        "uncovered nodes",
    ]);
    for level in &manifest.levels {
        levels.row([
            level.level.to_string(),
            sides(level.cell_m),
            in_metres(level.max_error_m),
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

/// The stored errors of the tiles of each level, and their ratio to the true errors.
fn tile_errors(manifest: &Manifest) -> Table {
    let mut errors =
        Table::new(["level", "error m", "median", "p95", "stored/true p95", "stored/true max"]);
    for level in &manifest.levels {
        errors.row([
            level.level.to_string(),
            in_metres(level.geometric_error_m),
            or_dash(level.errors_m.map(|errors_m| errors_m.median), 3),
            or_dash(level.errors_m.map(|errors_m| errors_m.p95), 3),
            or_dash(level.tightness.map(|tightness| tightness.p95), 3),
            or_dash(level.tightness.map(|tightness| tightness.max), 3),
        ]);
    }
    errors
}

/// The differences between each level and the DEM's own samples.
fn sample_errors(manifest: &Manifest, digits: Digits) -> String {
    let mut table =
        Table::new(["level", "covered samples", "uncovered samples", "max m", "RMS m", "p99 m"]);
    for level in &manifest.levels {
        let SampleErrorRecord { on_tin, off_tin, max_m, rms_m, p99_m } = level.sample_error;
        table.row([
            level.level.to_string(),
            digits.count(on_tin),
            digits.count(off_tin),
            in_metres(max_m),
            in_metres(rms_m),
            in_metres(p99_m),
        ]);
    }
    let what = if manifest.nodes_are_samples {
        "Errors at the DEM's own samples, each of which is a node"
    } else {
        "Errors at the DEM's own samples, which are other points than the nodes"
    };
    format!("{what}:\n{}\n", table.to_text())
}

/// An error, or its limit.
pub(crate) fn in_metres(error_m: f64) -> String {
    format!("{error_m:.3}")
}

/// The factors from a CRS's coordinates to working metres.
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
            "{name} {:.4} at the centre, {:.4} to {:.4} along the border",
            scale.center[axis], scale.least[axis], scale.largest[axis]
        )
    };
    format!("working metres per true metre: {}; {}", along(0, "east"), along(1, "north"))
}

/// A cell's sides: "30", "63.1 × 92.7".
pub(crate) fn sides(cell: Cell) -> String {
    let [east, north] = cell.to_array().map(rounded);
    if east == north { north } else { format!("{east} × {north}") }
}

/// A length with at least three digits, without trailing zeros.
pub(crate) fn rounded(metres: f64) -> String {
    let digits = (2.0 - metres.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{metres:.digits$}");
    if digits == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number with this many decimals; a dash for `None`.
pub(crate) fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
}

/// A warning about heights that suggest an undeclared nodata value: no land or sea floor is so low
/// or so high.
///
/// Challenger Deep is some 10 935 m below the sea, Everest 8 849 m above it. Heights within the
/// range that the user allowed are not odd. A build rejects samples outside it; such heights remain
/// after a shift, with another vertical CRS, or in an older package.
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
        "implausible height: {odd_m} m. Check --vertical-shift. If the files contain an undeclared nodata value, pass it \
         with --nodata, as stored in the files (before scale, unit and shift)"
    ))
}

/// The defects of an extract. Ways that are not roads, and values that are interpreted as others,
/// are also counted by reason, but they are not defects and are reported elsewhere.
pub(crate) fn defects(counts: &ManifestCounts) -> impl Iterator<Item = &(String, u64)> {
    const TOLD_ELSEWHERE: [&str; 3] =
        ["area", "unknown highway value", "tag taken for another value"];
    counts
        .defects
        .iter()
        .filter(|(name, _)| !TOLD_ELSEWHERE.contains(&name.as_str()) && !is_beyond_extract(name))
}

/// The reason of a loss, without the older words in which packages record some.
pub(crate) fn reason_words(recorded: &str) -> Cow<'_, str> {
    match LossReason::from_text(recorded) {
        Some(LossReason::Listed) => "not roads by the FRC table".into(),
        Some(LossReason::NoGround) => "where the data has no ground (void or edge)".into(),
        Some(LossReason::OutsideBounds) => "outside the requested bounds".into(),
        _ => in_line(recorded),
    }
}

/// Whether a reason means that ways are beyond the extract, where a line of a relation continues
/// outside it.
fn is_beyond_extract(reason: &str) -> bool {
    LineLoss::MissingWay.reason() == reason
}

/// The number of ways of a layer beyond the extract.
pub(crate) fn beyond_extract(layer: &LayerRecord) -> u64 {
    let lost = layer.counts.lost.iter().filter(|(reason, _)| is_beyond_extract(reason));
    lost.map(|(_, number)| number).sum()
}

fn roads(manifest: &Manifest, digits: Digits) -> String {
    let counts = &manifest.counts;
    if counts.roads_in == 0 && counts.highways_in == 0 {
        return "no roads: built without an extract, or from an extract without roads\n".to_owned();
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
        "kept: in the package, on the finest level".into(),
        digits.count(counts.roads_kept),
        length(counts.roads_kept_um),
    ]);
    if !counts.roads_lost.is_empty() {
        // Roads that are kept in part add to the lost lengths only.
        table.row(["lost, by reason", "whole roads", "length"].map(str::to_owned));
    }
    for loss in &counts.roads_lost {
        table.row([
            format!("lost {}", reason_words(&loss.reason)),
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
            "blobs of unknown type in the extract, skipped: {}",
            digits.count(counts.blobs_passed_over)
        );
    }
    for (reason, number) in &counts.highways_left_out {
        let of_reason = || counts.left_out.iter().filter(|left_out| &left_out.reason == reason);
        let length_um: u64 = of_reason().map(|left_out| left_out.length_um).sum();
        let whole = if length_um > 0 { format!(", {}", length(length_um)) } else { String::new() };
        let (words, number) = (reason_words(reason), digits.count(*number));
        let _ = writeln!(text, "  skipped, {words}: {number}{whole}");
        for left_out in of_reason() {
            let (ways, length) = (digits.count(left_out.ways), length(left_out.length_um));
            let _ = writeln!(text, "    highway={}: {ways}, {length}", in_line(&left_out.highway));
        }
    }
    for (name, number) in defects(counts) {
        let _ = writeln!(text, "defect: {}: {}", in_line(name), digits.count(*number));
    }
    for (value, number) in &counts.unknown_highways {
        let (value, ways) = (in_line(value), digits.count(*number));
        let _ = writeln!(text, "highway={value} is in no class of the FRC table: {ways}");
    }
    for (tag, number) in &counts.tags_taken_otherwise {
        let _ = writeln!(
            text,
            "{} is treated as another value: {}",
            in_line(tag),
            digits.count(*number)
        );
    }
    text
}

#[cfg(test)]
#[path = "info_tests.rs"]
mod tests;
