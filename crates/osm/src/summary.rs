//! Counts of the ways of an extract: how many became roads, and why the others did not.

use std::collections::BTreeMap;

use corniche_roads::{FunctionalRoadClass, LossReason};
use serde::{Deserialize, Serialize};

/// The attribution to display with anything made from an extract (`OpenStreetMap` Foundation,
/// *Attribution Guidelines*, 2021).
pub const ATTRIBUTION: &str = "© OpenStreetMap contributors, ODbL 1.0";

/// The contents of an extract, and what became of them.
///
/// Each way is counted: `highway_ways = road_ways + left_out.total()`.
///
/// Only the counts that are known while ways are read are serialised. All others are known later,
/// or are stored elsewhere.
///
/// A file that was truncated exactly between two blobs looks like a smaller file, because the
/// format has no mark for its end. If nodes are lost in that way, `nodes_missing` shows it; if only
/// whole ways are lost, nothing shows it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ExtractSummary {
    /// Blobs of unknown types, which are skipped as the format requires. A known blob whose type
    /// was corrupted counts, too, because no checksum covers the type.
    #[serde(skip)]
    pub blobs_passed_over: u64,
    /// Nodes in the file.
    pub nodes_seen: u64,
    /// Different nodes that roads reference.
    #[serde(skip)]
    pub nodes_needed: u64,
    /// The number of these nodes that have no position in the file.
    #[serde(skip)]
    pub nodes_missing: u64,
    /// Ways in the file.
    pub ways_seen: u64,
    /// Ways with a `highway` tag.
    pub highway_ways: u64,
    /// Ways that became roads.
    #[serde(skip)]
    pub road_ways: u64,
    /// Delivered roads: at least one per way of `road_ways`, more if missing nodes cut the way.
    #[serde(skip)]
    pub roads: u64,
    /// Why the other ways with a `highway` tag did not become roads.
    pub left_out: LeftOut,
    /// The number and the length of ways that the table skips, by reason and `highway` value.
    #[serde(skip)]
    pub left_out_ways: BTreeMap<(LeftOutReason, String), LeftOutWays>,
    /// The class and the number of ways, for each `highway` value that the table lists.
    pub highways: BTreeMap<String, HighwayCount>,
    /// The number of ways, for each `highway` value that the table does not list.
    pub unknown_highways: BTreeMap<String, u64>,
    /// The number of ways, for each tag of roads that is interpreted as another value, such as
    /// "layer=1000" and "tunnel=culvert".
    pub tags_taken_otherwise: BTreeMap<String, u64>,
    /// The bounding box in the file's header: west, south, east, north, degrees. `None` if the
    /// header has no box on Earth, or, like the other fields of the header, if the file consists of
    /// several concatenated files.
    #[serde(skip)]
    pub header_bounds_deg: Option<[f64; 4]>,
    /// The program that wrote the file, as its header says.
    #[serde(skip)]
    pub generator: Option<String>,
    /// The age of the data according to the file's header, in seconds since 1970.
    #[serde(skip)]
    pub timestamp_s: Option<i64>,
}

/// Ways with one `highway` value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct HighwayCount {
    /// The class of the ways; `None` if the table lists the value as no road.
    pub class: Option<FunctionalRoadClass>,
    /// The number of ways.
    pub ways: u64,
}

/// Ways with a `highway` tag that did not become roads, by reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LeftOut {
    /// The table lists the value as no road.
    pub listed: u64,
    /// The class is off.
    pub class_off: u64,
    /// The table does not know the value.
    pub unknown: u64,
    /// Ways with `area=yes`.
    pub area: u64,
    /// Another way of the file has the same id.
    #[serde(skip)]
    pub duplicate: u64,
    /// Too few nodes are in the file and can be converted to the working CRS, or the way goes to
    /// and fro over one place.
    #[serde(skip)]
    pub without_line: u64,
}

corniche_roads::listed! {
    /// The reason why a table skips a way.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum LeftOutReason {
        /// Its class is off.
        ClassOff = LossReason::ClassOff.text(),
        /// The table lists its value as no road.
        Listed = LossReason::Listed.text(),
        /// The table does not know its value.
        Unknown = LossReason::Unknown.text(),
        /// It is the outline of an area.
        Area = LossReason::Area.text(),
    }

    /// Returns the reason, in words.
    pub fn text() -> &'static str;
}

/// Ways that are skipped for one reason, with one `highway` value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LeftOutWays {
    /// The number of ways.
    pub ways: u64,
    /// The true length of the ways in plan, micrometres; for areas, the length of the outline.
    /// Stretches next to missing nodes have no length.
    pub length_um: u64,
}

impl LeftOut {
    /// Returns the total over all reasons.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.listed + self.class_off + self.unknown + self.area + self.duplicate + self.without_line
    }
}
