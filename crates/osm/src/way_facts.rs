//! What is counted and told of one way, so that a way that is in two extracts counts once.

use std::io;

use serde::{Deserialize, Serialize};

use crate::{Defect, ExtractSummary, spool::damaged};

/// More than any way has: its defects name a value or two of a few hundred characters.
const MOST_BYTES: usize = 1 << 16;

/// What one way adds to the counts, and what is wrong with its tags.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct WayFacts {
    pub(crate) counts: ExtractSummary,
    pub(crate) defects: Vec<Defect>,
}

impl WayFacts {
    /// The facts as bytes, which are never empty.
    pub(crate) fn to_bytes(&self) -> Box<[u8]> {
        // Writing to a list cannot fail, and all of it can be written.
        let written = bincode::serde::encode_to_vec(self, bincode::config::standard());
        debug_assert!(written.is_ok(), "{self:?}");
        written.unwrap_or_default().into()
    }

    /// The facts that [`Self::to_bytes`] wrote.
    pub(crate) fn of_bytes(bytes: &[u8]) -> io::Result<Self> {
        let limited = bincode::config::standard().with_limit::<MOST_BYTES>();
        let (facts, _) =
            bincode::serde::decode_from_slice(bytes, limited).map_err(|_| damaged())?;
        Ok(facts)
    }
}
