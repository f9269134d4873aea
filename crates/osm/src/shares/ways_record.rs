//! What is known of a share's blobs beside its ways: the record that says that the share is complete.

use corniche_store::{record_bytes, take_record};
use serde::{Deserialize, Serialize};

use super::kept::Kept;
use crate::{
    ExtractSummary, blobs::Header, kept_error::KeptError, looked::NodeBlob, share::Share,
    versions::Versions,
};

/// A share of ways.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WaysRecord {
    pub(crate) counts: ExtractSummary,
    /// The header of the whole file.
    pub(crate) header: Header,
    pub(crate) blobs_passed_over: u64,
    pub(crate) len_bytes: u64,
    /// Blobs of the share that have nodes, in the order of the file.
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// What is known of versions, without a reason why the file is a history: a share with one is never complete.
    pub(crate) versions: Versions,
    /// What its ways take, as it counts for the limit on all of them.
    pub(crate) held_bytes: u64,
    pub(crate) way_blocks: u32,
    pub(crate) located_blocks: u32,
    pub(crate) defect_blocks: u32,
}

impl WaysRecord {
    pub(crate) fn put(&self, kept: Kept<'_>, share: Share) -> Result<(), KeptError> {
        kept.put_record(kept.kinds.ways_records, share, &record_bytes(self))
    }

    pub(crate) fn get(kept: Kept<'_>, share: Share) -> Result<Self, KeptError> {
        let bytes = kept.record(kept.kinds.ways_records, "ways", share)?;
        let mut rest = &*bytes;
        let record = take_record(&mut rest).filter(|_| rest.is_empty());
        record.ok_or(KeptError::Damaged { share, what: "its record of ways makes no sense" })
    }
}
