//! What is known of a share's blobs beside its ways: the record that says that the share is complete.

use std::collections::BTreeMap;

use corniche_roads::FunctionalRoadClass;
use serde::{Deserialize, Serialize};

use super::kept::Kept;
use crate::{
    ExtractSummary, HighwayCount, blobs::Header, find_ways::NodeBlob, kept_error::KeptError,
    share::Share, versions::Versions,
};

/// A share of ways.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WaysRecord {
    pub(crate) counts: Counts,
    /// Of the whole file.
    pub(crate) header: Header,
    pub(crate) blobs_passed_over: u64,
    pub(crate) len_bytes: u64,
    /// Blobs of the share that have nodes, in the order of the file.
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// Without a reason why the file is a history: a share with one is never complete.
    pub(crate) versions: Versions,
    /// What its ways take, as it counts for the limit on all of them.
    pub(crate) held_bytes: u64,
    pub(crate) way_blocks: u32,
    pub(crate) located_blocks: u32,
    pub(crate) defect_blocks: u32,
}

/// What pass 1 counts, as [`ExtractSummary`] has it.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Counts {
    nodes_seen: u64,
    ways_seen: u64,
    highway_ways: u64,
    /// Listed, class off, unknown, area.
    left_out: [u64; 4],
    /// By value: class and ways.
    highways: BTreeMap<String, (Option<u8>, u64)>,
    unknown_highways: BTreeMap<String, u64>,
    tags_taken_otherwise: BTreeMap<String, u64>,
}

impl WaysRecord {
    pub(crate) fn put(&self, kept: Kept<'_>, share: Share) -> Result<(), KeptError> {
        let bytes = bincode::serde::encode_to_vec(self, bincode::config::standard());
        let bytes = bytes
            .map_err(|_| KeptError::Damaged { share, what: "its record cannot be written" })?;
        kept.put_record(kept.kinds.ways_records, share, &bytes)
    }

    pub(crate) fn get(kept: Kept<'_>, share: Share) -> Result<Self, KeptError> {
        let bytes = kept.record(kept.kinds.ways_records, "ways", share)?;
        match bincode::serde::decode_from_slice(&bytes, bincode::config::standard()) {
            Ok((record, used)) if used == bytes.len() => Ok(record),
            _ => Err(KeptError::Damaged { share, what: "its record of ways makes no sense" }),
        }
    }
}

impl From<ExtractSummary> for Counts {
    /// Of a summary as pass 1 leaves it.
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
