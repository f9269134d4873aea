//! The summary at the end of a build, in a few lines: kept roads, skipped objects and how to
//! include them, the error, the size.

use std::path::Path;

use corniche_roads::LossReason;
use corniche_tileset::{LayerRecord, LeftOutRecord, Manifest, ManifestCounts, VerticalRecord};

use crate::{
    escaped::in_line,
    info::{beyond_extract, in_metres, reason_words, sides},
    table::{Digits, bytes, length},
};

/// The largest number of lines.
const MOST_LINES: usize = 10;
/// The largest number of characters of a line after its name of 13, if values of `highway` are
/// short.
const WIDTH: usize = 87;
/// The largest number of lines about skipped objects.
const MOST_LEFT_OUT: usize = 3;
/// The largest number of layers with a line each.
const MOST_LAYERS: usize = 3;
/// The largest number of values of `highway` in a line.
const MOST_VALUES: usize = 3;

/// The summary of a package that was written to `output`.
pub(crate) fn to_text(
    manifest: &Manifest,
    package_bytes: u64,
    output: &Path,
    digits: Digits,
) -> String {
    let counts = &manifest.counts;
    let mut end = layers(manifest, digits);
    end.extend([defects(counts, digits), datum(manifest)].into_iter().flatten());
    end.extend([error(manifest), size(manifest, package_bytes, digits), look(output)]);
    let mut lines = vec![roads(manifest, digits)];
    lines.extend(left_out(counts, digits, MOST_LEFT_OUT.min(MOST_LINES - 1 - end.len())));
    lines.extend(end);
    let lines: Vec<String> =
        lines.into_iter().map(|line| format!("{}\n", line.trim_end())).collect();
    lines.concat()
}

/// The line of kept roads.
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

/// Objects of the extract that the package does not have.
struct LeftOut {
    number: u64,
    length_um: u64,
    /// The kind of objects, and the reason why they were skipped.
    what: String,
    /// Values of `highway`, those with the longest ways first.
    values: Vec<String>,
    /// How to include them.
    remedy: Option<&'static str>,
}

impl LeftOut {
    /// One line with at most `most` values; with fewer, if they do not fit.
    fn to_text(&self, digits: Digits, most: usize) -> String {
        let Self { number, length_um, what, values, remedy } = self;
        // Kept roads may also lose parts; those are not counted.
        let number = if *number > 0 { digits.count(*number) + " " } else { String::new() };
        let mut shown = values[..most.min(values.len())].join(", ");
        if values.len() > most {
            shown += ", …";
        }
        let shown = if shown.is_empty() { shown } else { format!(" ({shown})") };
        let long = if *length_um > 0 { format!(", {}", length(*length_um)) } else { String::new() };
        let remedy = remedy.map(|remedy| format!("; {remedy}")).unwrap_or_default();
        let text = format!("{number}{what}{shown}{long}{remedy}");
        if most > 1 && text.chars().count() > WIDTH { self.to_text(digits, most - 1) } else { text }
    }
}

/// The skipped objects, the longest first, in at most `most` lines (two or more).
fn left_out(counts: &ManifestCounts, digits: Digits, most: usize) -> Vec<String> {
    let lost = counts.roads_lost.iter().filter(|loss| loss.length_um > 0).map(|loss| LeftOut {
        number: loss.roads,
        length_um: loss.length_um,
        what: format!(
            "{} {}",
            if loss.roads > 0 { "roads" } else { "parts of roads" },
            reason_words(&loss.reason)
        ),
        values: Vec::new(),
        remedy: remedy(&loss.reason),
    });
    let ways = counts.highways_left_out.iter().map(|(reason, number)| {
        let of_reason: Vec<_> =
            counts.left_out.iter().filter(|left_out| &left_out.reason == reason).collect();
        let value = |left_out: &&LeftOutRecord| in_line(&left_out.highway).into_owned();
        LeftOut {
            number: *number,
            length_um: of_reason.iter().map(|left_out| left_out.length_um).sum(),
            what: format!("ways, {}", reason_words(reason)),
            values: of_reason.iter().map(value).collect(),
            remedy: remedy(reason),
        }
    });
    let mut all: Vec<LeftOut> = lost.chain(ways).collect();
    // Objects that can be included come first. The sort is stable.
    all.sort_by_key(|one| (one.remedy.is_none(), std::cmp::Reverse(one.length_um)));
    let told = if all.len() > most { most - 1 } else { all.len() };
    let mut lines: Vec<String> =
        all[..told].iter().map(|one| one.to_text(digits, MOST_VALUES)).collect();
    if let rest @ [_, ..] = &all[told..] {
        let rest = LeftOut {
            number: rest.iter().map(|one| one.number).sum(),
            length_um: rest.iter().map(|one| one.length_um).sum(),
            what: "more, for other reasons".to_owned(),
            values: Vec::new(),
            remedy: Some("corniche info lists them"),
        };
        lines.push(rest.to_text(digits, 0));
    }
    let name = |index: usize| if index == 0 { "skipped" } else { "" };
    lines.iter().enumerate().map(|(index, line)| format!("{:<13}{line}", name(index))).collect()
}

