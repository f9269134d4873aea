//! Where shares keep what they find.

use std::{collections::BTreeSet, fmt};

use corniche_store::{Artifacts, Key};

use crate::{kept_error::KeptError, share::Share};

/// A store, and which kinds of its artifacts are for shares of one extract.
#[derive(Clone, Copy)]
pub struct Kept<'a> {
    /// Where artifacts are kept and read.
    pub store: &'a dyn Artifacts,
    /// The kinds under which artifacts are kept.
    pub kinds: KeptKinds,
}

/// A kind of artifacts for each thing that shares keep. All of them are different, and of no other use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeptKinds {
    /// Road ways, sorted by id.
    pub ways: u8,
    /// Places that ways give for their nodes, sorted by node.
    pub located: u8,
    /// Defects, in the order of the file.
    pub defects: u8,
    /// One for each share of ways that is complete: counts, and which blobs have nodes.
    pub ways_records: u8,
    /// Places of nodes, sorted by node.
    pub places: u8,
    /// One for each share of nodes that is complete.
    pub nodes_records: u8,
}

/// The item of a share's record.
const RECORD: u32 = 0;

impl Kept<'_> {
    /// The number of shares into which the whole extract was split, ways and nodes, if all of them are there; the smallest.
    #[must_use]
    pub fn complete(&self) -> Option<u16> {
        let items = self.store.items(self.kinds.nodes_records);
        let numbers: BTreeSet<u16> = items.into_iter().map(|item| (item >> 48) as u16).collect();
        numbers.into_iter().find(|&of| {
            Share::all(of).count() > 0
                && Share::all(of).all(|share| self.has_ways(share) && self.has_nodes(share))
        })
    }

    /// Whether any share is there.
    #[must_use]
    pub fn has_any(&self) -> bool {
        !self.store.items(self.kinds.ways_records).is_empty()
    }

    /// The first share of so many whose ways are not there.
    #[must_use]
    pub fn missing_ways(&self, of: u16) -> Option<Share> {
        Share::all(of).find(|&share| !self.has_ways(share))
    }

    pub(crate) fn has_ways(&self, share: Share) -> bool {
        self.store.has(key(self.kinds.ways_records, share, RECORD))
    }

    pub(crate) fn has_nodes(&self, share: Share) -> bool {
        self.store.has(key(self.kinds.nodes_records, share, RECORD))
    }

    /// Keeps a share's record, which says that all of the share is there.
    pub(crate) fn put_record(&self, kind: u8, share: Share, bytes: &[u8]) -> Result<(), KeptError> {
        Ok(self.store.put(key(kind, share, RECORD), bytes)?)
    }

    /// A share's record.
    pub(crate) fn record(
        &self,
        kind: u8,
        what: &'static str,
        share: Share,
    ) -> Result<Vec<u8>, KeptError> {
        let bytes = self.store.get(key(kind, share, RECORD))?;
        bytes.ok_or(KeptError::Missing { what, share })
    }
}

/// ```text
///  │ how many shares: 16 bits │ which: 16 bits │ block: 32 bits │
/// ```
pub(crate) fn key(kind: u8, share: Share, block: u32) -> Key {
    let item = u64::from(share.of()) << 48 | u64::from(share.number()) << 32 | u64::from(block);
    Key { kind, item }
}

impl fmt::Debug for Kept<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("kinds", &self.kinds).finish_non_exhaustive()
    }
}
