//! The list of offsets with one line for each way (CSV).

use std::fmt::Write as _;

use corniche_matching::MatchReport;

use super::sure::sure_across;
use crate::defects::quoted;

const HEADINGS: &str = "way_id,class,name,ref,length_m,samples,east_m,north_m,confidence,across_m,across_confidence,bends,sure\n";

/// Ways by their ids; offsets are empty where the image shows nothing.
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
