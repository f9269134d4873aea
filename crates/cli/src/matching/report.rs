//! The report of offsets: which offsets are reliable, a table by region, and a line per way
//! (CSV).

use std::fmt::Write as _;

use corniche_matching::{MatchReport, MatchedRoad, Offset};
use corniche_tileset::Manifest;

use crate::{
    defects::quoted,
    table::{Digits, Table},
};

/// The least confidence of a reliable offset; with less, or with fewer sampled points, the best
/// shift may be chance.
const LEAST_CONFIDENCE: f64 = 6.0;
const LEAST_PLACES: u64 = 200;
/// The least number of sampled points of a single road.
const LEAST_PLACES_OF_A_ROAD: u64 = 24;

/// Whether an offset is reliable.
pub(crate) fn is_sure(offset: &Offset, places: u64) -> bool {
    offset.confidence >= LEAST_CONFIDENCE && places >= LEAST_PLACES && !offset.is_at_edge
}

/// The offset across a road in metres, if it is reliable.
pub(crate) fn sure_across(road: &MatchedRoad) -> Option<f64> {
    let sure = road.across_offset.filter(|across| {
        across.confidence >= LEAST_CONFIDENCE
            && road.samples >= LEAST_PLACES_OF_A_ROAD
            && !across.is_at_edge
    });
    sure.map(|across| across.metres)
}

pub(crate) fn to_text(report: &MatchReport, manifest: &Manifest, digits: Digits) -> String {
    let mut text = format!(
        "Roads: {:.1} km, {} points compared, shifts of up to {:.1} m in steps of {:.2} m\n\n",
        report.length_m / 1e3,
        digits.count(report.samples),
        report.reach_m,
        report.step_m
    );
    if report.samples == 0 {
        text.push_str(
            "No road is on the image, or all roads are closer to its edge than the largest shift.\n",
        );
        return text;
    }
    let mut table =
        Table::new(["region centre", "points", "east, m", "north, m", "confidence", "reliable"]);
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
        write!(text, "\n{} of {} compared OSM ways have a reliable offset", across.len(), covered);
    if let Some(&median) = across.get(across.len() / 2) {
        let _ = write!(text, "; the median offset across the road is {median:.1} m");
    }
    let _ = write!(
        text,
        "\nEast and north: the shift to add to the roads. Reliable: the confidence is at least {LEAST_CONFIDENCE}, from at least {LEAST_PLACES} points, and the best shift is not \
         at the edge of the search (--radius). Corniche never moves roads: a package has the positions of the extract.\n"
    );
    text
}

const HEADINGS: &str = "way_id,class,name,ref,length_m,samples,east_m,north_m,confidence,across_m,across_confidence,bends,sure\n";

/// Ways sorted by id; offsets are empty where they are not reliable.
pub(crate) fn to_csv(report: &MatchReport) -> String {
    let mut text = HEADINGS.to_owned();
    for road in &report.roads {
        let attributes = &road.attributes;
        let number =
            |value: Option<f64>| value.map(|value| format!("{value:.2}")).unwrap_or_default();
        let (offset, across) = (road.offset.as_ref(), road.across_offset);
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{:.1},{},{},{},{},{},{},{:.3},{}",
            road.way_id,
            road.class.number(),
            quoted(&attributes.name),
            quoted(&attributes.reference),
            road.length_m,
            road.samples,
            number(offset.map(|offset| offset.east_m)),
            number(offset.map(|offset| offset.north_m)),
            number(offset.map(|offset| offset.confidence)),
            number(across.map(|across| across.metres)),
            number(across.map(|across| across.confidence)),
            road.bends,
            u8::from(sure_across(road).is_some()),
        );
    }
    text
}
