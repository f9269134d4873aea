//! `corniche verify`: whether a package keeps its promises.

use std::{fmt::Write as _, path::PathBuf};

use corniche_areas::AreaTable;
use corniche_presets::area_preset;
use corniche_tileset::FilePackage;
use corniche_verify::{
    Check, CheckId, ErrorFigures, Needs, VerifyError, VerifyOsm, VerifyReport, VerifySettings,
};

use crate::{
    args::{VerifyArgs, package_among},
    documents::{to_line, verify::VerifyDocument},
    escaped::in_line,
    exit::ExitCode,
    failure::Failure,
    info::or_dash,
    messages, packages, presets,
    progress::Progress,
    recorded::{MEMORY_BYTES, frc_table, no_preset},
    settings::{polygon, threads},
    table::{Digits, Table},
};

pub(crate) fn run(args: &VerifyArgs) -> Result<ExitCode, Failure> {
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
        let missing = Missing::of(&report, held);
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
        // The exit code reports a broken promise even if the output could not be written.
        Ok(ExitCode::Failed)
    }
}

/// The extracts to read again, with the FRC table that the package names: given, or the preset of that name.
fn extract(
    args: &VerifyArgs,
    osm: &[PathBuf],
    package: &FilePackage,
) -> Result<Option<VerifyOsm>, Failure> {
    if osm.is_empty() {
        return Ok(None);
    }
    let paths = corniche_spec::inputs::extract_names(osm)?;
    let manifest = package.manifest();
    if !manifest.has_extract() {
        return Err(VerifyError::NoExtract.into());
    }
    let table = frc_table(args.frc_table.as_deref(), package)?;
    let areas = areas(args, package)?;
    Ok(Some(VerifyOsm { paths, table, areas, memory_bytes: MEMORY_BYTES }))
}

/// The table of areas that the package names: given, or the preset of that name; `None` if the package has no areas.
fn areas(args: &VerifyArgs, package: &FilePackage) -> Result<Option<AreaTable>, Failure> {
    match (&args.areas, &package.manifest().settings.areas) {
        (Some(table), _) => presets::area_table(table).map(Some),
        (None, None) => Ok(None),
        (None, Some(recorded)) => {
            let name = &recorded.table;
            if area_preset(name).is_none() {
                return Err(no_preset(package, &format!("table of areas {name:?}"), "--areas"));
            }
            presets::area_table(name).map(Some)
        }
    }
}

/// Inputs that were not given, though checks of the package need them.
#[derive(Debug, Default)]
struct Missing(Vec<Needs>);

impl Missing {
    /// What is missing for the checks that a report does not have, of a package with photos or an extract, or without: then it has no checks of them.
    fn of(report: &VerifyReport, [has_photos, has_extract]: [bool; 2]) -> Self {
        let is_given = |needs| report.checks.iter().any(|check| check.id.needs() == needs);
        let needed = [(Needs::Dem, true), (Needs::Photo, has_photos), (Needs::Osm, has_extract)];
        let missing = needed.into_iter().filter(|&(needs, has)| has && !is_given(needs));
        Self(missing.map(|(needs, _)| needs).collect())
    }

    /// How many more checks they allow, and their options: "20 more need --dem and --osm".
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

/// The report in one line: whether the checks hold, and which were not made.
fn verdict(report: &VerifyReport, missing: &Missing) -> String {
    let number = |verdict| report.checks.iter().filter(|check| check.verdict() == verdict).count();
    let (broken, not_made) = (number(Some(false)), number(None));
    let made = report.checks.len() - not_made;
    let mut text = match broken {
        0 => format!("all {made} checks hold"),
        1 => format!("1 of {made} checks is broken"),
        _ => format!("{broken} of {made} checks are broken"),
    };
    match (not_made, broken) {
        (0, _) => {}
        (1, 0) => text.push_str("; 1 does not apply"),
        (_, 0) => {
            let _ = write!(text, "; {not_made} do not apply");
        }
        // What is broken may be why.
        _ => {
            let _ = write!(text, "; {not_made} not made");
        }
    }
    if let Some(more) = missing.text() {
        let _ = write!(text, "; {more}");
    }
    text
}

/// A check with what breaks it. Where nothing `is_broken`, a check was not made because the package has nothing of its kind.
fn check_text(check: &Check, is_broken: bool, digits: Digits) -> String {
    let verdict = match check.verdict() {
        Some(true) => "holds   ",
        Some(false) => "BROKEN  ",
        None if is_broken => "not made",
        None => "no case ",
    };
    let (id, promise) = (check.id.id(), check.id.promise());
    let mut text = format!("{verdict}  {id}: {promise} ({} looked at", digits.count(check.checked));
    if !check.holds() {
        let _ = write!(text, ", {} broken", digits.count(check.broken));
    }
    text.push_str(")\n");
    for example in &check.examples {
        let _ = writeln!(text, "            {}", in_line(example));
    }
    text
}

/// What is broken, and the verdict.
fn to_short_text(report: &VerifyReport, missing: &Missing, digits: Digits) -> String {
    let broken = report.checks.iter().filter(|check| !check.holds());
    let broken: String = broken.map(|check| check_text(check, true, digits)).collect();
    format!("{broken}{}\n", verdict(report, missing))
}

/// Every check, the figures, and the verdict.
fn to_text(report: &VerifyReport, missing: &Missing, digits: Digits) -> String {
    let is_broken = !report.holds();
    let checks = report.checks.iter().map(|check| check_text(check, is_broken, digits));
    let mut text: String = checks.collect();
    let largest_m = report.gaps.iter().map(|gap| gap.largest_m).fold(0.0, f64::max);
    let _ = write!(
        text,
        "\n{} tiles, {} borders compared; largest gap of a GEO road to its TIN: {largest_m:.3e} m\n",
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
            "\nAt the DEM's own {} samples the finest level is off by {:.3} m at most, {:.3} m RMS, {:.3} m at \
             the 99th percentile; {} off the TIN\n",
            digits.count(samples.on_tin),
            samples.max_m,
            samples.rms_m,
            samples.p99_m,
            lying(samples.off_tin, digits),
        );
    }
    let _ = writeln!(text, "\n{}", verdict(report, missing));
    text
}

/// A number of samples in words, with their verb.
fn lying(samples: u64, digits: Digits) -> String {
    match samples {
        1 => "1 sample lies".to_owned(),
        _ => format!("{} samples lie", digits.count(samples)),
    }
}

/// True errors and stored ones, one row for each level.
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
