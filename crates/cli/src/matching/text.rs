//! The table of offsets by region, for people.

use std::fmt::Write as _;

use corniche_matching::{MatchReport, Offset};
use corniche_tileset::Manifest;

use super::sure::{LEAST_CONFIDENCE, LEAST_PLACES, is_sure, sure_across};
use crate::table::{Digits, Table};

pub(crate) fn to_text(report: &MatchReport, manifest: &Manifest, digits: Digits) -> String {
    let mut text = format!(
        "Roads: {:.1} km, {} places compared, shifts of up to {:.1} m in steps of {:.2} m\n\n",
        report.length_m / 1e3,
        digits.count(report.samples),
        report.reach_m,
        report.step_m
    );
    if report.samples == 0 {
        text.push_str(
            "No road lies on the image, or all lie nearer to its edge than the shifts reach.\n",
        );
        return text;
    }
    let mut table =
        Table::new(["region, middle", "places", "east, m", "north, m", "confidence", "shown"]);
    let mut row = |name: String, samples: u64, offset: Option<&Offset>| {
        let number = |value: fn(&Offset) -> f64| {
            offset.map(|offset| format!("{:.1}", value(offset))).unwrap_or_default()
        };
        table.row([
            name,
            digits.count(samples),
            number(|offset| offset.east_m),
            number(|offset| offset.north_m),
            number(|offset| offset.confidence),
            match offset {
                Some(offset) if is_sure(offset, samples) => "yes",
                Some(offset) if offset.is_at_edge => "at the edge",
                _ => "no",
            }
            .to_owned(),
        ]);
    };
    for region in &report.regions {
        let [lon, lat] = manifest.coordinates.wgs84_from_working(region.center_m);
        row(format!("{lon:.4},{lat:.4}"), region.samples, region.offset.as_ref());
    }
    row("all".to_owned(), report.samples, report.all.as_ref());
    text.push_str(&table.to_text());
    let sure = report.roads.iter().filter_map(sure_across);
    let mut across: Vec<f64> = sure.map(f64::abs).collect();
    let covered = report.roads.iter().filter(|road| road.samples > 0).count();
    across.sort_unstable_by(f64::total_cmp);
    // Writing to a String cannot fail.
    let _ =
        write!(text, "\n{} of {} ways on the image are shown by themselves", across.len(), covered);
    if let Some(&median) = across.get(across.len() / 2) {
        let _ = write!(text, "; median offset across them {median:.1} m");
    }
    let _ = write!(
        text,
        "\nEast and north: what must be added to the roads. Shown: the confidence is {LEAST_CONFIDENCE} or more, of at least {LEAST_PLACES} places, and the best shift is not the \
         farthest one. Roads are not moved: those of a package are those of the extract.\n"
    );
    text
}
