//! The facts about a share's blobs besides its ways, in the record that marks the share as
//! complete.

use corniche_store::{record_bytes, take_record};
use serde::{Deserialize, Serialize};

use super::kept::ShareStore;
use crate::{
    ExtractSummary, blobs::ExtractHeader, kept_error::KeptError, looked::NodeBlob, share::Share,
    versions::Versions,
};

/// The record of a share of ways.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WaysRecord {
    pub(crate) counts: ExtractSummary,
    /// The header of the whole file.
    pub(crate) header: ExtractHeader,
    pub(crate) blobs_passed_over: u64,
    pub(crate) len_bytes: u64,
    /// The blobs of the share that contain nodes, in the order of the file.
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// The versions, without a reason why the file is a history: a share with such a reason is
    /// never complete.
    pub(crate) versions: Versions,
    /// The memory of its ways, as it counts for the limit on all ways.
    pub(crate) held_bytes: u64,
    pub(crate) way_blocks: u32,
    pub(crate) located_blocks: u32,
    pub(crate) defect_blocks: u32,
}

impl WaysRecord {
    pub(crate) fn put(&self, kept: ShareStore<'_>, share: Share) -> Result<(), KeptError> {
        kept.put_record(kept.kinds.ways_records, share, &record_bytes(self))
    }

    /// Returns the records of all shares.
    pub(crate) fn all(kept: ShareStore<'_>, of: u16) -> Result<Vec<Self>, KeptError> {
        Share::all(of).map(|share| Self::get(kept, share)).collect()
    }

    pub(crate) fn get(kept: ShareStore<'_>, share: Share) -> Result<Self, KeptError> {
        let bytes = kept.record(kept.kinds.ways_records, "ways", share)?;
        let mut rest = &*bytes;
        let record = take_record(&mut rest).filter(|_| rest.is_empty());
        record.ok_or(KeptError::Damaged { share, what: "its record of ways is invalid" })
    }
}
