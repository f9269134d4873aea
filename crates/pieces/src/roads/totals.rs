//! The totals of all roads, and the true lengths of each road.

use std::{cmp::Reverse, collections::BTreeMap};

use corniche_geom::LatticeBounds;
use corniche_osm::{ExtractSummary, LeftOut, LeftOutReason, LeftOutWays};
use corniche_roads::{LossReason, Structure};
use corniche_spec::artifacts::{self, ArtifactKind};
use corniche_store::Artifacts;
use corniche_tileset::LeftOutRecord;
use serde::{Deserialize, Serialize};

use crate::{
    ExtractError,
    layers::blocks::{ListBlockWriter, block},
};

/// Roads in a block of [`ArtifactKind::RoadLengths`].
pub(crate) const BLOCK_ROADS: u64 = 1 << 16;

/// True lengths of a road.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct RoadLength {
    pub way_id: i64,
    /// The structure of the road.
    pub structure: Structure,
    /// The length of the whole road, micrometres.
    pub length_um: u64,
    /// The length outside the tiles of the data's rectangle, measured separately.
    pub outside_um: u64,
    /// The length inside these tiles, but outside the data's rectangle itself: in their padding. It
    /// is not counted under `outside_um`.
    pub padding_um: u64,
    /// The length outside the requested bounds; it is counted under nothing else.
    pub beyond_um: u64,
}

/// The totals of all roads. They are stored last: if they are in the store, so are all pieces,
/// lengths and defects.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RoadTotals {
    /// The number of roads: ordinals run from 0 to one less.
    pub roads: u64,
    /// The sum of their true lengths, micrometres.
    pub length_um: u64,
    /// Per class: number of roads and true length in micrometres.
    pub classes: Vec<(u64, u64)>,
    /// Counted defects by name.
    pub defects: BTreeMap<String, u64>,
    /// The content of the extract, and the ways that are not roads.
    pub extract: ExtractCounts,
    /// The rectangle around all roads.
    pub bounds: Option<LatticeBounds>,
}

/// The counts of an extract that a manifest records.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ExtractCounts {
    /// Values of `highway` that are not in the FRC table, with their numbers of ways.
    pub unknown_highways: Vec<(String, u64)>,
    /// Tags that were interpreted differently from how they are written, with their frequencies.
    pub tags_taken_otherwise: Vec<(String, u64)>,
    /// Blobs without ways of roads.
    pub blobs_passed_over: u64,
    /// Ways with the tag `highway`.
    pub highways_in: u64,
    /// Ways with a `highway` tag that are no roads here, by reason.
    pub highways_left_out: Vec<(String, u64)>,
    /// Ways that the FRC table excludes, by reason and `highway` value.
    pub left_out: Vec<LeftOutRecord>,
}

impl From<&ExtractSummary> for ExtractCounts {
    fn from(extract: &ExtractSummary) -> Self {
        let list = |counts: &BTreeMap<String, u64>| -> Vec<(String, u64)> {
            counts.iter().map(|(name, &count)| (name.clone(), count)).collect()
        };
        Self {
            unknown_highways: list(&extract.unknown_highways),
            tags_taken_otherwise: list(&extract.tags_taken_otherwise),
            blobs_passed_over: extract.blobs_passed_over,
            highways_in: extract.highway_ways,
            highways_left_out: left_out(extract),
            left_out: left_out_ways(extract),
        }
    }
}

/// Ways that are skipped, by reason, and within a reason the longest first.
fn left_out_ways(extract: &ExtractSummary) -> Vec<LeftOutRecord> {
    let ways = extract.left_out_ways.iter();
    let mut counts: Vec<(LeftOutReason, LeftOutRecord)> = ways
        .map(|((reason, highway), found)| {
            let (text, highway) = (reason.text().to_owned(), highway.clone());
            let LeftOutWays { ways, length_um } = *found;
            (*reason, LeftOutRecord { reason: text, highway, ways, length_um })
        })
        .collect();
    // The sort is stable, so values with equal lengths keep their order.
    counts.sort_by_key(|(reason, count)| (*reason, Reverse(count.length_um)));
    counts.into_iter().map(|(_, count)| count).collect()
}

fn left_out(extract: &ExtractSummary) -> Vec<(String, u64)> {
    let LeftOut { listed, class_off, unknown, area, duplicate, without_line } = extract.left_out;
    let by_reason = [
        (LossReason::Listed, listed),
        (LossReason::ClassOff, class_off),
        (LossReason::Unknown, unknown),
        (LossReason::Area, area),
        (LossReason::Duplicate, duplicate),
        (LossReason::WithoutLine, without_line),
    ];
    let some = by_reason.into_iter().filter(|&(_, ways)| ways > 0);
    some.map(|(reason, ways)| (reason.text().to_owned(), ways)).collect()
}

/// Stores the lengths of roads in the order of their ordinals.
pub(crate) fn lengths_writer(store: &dyn Artifacts) -> ListBlockWriter<'_, RoadLength> {
    ListBlockWriter::new(store, ArtifactKind::RoadLengths, BLOCK_ROADS as usize)
}

/// Reads the lengths of a block of `roads` roads.
pub(crate) fn lengths_of_block(
    store: &dyn Artifacts,
    number: u64,
    roads: u64,
) -> Result<Vec<RoadLength>, ExtractError> {
    let lengths: Vec<RoadLength> = block(store, ArtifactKind::RoadLengths, number)?;
    if lengths.len() as u64 != roads {
        let what = "it does not have one length for each of its roads";
        return Err(artifacts::damaged(ArtifactKind::RoadLengths.item(number), &what).into());
    }
    Ok(lengths)
}

#[cfg(test)]
#[path = "totals_tests.rs"]
mod tests;
