//! The counts and defects of one way, so that a way that is in two extracts counts once.

use std::io;

use corniche_store::{record_bytes, take_record};
use serde::{Deserialize, Serialize};

use crate::{ExtractDefect, ExtractSummary, spool::damaged};

/// The counts that one way adds, and the defects of its tags.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WayFacts {
    pub(crate) counts: ExtractSummary,
    pub(crate) defects: Vec<ExtractDefect>,
}

impl WayFacts {
    /// Returns the facts as bytes, which are never empty.
    pub(crate) fn to_bytes(&self) -> Box<[u8]> {
        record_bytes(self).into()
    }

    /// Reads the facts that [`Self::to_bytes`] wrote.
    pub(crate) fn of_bytes(mut bytes: &[u8]) -> io::Result<Self> {
        take_record(&mut bytes).ok_or_else(damaged)
    }
}
