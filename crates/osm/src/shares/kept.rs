//! The store for the results of shares.

use std::{collections::BTreeSet, fmt};

use corniche_store::{ArtifactKey, Artifacts};

use crate::{kept_error::KeptError, share::Share};

/// A store, and the kinds of its artifacts that belong to the shares of one extract.
#[derive(Clone, Copy)]
pub struct ShareStore<'a> {
    /// The store of the artifacts.
    pub store: &'a dyn Artifacts,
    /// The kinds of the artifacts.
    pub kinds: KeptKinds,
}

/// One kind of artifacts for each kind of data that shares store. All kinds are different, and have
/// no other use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeptKinds {
    /// Road ways, sorted by id.
    pub ways: u8,
    /// Positions that ways give for their nodes, sorted by node.
    pub located: u8,
    /// Defects, in the order of the file.
    pub defects: u8,
    /// One record for each complete share of ways: its counts, and the blobs that contain nodes.
    pub ways_records: u8,
    /// Positions of nodes, sorted by node.
    pub places: u8,
    /// One record for each complete share of nodes.
    pub nodes_records: u8,
}

/// The item number of a share's record.
const RECORD: u32 = 0;

impl ShareStore<'_> {
    /// Returns the number of shares into which the extract was split, if all shares of ways and of
    /// nodes are present. Of several such numbers, returns the smallest.
    #[must_use]
    pub fn complete(&self) -> Option<u16> {
        let items = self.store.items(self.kinds.nodes_records);
        let numbers: BTreeSet<u16> = items.into_iter().map(|item| (item >> 48) as u16).collect();
        numbers.into_iter().find(|&of| {
            Share::all(of).count() > 0
                && Share::all(of).all(|share| self.has_ways(share) && self.has_nodes(share))
        })
    }

    /// Whether any share is present.
    #[must_use]
    pub fn has_any(&self) -> bool {
        !self.store.items(self.kinds.ways_records).is_empty()
    }

    /// Returns the first share, of `of` shares, whose ways are missing.
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

    /// Stores a share's record, which says that the share is complete.
    pub(crate) fn put_record(&self, kind: u8, share: Share, bytes: &[u8]) -> Result<(), KeptError> {
        Ok(self.store.put(key(kind, share, RECORD), bytes)?)
    }

    /// Returns a share's record.
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
pub(crate) fn key(kind: u8, share: Share, block: u32) -> ArtifactKey {
    let item = u64::from(share.count()) << 48 | u64::from(share.number()) << 32 | u64::from(block);
    ArtifactKey { kind, item }
}

impl fmt::Debug for ShareStore<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Kept").field("kinds", &self.kinds).finish_non_exhaustive()
    }
}
