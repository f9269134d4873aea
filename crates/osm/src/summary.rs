//! How many ways an extract had, how many became roads, and why the others did not.

use std::collections::BTreeMap;

use corniche_roads::{FunctionalRoadClass, LossReason};
use serde::{Deserialize, Serialize};

/// What to show with anything made from an extract (`OpenStreetMap` Foundation, *Attribution Guidelines*, 2021).
pub const ATTRIBUTION: &str = "© OpenStreetMap contributors, ODbL 1.0";

/// What was in an extract and what became of it.
///
/// Each way is counted: `highway_ways = road_ways + left_out.total()`.
///
/// Written down is what is counted while ways are read; all else is known only later, or stands elsewhere.
///
/// A file that was cut off exactly between two blobs looks like a smaller file: the format has no mark for its end.
/// If nodes are lost that way, `nodes_missing` shows it; if only whole ways are lost, nothing shows it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ExtractSummary {
    /// Parts of the file of types that are not known, passed over as the format asks. Also what is left of a known part
    /// when its type was damaged: no checksum covers it.
    #[serde(skip)]
    pub blobs_passed_over: u64,
    /// Nodes in the file.
    pub nodes_seen: u64,
    /// Different nodes that the roads name.
    #[serde(skip)]
    pub nodes_needed: u64,
    /// How many of them have no position in the file.
    #[serde(skip)]
    pub nodes_missing: u64,
    /// Ways in the file.
    pub ways_seen: u64,
    /// Ways with a `highway` tag.
    pub highway_ways: u64,
    /// Ways that became roads.
    #[serde(skip)]
    pub road_ways: u64,
    /// Roads handed out: at least one per way of `road_ways`, more where missing nodes cut it.
    #[serde(skip)]
    pub roads: u64,
    /// Why the other ways with a `highway` tag did not become roads.
    pub left_out: LeftOut,
    /// Ways that the table leaves out: how many, and how long they are, by reason and `highway` value.
    #[serde(skip)]
    pub left_out_ways: BTreeMap<(LeftOutReason, String), LeftOutWays>,
    /// Per `highway` value that the table lists: its class and how many ways have it.
    pub highways: BTreeMap<String, HighwayCount>,
    /// Per `highway` value that the table does not list: how many ways have it.
    pub unknown_highways: BTreeMap<String, u64>,
    /// Tags of roads that are read as another value, such as "layer=1000" and "tunnel=culvert": on how many ways.
    pub tags_taken_otherwise: BTreeMap<String, u64>,
    /// The box that the file's header gives: west, south, east, north, degrees. `None` without one on Earth, and, like
    /// what else the header says, where the file is several in a row.
    #[serde(skip)]
    pub header_bounds_deg: Option<[f64; 4]>,
    /// The program that wrote the file, as its header says.
    #[serde(skip)]
    pub generator: Option<String>,
    /// How recent the data is, in seconds since 1970, as its header says.
    #[serde(skip)]
    pub timestamp_s: Option<i64>,
}

/// Ways with one `highway` value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct HighwayCount {
    /// The class of the ways; `None` when the table lists the value as no road.
    pub class: Option<FunctionalRoadClass>,
    /// How many ways.
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
    /// Too few nodes, or too few that the file holds and the projection can place; or they go to and fro over one place.
    #[serde(skip)]
    pub without_line: u64,
}

/// Why a table leaves a way out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LeftOutReason {
    /// Its class is off.
    ClassOff,
    /// The table lists its value as no road.
    Listed,
    /// The table does not know its value.
    Unknown,
    /// It is the outline of an area.
    Area,
}

impl LeftOutReason {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::ClassOff, Self::Listed, Self::Unknown, Self::Area];

    /// Why, in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::ClassOff => LossReason::ClassOff,
            Self::Listed => LossReason::Listed,
            Self::Unknown => LossReason::Unknown,
            Self::Area => LossReason::Area,
        }
        .text()
    }
}

/// Ways that are left out for one reason, with one `highway` value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LeftOutWays {
    /// How many ways.
    pub ways: u64,
    /// The true length of the ways in plan, micrometres; of areas that of the outline. Stretches beside missing nodes have none.
    pub length_um: u64,
}

impl LeftOut {
    /// All reasons together.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.listed + self.class_off + self.unknown + self.area + self.duplicate + self.without_line
    }
}
