//! Counts of pass 1 as they are written down.

use std::collections::BTreeMap;

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use crate::{ExtractSummary, HighwayCount};

/// What pass 1 counts, as [`ExtractSummary`] has it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Counts {
    nodes_seen: u64,
    ways_seen: u64,
    highway_ways: u64,
    /// Listed, class off, unknown, area.
    left_out: [u64; 4],
    /// Class and ways of each value.
    highways: BTreeMap<String, (Option<u8>, u64)>,
    unknown_highways: BTreeMap<String, u64>,
    tags_taken_otherwise: BTreeMap<String, u64>,
}

impl From<ExtractSummary> for Counts {
    /// The counts of a summary as pass 1 leaves it.
    fn from(summary: ExtractSummary) -> Self {
        let left_out = summary.left_out;
        let highway = |(value, count): (String, HighwayCount)| {
            (value, (count.class.map(FunctionalRoadClass::number), count.ways))
        };
        Self {
            nodes_seen: summary.nodes_seen,
            ways_seen: summary.ways_seen,
            highway_ways: summary.highway_ways,
            left_out: [left_out.listed, left_out.class_off, left_out.unknown, left_out.area],
            highways: summary.highways.into_iter().map(highway).collect(),
            unknown_highways: summary.unknown_highways,
            tags_taken_otherwise: summary.tags_taken_otherwise,
        }
    }
}

impl From<Counts> for ExtractSummary {
    fn from(counts: Counts) -> Self {
        let [listed, class_off, unknown, area] = counts.left_out;
        let highway = |(value, (class, ways)): (String, (Option<u8>, u64))| {
            (value, HighwayCount { class: class.and_then(FunctionalRoadClass::new), ways })
        };
        let mut summary = Self {
            nodes_seen: counts.nodes_seen,
            ways_seen: counts.ways_seen,
            highway_ways: counts.highway_ways,
            highways: counts.highways.into_iter().map(highway).collect(),
            unknown_highways: counts.unknown_highways,
            tags_taken_otherwise: counts.tags_taken_otherwise,
            ..Self::default()
        };
        let left_out = &mut summary.left_out;
        (left_out.listed, left_out.class_off) = (listed, class_off);
        (left_out.unknown, left_out.area) = (unknown, area);
        summary
    }
}
