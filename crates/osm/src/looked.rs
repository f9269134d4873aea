//! What is asked of every blob, whatever is read of it, and what may be kept of a file.

use serde::{Deserialize, Serialize};

use crate::{
    ReadOsmError,
    block::{Block, BlockWay},
    id_range::IdRange,
    reading::Reading,
    versions::{History, Versions},
};

/// What may be kept of any file, in memory or in scratch space, …
const HELD_BYTES: u64 = 64 << 20;
/// … and on top of it for each of its bytes.
const HELD_BYTES_PER_BYTE: u64 = 64;

/// A blob with nodes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct NodeBlob {
    pub(crate) number: usize,
    pub(crate) ids: IdRange,
}

/// What is asked of each block once, whatever else is read of it.
pub(crate) struct Looked {
    versions: Versions,
    ids: Option<IdRange>,
    pub(crate) has_relations: bool,
    has_ways: bool,
    nodes: u64,
}

impl Looked {
    pub(crate) fn scan(block: &Block<'_>) -> Self {
        Self {
            versions: Versions::scan(block),
            ids: IdRange::scan(block),
            has_relations: block.has_relations(),
            has_ways: block.ways().next().is_some(),
            nodes: block.nodes_count(),
        }
    }

    /// What is known of a block with ways alone, before it is told any of them.
    pub(crate) fn of_ways() -> Self {
        let versions = Versions::default();
        Self { versions, ids: None, has_relations: false, has_ways: true, nodes: 0 }
    }

    /// Takes the next way.
    pub(crate) fn take_way(&mut self, way: &BlockWay<'_, '_>) {
        self.versions.take_way(way.id, way.info);
    }
}

/// What is known of all blobs that were looked at.
#[derive(Default)]
pub(crate) struct LookedAt {
    pub(crate) versions: Versions,
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// Numbers of those with ways.
    pub(crate) with_ways: Vec<usize>,
    /// How many nodes there are.
    pub(crate) nodes_seen: u64,
    pub(crate) has_relations: bool,
}

impl LookedAt {
    /// Takes what a later blob of an extract holds; fails if the blobs are of more than one point in time.
    pub(crate) fn take(
        &mut self,
        reading: &Reading<'_>,
        [file, number]: [usize; 2],
        looked: Looked,
    ) -> Result<(), ReadOsmError> {
        append_versions(reading, &mut self.versions, looked.versions.of_file(file as u32))?;
        self.node_blobs.extend(looked.ids.map(|ids| NodeBlob { number, ids }));
        if looked.has_ways {
            self.with_ways.push(number);
        }
        self.nodes_seen += looked.nodes;
        self.has_relations |= looked.has_relations;
        Ok(())
    }

    /// Adds what is known of later blobs.
    pub(crate) fn append(
        &mut self,
        reading: &Reading<'_>,
        later: Self,
    ) -> Result<(), ReadOsmError> {
        append_versions(reading, &mut self.versions, later.versions)?;
        self.node_blobs.extend(later.node_blobs);
        self.has_relations |= later.has_relations;
        self.nodes_seen += later.nodes_seen;
        Ok(())
    }
}

/// Adds later blobs; fails if they and those before are of more than one point in time.
pub(crate) fn append_versions(
    reading: &Reading<'_>,
    versions: &mut Versions,
    later: Versions,
) -> Result<(), ReadOsmError> {
    versions.append(later);
    versions.history.take().map_or(Ok(()), |History { file, reason }| {
        Err(ReadOsmError::History { path: reading.request.extract(file), reason })
    })
}

/// Fails if what is found takes more than a file of this size can plausibly hold.
pub(crate) fn check_held(reading: &Reading<'_>, held_bytes: u64) -> Result<(), ReadOsmError> {
    let len_bytes = reading.len_bytes;
    if held_bytes > HELD_BYTES.saturating_add(len_bytes.saturating_mul(HELD_BYTES_PER_BYTE)) {
        return Err(ReadOsmError::TooMuch { path: reading.request.path.to_path_buf(), len_bytes });
    }
    Ok(())
}
