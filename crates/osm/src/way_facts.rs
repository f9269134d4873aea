//! What is counted and told of one way, so that a way that is in two extracts counts once.

use std::io;

use corniche_store::{record_bytes, take_record};
use serde::{Deserialize, Serialize};

use crate::{Defect, ExtractSummary, spool::damaged};

/// What one way adds to the counts, and what is wrong with its tags.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WayFacts {
    pub(crate) counts: ExtractSummary,
    pub(crate) defects: Vec<Defect>,
}

impl WayFacts {
    /// The facts as bytes, which are never empty.
    pub(crate) fn to_bytes(&self) -> Box<[u8]> {
        record_bytes(self).into()
    }

    /// The facts that [`Self::to_bytes`] wrote.
    pub(crate) fn of_bytes(mut bytes: &[u8]) -> io::Result<Self> {
        take_record(&mut bytes).ok_or_else(damaged)
    }
}
