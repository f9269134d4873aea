//! Checks that apply to every blob, and limits for the data stored from a file.

use serde::{Deserialize, Serialize};

use crate::{
    ReadOsmError,
    block::{AuditedBlock, BlockWay},
    id_range::IdRange,
    reading::ExtractReading,
    versions::{History, Versions},
};

/// The maximum data stored from any file, in memory or in scratch space, bytes, …
const HELD_BYTES: u64 = 64 << 20;
/// … plus this for each byte of the file.
const HELD_BYTES_PER_BYTE: u64 = 64;

/// A blob with nodes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct NodeBlob {
    pub(crate) number: usize,
    pub(crate) ids: IdRange,
}

/// The facts that are collected of each block once, whatever else is read from it.
pub(crate) struct BlockSurvey {
    versions: Versions,
    ids: Option<IdRange>,
    pub(crate) has_relations: bool,
    has_ways: bool,
    nodes: u64,
}

impl BlockSurvey {
    pub(crate) fn scan(block: &AuditedBlock<'_>) -> Self {
        Self {
            versions: Versions::scan(block),
            ids: IdRange::scan(block),
            has_relations: block.has_relations(),
            has_ways: block.ways().next().is_some(),
            nodes: block.nodes_count(),
        }
    }

    /// Returns the facts of a block with ways alone, before any of them is added.
    pub(crate) fn of_ways() -> Self {
        let versions = Versions::default();
        Self { versions, ids: None, has_relations: false, has_ways: true, nodes: 0 }
    }

    /// Adds the next way.
    pub(crate) fn take_way(&mut self, way: &BlockWay<'_, '_>) {
        self.versions.take_way(way.id, way.info);
    }
}

/// The facts of all blobs that were scanned.
#[derive(Default)]
pub(crate) struct LookedAt {
    pub(crate) versions: Versions,
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// The numbers of the blobs with ways.
    pub(crate) with_ways: Vec<usize>,
    /// The number of nodes.
    pub(crate) nodes_seen: u64,
    pub(crate) has_relations: bool,
}

impl LookedAt {
    /// Adds the facts of a later blob of an extract. Fails if the blobs belong to more than one
    /// point in time.
    pub(crate) fn take(
        &mut self,
        reading: &ExtractReading<'_>,
        [file, number]: [usize; 2],
        looked: BlockSurvey,
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

    /// Adds the facts of later blobs.
    pub(crate) fn append(
        &mut self,
        reading: &ExtractReading<'_>,
        later: Self,
    ) -> Result<(), ReadOsmError> {
        append_versions(reading, &mut self.versions, later.versions)?;
        self.node_blobs.extend(later.node_blobs);
        self.has_relations |= later.has_relations;
        self.nodes_seen += later.nodes_seen;
        Ok(())
    }
}

/// Adds the versions of later blobs. Fails if earlier and later blobs belong to more than one point
/// in time.
pub(crate) fn append_versions(
    reading: &ExtractReading<'_>,
    versions: &mut Versions,
    later: Versions,
) -> Result<(), ReadOsmError> {
    versions.append(later);
    versions.history.take().map_or(Ok(()), |History { file, reason }| {
        Err(ReadOsmError::History { path: reading.request.extract(file), reason })
    })
}

/// Fails if the findings take more memory than a file of this size can plausibly contain.
pub(crate) fn check_held(
    reading: &ExtractReading<'_>,
    held_bytes: u64,
) -> Result<(), ReadOsmError> {
    let len_bytes = reading.len_bytes;
    if held_bytes > HELD_BYTES.saturating_add(len_bytes.saturating_mul(HELD_BYTES_PER_BYTE)) {
        return Err(ReadOsmError::TooMuch { path: reading.request.path.to_path_buf(), len_bytes });
    }
    Ok(())
}