/// How to include objects that were skipped for a reason, by its name in packages; `None` if they
/// are no roads, or were not requested.
fn remedy(reason: &str) -> Option<&'static str> {
    match LossReason::from_text(reason)? {
        LossReason::ClassOff => Some("--classes 0-8 includes them"),
        LossReason::Unknown => Some("--frc-table FILE adds them"),
        LossReason::OutsideData => Some("a DEM that covers them includes them"),
        LossReason::NoGround => Some("see --fill-voids"),
        LossReason::Listed
        | LossReason::Area
        | LossReason::Duplicate
        | LossReason::WithoutLine
        | LossReason::OutsideBounds => None,
    }
}

/// The objects of the layers: a line for each of a few layers, or one line for all of them.
fn layers(manifest: &Manifest, digits: Digits) -> Vec<String> {
    let kept = |layer: &LayerRecord| layer.counts.kept.iter().map(|of| of.objects).sum::<u64>();
    let layers = &manifest.layers;
    if layers.len() > MOST_LAYERS {
        let ids: Vec<&str> = layers.iter().map(|layer| layer.table.id.as_str()).collect();
        let kept = digits.count(layers.iter().map(kept).sum());
        let (shown, more) = (&ids[..MOST_LAYERS], ids.len() - MOST_LAYERS);
        let shown = shown.join(", ");
        return vec![format!("layers       {kept} objects in {shown} and {more} more")];
    }
    let line = |layer: &LayerRecord| {
        let missing = match beyond_extract(layer) {
            0 => String::new(),
            number => format!(", {} missing from the extract", digits.count(number)),
        };
        let [kept, objects] = [kept(layer), layer.counts.objects].map(|n| digits.count(n));
        format!("{:<12} {kept} of {objects} objects kept{missing}", layer.table.id)
    };
    layers.iter().map(line).collect()
}

/// The number of defects in the input.
fn defects(counts: &ManifestCounts, digits: Digits) -> Option<String> {
    let defects: Vec<&(String, u64)> = crate::info::defects(counts).collect();
    let number: u64 = defects.iter().map(|(_, number)| number).sum();
    let (name, most) = defects.iter().max_by_key(|(_, number)| number)?;
    let name = in_line(name);
    let kinds = if *most == number {
        name.into_owned()
    } else {
        let [most, rest] = [*most, number - most].map(|number| digits.count(number));
        format!("{name} ({most}), and {rest} of other kinds")
    };
    Some(format!("defects      {}: {kinds}; --defects FILE lists them", digits.count(number)))
}

/// A note about heights with an unknown datum.
fn datum(manifest: &Manifest) -> Option<String> {
    (manifest.vertical.datum == VerticalRecord::UNKNOWN_DATUM).then(|| {
        "datum        vertical datum unknown; exports of ellipsoidal heights need --dem-vertical-crs EPSG:N"
            .to_owned()
    })
}

/// The error of the finest level at the DEM's samples.
fn error(manifest: &Manifest) -> String {
    let Some(finest) = manifest.levels.last() else { return "error        none".to_owned() };
    let at_samples = &finest.sample_error;
    format!(
        "error        at most {} m at the DEM's samples, {} m RMS (limit: {} m)",
        in_metres(at_samples.max_m),
        in_metres(at_samples.rms_m),
        in_metres(finest.max_error_m)
    )
}

/// The size of the package.
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

/// The path of the package, and the commands for it.
fn look(output: &Path) -> String {
    let place = output.display();
    format!(
        "wrote        {place}. Inspect it with corniche info, show it with corniche view or serve"
    )
}

#[cfg(test)]
#[path = "verdict_tests.rs"]
mod tests;
