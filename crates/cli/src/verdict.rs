//! What a build ends with, in a few lines: the roads that are kept, what was left out and how to have it, the error, the size.

use std::path::Path;

use corniche_roads::LossReason;
use corniche_tileset::{AreasRecord, Counts, LinesRecord, Manifest, VerticalRecord};

use crate::{
    escaped::in_line,
    info::{beyond_extract, rounded, sides},
    table::{Digits, bytes, length},
};

/// The most lines that a build ends with.
const MOST_LINES: usize = 8;
/// The most lines of what was left out.
const MOST_LEFT_OUT: usize = 3;
/// The most values of `highway` that are named.
const MOST_VALUES: usize = 3;

/// The verdict on a package that was written to `output`.
pub(crate) fn to_text(
    manifest: &Manifest,
    package_bytes: u64,
    output: &Path,
    digits: Digits,
) -> String {
    let counts = &manifest.counts;
    let layers = [layers(manifest, digits), defects(counts, digits), datum(manifest)];
    let mut end: Vec<String> = layers.into_iter().flatten().collect();
    end.extend([error(manifest), size(manifest, package_bytes, digits), look(output)]);
    let mut lines = vec![roads(manifest, digits)];
    lines.extend(left_out(counts, digits, MOST_LEFT_OUT.min(MOST_LINES - 1 - end.len())));
    lines.extend(end);
    let lines: Vec<String> =
        lines.into_iter().map(|line| format!("{}\n", line.trim_end())).collect();
    lines.concat()
}

/// Roads kept of those that were read.
fn roads(manifest: &Manifest, digits: Digits) -> String {
    let counts = &manifest.counts;
    if counts.roads_in == 0 {
        let why = match (manifest.has_extract(), counts.highways_in) {
            (false, _) => "built without an extract",
            (true, 0) => "the extract has none",
            (true, _) => "the extract has none of the classes that are on",
        };
        return format!("roads        none: {why}");
    }
    format!(
        "roads        {} of {} kept, {} of {}",
        digits.count(counts.roads_kept),
        digits.count(counts.roads_in),
        length(counts.roads_kept_um),
        length(counts.roads_in_um)
    )
}

/// Something of the extract that the package does not have.
struct LeftOut {
    number: u64,
    length_um: u64,
    /// What it is, and why it was left out.
    what: String,
    /// How to have it.
    remedy: Option<&'static str>,
}

/// What was left out, the longest first, in at most so many lines.
fn left_out(counts: &Counts, digits: Digits, most: usize) -> Vec<String> {
    let lost = counts.roads_lost.iter().filter(|loss| loss.length_um > 0).map(|loss| LeftOut {
        number: loss.roads,
        length_um: loss.length_um,
        what: format!(
            "{} {}",
            if loss.roads > 0 { "whole roads" } else { "parts of roads" },
            in_line(&loss.reason)
        ),
        remedy: remedy(&loss.reason),
    });
    let ways = counts.highways_left_out.iter().map(|(reason, number)| {
        let of_reason: Vec<_> =
            counts.left_out.iter().filter(|left_out| &left_out.reason == reason).collect();
        let values = of_reason
            .iter()
            .take(MOST_VALUES)
            .map(|left_out| in_line(&left_out.highway).into_owned());
        let mut values: Vec<String> = values.collect();
        if of_reason.len() > MOST_VALUES {
            values.push("…".to_owned());
        }
        let values =
            if values.is_empty() { values.concat() } else { format!(" ({})", values.join(", ")) };
        LeftOut {
            number: *number,
            length_um: of_reason.iter().map(|left_out| left_out.length_um).sum(),
            what: format!("ways, {}{values}", in_line(reason)),
            remedy: remedy(reason),
        }
    });
    let mut all: Vec<LeftOut> = lost.chain(ways).collect();
    // What can be had comes first. The sort is stable.
    all.sort_by_key(|one| (one.remedy.is_none(), std::cmp::Reverse(one.length_um)));
    // Where there is one line alone, what is not told stands at its end.
    let told = if all.len() > most { most.saturating_sub(1).max(1) } else { all.len() };
    let line = |one: &LeftOut| {
        let LeftOut { number, length_um, what, remedy } = one;
        let remedy = remedy.map(|remedy| format!(": {remedy}")).unwrap_or_default();
        let long = if *length_um > 0 { format!(", {}", length(*length_um)) } else { String::new() };
        // Of roads that are kept parts may be lost; they are not counted.
        let number = if *number > 0 { digits.count(*number) + " " } else { String::new() };
        format!("{number}{what}{long}{remedy}")
    };
    let mut lines: Vec<String> = all[..told].iter().map(line).collect();
    if let rest @ [_, ..] = &all[told..] {
        let number: u64 = rest.iter().map(|one| one.number).sum();
        let length_um = rest.iter().map(|one| one.length_um).sum();
        let number = digits.count(number);
        match lines.last_mut().filter(|_| told == most) {
            Some(line) => *line = format!("{line}; {number} more"),
            None => lines.push(format!("{number} more for other reasons, {}", length(length_um))),
        }
    }
    let name = |index: usize| if index == 0 { "left out" } else { "" };
    lines.iter().enumerate().map(|(index, line)| format!("{:<13}{line}", name(index))).collect()
}

