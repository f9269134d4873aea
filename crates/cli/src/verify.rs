//! `corniche verify`: checks whether a package keeps its promises.

use std::{fmt::Write as _, path::PathBuf};

use corniche_tileset::FilePackage;
use corniche_verify::{
    Check, CheckId, ErrorFigures, Needs, VerifyError, VerifyOsm, VerifyReport, VerifySettings,
};

use crate::{
    args::{VerifyArgs, package_among},
    documents::{to_line, verify::VerifyDocument},
    escaped::in_line,
    exit::ExitCode,
    failure::Result,
    info::or_dash,
    messages, packages,
    progress::Progress,
    recorded::{MEMORY_BYTES, frc_table},
    settings::{polygon, threads},
    table::{Digits, Table},
};

pub(crate) fn run(args: &VerifyArgs) -> Result<ExitCode> {
    let lists = [&*args.dem, &*args.photo, &*args.osm];
    let usage = "corniche verify PACKAGE --dem FILE...";
    let (package, [dem, photo, osm]) = package_among(args.package.as_ref(), lists, usage)?;
    let package = packages::open(&package)?;
    let osm = extract(args, &osm, &package)?;
    let settings = VerifySettings {
        dem: corniche_spec::inputs::elevation_names(&dem)?,
        photo: corniche_spec::inputs::photo_names(&photo)?,
        osm,
        polygon: args.polygon.clone().map(polygon).transpose()?,
        threads: threads(args.cpu.threads),
    };
    let report = corniche_verify::verify(&package, &settings, &Progress::new())?;
    let text = if args.json {
        format!("{}\n", to_line(&VerifyDocument::from(&report)))
    } else {
        let manifest = package.manifest();
        let held = [manifest.settings.photo.is_some(), manifest.has_extract()];
        let missing = Missing::from_report(&report, held);
        let digits = Digits::of_answers();
        if messages::voice().quiet {
            to_short_text(&report, &missing, digits)
        } else {
            to_text(&report, &missing, digits)
        }
    };
    let written = messages::answer(&text);
    if report.holds() {
        written?;
        Ok(ExitCode::Done)
    } else {
        // The exit code reports a broken promise even if the output cannot be written.
        Ok(ExitCode::Failed)
    }
}

/// The extracts to read again, with the FRC table that the package names: the given one, or the
/// preset with that name.
fn extract(args: &VerifyArgs, osm: &[PathBuf], package: &FilePackage) -> Result<Option<VerifyOsm>> {
    if osm.is_empty() {
        return Ok(None);
    }
    let paths = corniche_spec::inputs::extract_names(osm)?;
    let manifest = package.manifest();
    if !manifest.has_extract() {
        return Err(VerifyError::NoExtract.into());
    }
    let table = frc_table(args.frc_table.as_deref(), package)?;
    Ok(Some(VerifyOsm { paths, table, memory_bytes: MEMORY_BYTES }))
}

/// Inputs that were not given, although checks of the package need them.
#[derive(Debug, Default)]
struct Missing(Vec<Needs>);

impl Missing {
    /// The inputs that are missing for further checks. A package without photos or without an
    /// extract has no checks of them.
    fn from_report(report: &VerifyReport, [has_photos, has_extract]: [bool; 2]) -> Self {
        let is_given = |needs| report.checks.iter().any(|check| check.id.needs() == needs);
        let needed = [(Needs::Dem, true), (Needs::Photo, has_photos), (Needs::Osm, has_extract)];
        let missing = needed.into_iter().filter(|&(needs, has)| has && !is_given(needs));
        Self(missing.map(|(needs, _)| needs).collect())
    }

    /// The number of further checks, and the options for them: "20 more need --dem and --osm".
    fn text(&self) -> Option<String> {
        let options: Vec<&str> =
            self.0.iter().map(|needs| needs.text().trim_matches('`')).collect();
        let options = match *options {
            [] => return None,
            [ref first @ .., last] if !first.is_empty() => {
                format!("{} and {last}", first.join(", "))
            }
            ref only => only.concat(),
        };
        let more = CheckId::ALL.iter().filter(|id| self.0.contains(&id.needs())).count();
        Some(format!("{more} more need {options}"))
    }
}

/// The report in one line: whether the checks hold, and how many had nothing to check.
fn verdict(report: &VerifyReport, missing: &Missing) -> String {
    let broken = report.checks.iter().filter(|check| !check.holds()).count();
    let not_made = report.checks.iter().filter(|check| check.checked == 0).count();
    let made = report.checks.len() - not_made;
    let mut text = match broken {
        0 => format!("all {made} checks hold"),
        1 => format!("1 of {made} checks is broken"),
        _ => format!("{broken} of {made} checks are broken"),
    };
    let not_run = report.checks.iter().filter(|check| is_not_run(check, broken > 0)).count();
    if not_run > 0 {
        let _ = write!(text, "; {not_run} not run");
    }
    match not_made - not_run {
        0 => {}
        1 => text.push_str("; 1 does not apply"),
        others => {
            let _ = write!(text, "; {others} do not apply");
        }
    }
    if let Some(more) = missing.text() {
        let _ = write!(text, "; {more}");
    }
    text
}

