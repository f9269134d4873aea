//! Why an extract has no roads, and what the user can do.

use std::collections::BTreeMap;

use corniche_osm::{ExtractSummary, LeftOutReason};
use corniche_roads::{Classified, FrcTable};

/// The number of `highway` values that the message lists, the most frequent first.
const MOST_VALUES: usize = 5;

/// Why an extract has no roads.
pub(crate) struct NoRoad {
    /// Why its ways are not roads.
    pub reason: String,
    /// How the user can include its content.
    pub advice: String,
}

/// Finds the reason why an extract has no roads under a table of classes.
pub(crate) fn why(extract: &ExtractSummary, table: &FrcTable) -> NoRoad {
    const RIGHT_ONE: &str = "check that it is the right extract";
    let ways = extract.highway_ways;
    let because = |reason: String, advice: &str| NoRoad { reason, advice: advice.to_owned() };
    if ways == 0 {
        let reason = "none of its ways has a highway tag".to_owned();
        let others = "pass --layers areas,boundaries to convert its other objects";
        return because(reason, &format!("{RIGHT_ONE}, or {others}"));
    }
    let off = values_left_out(extract, LeftOutReason::ClassOff);
    if !off.is_empty() {
        let classes = listed(&off, |value| class_of(value, table));
        let reason = format!("its ways have classes that are switched off: {classes}");
        return because(reason, "--classes 0-8 includes every class");
    }
    let unknown = values_left_out(extract, LeftOutReason::Unknown);
    if !unknown.is_empty() {
        let (name, values) = (table.name(), listed(&unknown, |_| None));
        let reason = format!("FRC table {name:?} does not list its highway values: {values}");
        return because(reason, "pass a table that lists them with --frc-table");
    }
    let reasons = LeftOutReason::ALL.into_iter().filter_map(|reason| {
        let values = values_left_out(extract, reason);
        let text = || format!("{} ({})", reason.text(), listed(&values, |_| None));
        (!values.is_empty()).then(text)
    });
    let reasons: Vec<String> = reasons.collect();
    if reasons.is_empty() {
        let reason = format!("none of its {ways} ways with a highway tag forms a line");
        return because(
            reason,
            "their nodes are missing from the file, so download the extract again",
        );
    }
    let reason =
        format!("none of its {ways} ways with a highway tag is a road: {}", reasons.join(", "));
    because(reason, RIGHT_ONE)
}

/// The `highway` values of ways that were skipped for a reason, the most frequent first, with the
/// number of their ways.
fn values_left_out(extract: &ExtractSummary, reason: LeftOutReason) -> Vec<(&str, u64)> {
    let ways = extract.left_out_ways.iter().filter(|((own, _), _)| *own == reason);
    let mut values: Vec<(&str, u64)> =
        ways.map(|((_, value), found)| (value.as_str(), found.ways)).collect();
    // The sort is stable, so equally frequent values keep their order.
    values.sort_by_key(|&(_, ways)| std::cmp::Reverse(ways));
    values
}

/// Lists values with their numbers of ways, grouped by class if they have one: "8 (path 12, footway
/// 3)".
fn listed(values: &[(&str, u64)], class_of: impl Fn(&str) -> Option<u8>) -> String {
    let mut by_class: BTreeMap<Option<u8>, Vec<String>> = BTreeMap::new();
    for (value, ways) in values.iter().take(MOST_VALUES) {
        by_class.entry(class_of(value)).or_default().push(format!("{value} {ways}"));
    }
    if values.len() > MOST_VALUES {
        by_class.entry(None).or_default().push("…".to_owned());
    }
    let text = |(class, values): (Option<u8>, Vec<String>)| match class {
        Some(class) => format!("{class} ({})", values.join(", ")),
        None => values.join(", "),
    };
    by_class.into_iter().rev().map(text).collect::<Vec<_>>().join(", ")
}

fn class_of(highway: &str, table: &FrcTable) -> Option<u8> {
    match table.classify(&[("highway", highway)]) {
        Classified::Road(class) | Classified::NotShown(class) => Some(class.number()),
        Classified::NotARoad(_) | Classified::Unknown(_) => None,
    }
}