/// How to have what was left out for a reason, as packages name it; `None` where it is no road, or
/// was not asked for.
fn remedy(reason: &str) -> Option<&'static str> {
    match LossReason::from_text(reason)? {
        LossReason::ClassOff => Some("--classes 0-8 has them"),
        LossReason::Unknown => Some("--frc-table FILE, with these values, has them"),
        LossReason::OutsideData => Some("give --dem files that cover them"),
        LossReason::NoGround => Some("--fill-voids N fills gaps of N cells"),
        LossReason::Listed
        | LossReason::Area
        | LossReason::Duplicate
        | LossReason::WithoutLine
        | LossReason::OutsideBounds => None,
    }
}

/// Areas and boundaries, where they were asked for.
fn layers(manifest: &Manifest, digits: Digits) -> Option<String> {
    let kept = |kept: u64, all: u64| format!("{} of {}", digits.count(kept), digits.count(all));
    let areas = manifest.areas.as_ref().map(|AreasRecord { counts, .. }| {
        let kept = kept(counts.kept.iter().map(|of| of.areas).sum(), counts.objects);
        format!("areas        {kept} objects kept")
    });
    let boundaries = manifest.boundaries.as_ref().map(|record @ LinesRecord { counts, .. }| {
        let kept = kept(counts.kept.iter().map(|of| of.ways).sum(), counts.ways);
        match beyond_extract(record) {
            0 => format!("{kept} ways kept"),
            beyond => format!("{kept} ways kept, {} beyond the extract", digits.count(beyond)),
        }
    });
    match (areas, boundaries) {
        (Some(areas), Some(boundaries)) => Some(format!("{areas}; boundaries: {boundaries}")),
        (Some(areas), None) => Some(areas),
        (None, boundaries) => boundaries.map(|boundaries| format!("boundaries   {boundaries}")),
    }
}

/// Bad input that was survived.
fn defects(counts: &Counts, digits: Digits) -> Option<String> {
    let defects: Vec<&(String, u64)> = crate::info::defects(counts).collect();
    let number: u64 = defects.iter().map(|(_, number)| number).sum();
    let (name, _) = defects.iter().max_by_key(|(_, number)| number)?;
    let more = if defects.len() > 1 {
        format!(", most of all: {}", in_line(name))
    } else {
        format!(": {}", in_line(name))
    };
    Some(format!("defects      {}{more}; --defects FILE lists them", digits.count(number)))
}

/// What cannot be done with heights of an unknown datum.
fn datum(manifest: &Manifest) -> Option<String> {
    (manifest.vertical.datum == VerticalRecord::UNKNOWN_DATUM).then(|| {
        "datum        unknown: heights above the ellipsoid need --dem-vertical-crs, here or in exports"
            .to_owned()
    })
}

/// How far the finest level is from the DEM's samples.
fn error(manifest: &Manifest) -> String {
    let Some(finest) = manifest.levels.last() else { return "error        none".to_owned() };
    let at_samples = &finest.sample_error;
    format!(
        "error        at most {:.2} m at the DEM's samples, {:.3} m RMS, where {} m are allowed",
        at_samples.max_m,
        at_samples.rms_m,
        rounded(finest.max_error_m)
    )
}

/// What the package takes.
fn size(manifest: &Manifest, package_bytes: u64, digits: Digits) -> String {
    let tiles: u64 = manifest.levels.iter().map(|level| level.tiles).sum();
    format!(
        "size         {}: {} tiles on {} levels, cells of {} m",
        bytes(package_bytes),
        digits.count(tiles),
        manifest.levels.len(),
        sides(manifest.frame.cell())
    )
}

/// Where the package is, and where to look on.
fn look(output: &Path) -> String {
    let place = output.display();
    format!("wrote        {place}; corniche info tells all of it, view and serve show it")
}

#[cfg(test)]
#[path = "verdict_tests.rs"]
mod tests;
