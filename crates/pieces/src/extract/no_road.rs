//! Why an extract gives no road, and what to do.

use std::{collections::BTreeMap, fmt};

use corniche_osm::{ExtractSummary, LeftOutReason};
use corniche_roads::{Classified, FrcTable};

/// So many `highway` values are named, the most frequent ones.
const MOST_VALUES: usize = 5;

/// Why an extract gives no road.
pub(crate) struct NoRoad {
    /// What its ways are instead.
    pub reason: String,
    /// How to have what it holds.
    advice: String,
}

impl fmt::Display for NoRoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.reason, self.advice)
    }
}

/// Why an extract gives no road under a table of classes.
pub(crate) fn why(extract: &ExtractSummary, table: &FrcTable) -> NoRoad {
    const RIGHT_ONE: &str = "is it the right extract?";
    let ways = extract.highway_ways;
    let because = |reason: String, advice: &str| NoRoad { reason, advice: advice.to_owned() };
    if ways == 0 {
        let others = "--areas default and --boundaries on take other things of it";
        let reason = "none of its ways has a highway tag".to_owned();
        return because(reason, &format!("{RIGHT_ONE} {others}"));
    }
    let off = values_left_out(extract, LeftOutReason::ClassOff);
    if !off.is_empty() {
        let classes = listed(&off, |value| class_of(value, table));
        let reason = format!("its ways are of classes that are off: {classes}");
        return because(reason, "--classes 0-8 takes every class");
    }
    let unknown = values_left_out(extract, LeftOutReason::Unknown);
    if !unknown.is_empty() {
        let (name, values) = (table.name(), listed(&unknown, |_| None));
        let reason = format!("FRC table {name:?} does not know its highway values: {values}");
        return because(reason, "give a table that does with --frc-table");
    }
    let reasons = LeftOutReason::ALL.into_iter().filter_map(|reason| {
        let values = values_left_out(extract, reason);
        let text = || format!("{} ({})", reason.text(), listed(&values, |_| None));
        (!values.is_empty()).then(text)
    });
    let reasons: Vec<String> = reasons.collect();
    if reasons.is_empty() {
        let reason = format!("no line is left of its {ways} ways with a highway tag");
        return because(reason, "their nodes are missing, so fetch the extract again");
    }
    let reason = format!("its {ways} ways with a highway tag are none: {}", reasons.join(", "));
    because(reason, RIGHT_ONE)
}

/// The `highway` values of ways that were left out for a reason, the most frequent first, with how many ways have them.
fn values_left_out(extract: &ExtractSummary, reason: LeftOutReason) -> Vec<(&str, u64)> {
    let ways = extract.left_out_ways.iter().filter(|((own, _), _)| *own == reason);
    let mut values: Vec<(&str, u64)> =
        ways.map(|((_, value), found)| (value.as_str(), found.ways)).collect();
    // The sort keeps the order of values that are equally frequent.
    values.sort_by_key(|&(_, ways)| std::cmp::Reverse(ways));
    values
}

/// Values with their numbers of ways, by class where they have one: "8 (path 12, footway 3)".
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