/// Whether a check was not made because others are broken: a check of the package alone that found
/// nothing to check does not apply to the package.
fn is_not_run(check: &Check, is_broken: bool) -> bool {
    is_broken && check.verdict().is_none()
}

/// A check and the first objects that break it.
fn check_text(check: &Check, is_broken: bool, digits: Digits) -> String {
    let verdict = match check.checked {
        _ if !check.holds() => "BROKEN  ",
        0 if is_not_run(check, is_broken) => "not run ",
        0 => "n/a     ",
        _ => "holds   ",
    };
    let (id, promise) = (check.id.id(), check.id.promise());
    let mut text = format!("{verdict}  {id}: {promise} ({} checked", digits.count(check.checked));
    if !check.holds() {
        let _ = write!(text, ", {} broken", digits.count(check.broken));
    }
    text.push_str(")\n");
    for example in &check.examples {
        let _ = writeln!(text, "            {}", in_line(example));
    }
    text
}

/// The broken checks, and the verdict.
fn to_short_text(report: &VerifyReport, missing: &Missing, digits: Digits) -> String {
    let broken = report.checks.iter().filter(|check| !check.holds());
    let broken: String = broken.map(|check| check_text(check, true, digits)).collect();
    format!("{broken}{}\n", verdict(report, missing))
}

/// The words that checks and figures use.
const WORDS: &str = "
P1: roads lie on the ground; P2: errors are bounded; P3: tile borders match; P6: roads and nodes are counted
GEO: roads stored as lines on the triangles of their tile
SV: roads stored as shadow volumes, which are drawn on whatever ground is visible
TIN: the triangles that are a tile's ground
node: a point of the package's height grid; sample: a height in the DEM's files
uncovered: with a height, but without a triangle, next to voids and at the edge of the data
manifest: the package's record of its settings, inputs and totals
";

/// All checks, the words, the figures, and the verdict.
fn to_text(report: &VerifyReport, missing: &Missing, digits: Digits) -> String {
    let is_broken = !report.holds();
    let checks = report.checks.iter().map(|check| check_text(check, is_broken, digits));
    let mut text: String = checks.collect();
    text.push_str(WORDS);
    let largest_m = report.gaps.iter().map(|gap| gap.largest_m).fold(0.0, f64::max);
    let _ = write!(
        text,
        "\n{} tiles and {} borders compared; largest gap between a GEO road and its TIN: {largest_m:.3e} m\n",
        digits.count(report.tiles),
        digits.count(report.borders),
    );
    if report.gaps.iter().any(|gap| gap.edges > 0) {
        let mut table = Table::new(["level", "GEO edges", "largest gap m"]);
        for gap in &report.gaps {
            table.row([
                gap.level.to_string(),
                digits.count(gap.edges),
                format!("{:.2e}", gap.largest_m),
            ]);
        }
        let _ = write!(text, "\n{}", table.to_text());
    }
    if !report.errors.is_empty() {
        let _ = write!(text, "\n{}", errors(&report.errors, digits).to_text());
    }
    if let Some(samples) = report.samples {
        let _ = write!(
            text,
            "\nErrors of the finest level at the DEM's {} covered samples: at most {:.3} m, {:.3} m RMS, {:.3} m at the \
             99th percentile; uncovered samples: {}\n",
            digits.count(samples.on_tin),
            samples.max_m,
            samples.rms_m,
            samples.p99_m,
            digits.count(samples.off_tin),
        );
    }
    let _ = writeln!(text, "\n{}", verdict(report, missing));
    text
}

/// True and stored errors, one row per level.
fn errors(errors: &[ErrorFigures], digits: Digits) -> Table {
    let mut table = Table::new([
        "level",
        "tiles",
        "nodes",
        "true error m",
        "stored/true min",
        "median",
        "p95",
        "max",
        "uncovered nodes",
    ]);
    let ratio = |value: Option<f64>| or_dash(value, 4);
    for figures in errors {
        table.row([
            figures.level.to_string(),
            digits.count(figures.tiles),
            digits.count(figures.nodes),
            format!("{:.3}", figures.largest_true_m),
            ratio(figures.tightness.map(|tightness| tightness.min)),
            ratio(figures.tightness.map(|tightness| tightness.median)),
            ratio(figures.tightness.map(|tightness| tightness.p95)),
            ratio(figures.tightness.map(|tightness| tightness.max)),
            digits.count(figures.uncovered_nodes),
        ]);
    }
    table
}

#[cfg(test)]
#[path = "verify_tests.rs"]
mod tests;
