//! Reads the nodes of an extract after its ways: also those of the blobs before the first way, which were left for it.
//!
//! Whether these hold nodes alone is seen here: where they do not, the reading ends, and begins again in the extract's own order.

use std::io::{Read, Seek};

use crate::{
    ReadOsmError,
    blobs::Decoding,
    block::Block,
    extracts::{Extracts, TOO_MUCH_FOUND},
    id_range::IdRange,
    locate_nodes::{NodeSource, ShareOfNodes, read_places, tell_nodes},
    looked::{NodeBlob, append_versions},
    nodes::{FoundNode, NodeIds, NodePlaces},
    reading::Reading,
    versions::Versions,
};

/// Places of nodes from an extract of which the first blobs were not read yet.
pub(crate) struct NodesLast<'a, R> {
    pub(crate) file: &'a mut Extracts<R>,
    /// How many blobs were not read: those before the ways.
    pub(crate) unread: usize,
    /// Blobs with nodes: of those that were read, then of all.
    pub(crate) node_blobs: Vec<NodeBlob>,
    /// What versions the objects of the blobs have that were read.
    pub(crate) versions: Versions,
    /// How many nodes were in the blobs that were not read before.
    pub(crate) nodes_seen: u64,
    /// Whether there was something else than nodes before the ways. Then the reading ends with an error that means nothing.
    pub(crate) is_out_of_order: bool,
}

/// What is found in a block before the ways.
struct OfBlock {
    versions: Versions,
    ids: Option<IdRange>,
    nodes: u64,
    has_others: bool,
    found: Vec<FoundNode>,
}

impl OfBlock {
    fn scan(message: &[u8], ids: &NodeIds, most_bytes: u64) -> Option<Self> {
        let block = Block::new(message);
        Some(Self {
            versions: Versions::scan(&block),
            ids: IdRange::scan(&block),
            nodes: block.nodes_count(),
            has_others: block.has_others_than_nodes(),
            found: ids.scan(&block, most_bytes)?,
        })
    }
}

impl<R: Read + Seek> NodesLast<'_, R> {
    /// Reads the blobs that were not read yet, all of them.
    fn read_first(
        &mut self,
        reading: &Reading<'_>,
        ids: &NodeIds,
        on_bytes: &dyn Fn(u64),
        take: &mut dyn FnMut(FoundNode),
    ) -> Result<(), ReadOsmError> {
        let Self { file, node_blobs, nodes_seen, is_out_of_order, .. } = self;
        let numbers: Vec<usize> = (0..std::mem::take(&mut self.unread)).collect();
        let (pool, should_stop) = (reading.request.pool, reading.should_stop);
        let decoding = Decoding { pool, should_stop, on_bytes };
        let scan = |block: Vec<u8>, most_bytes| {
            Ok(OfBlock::scan(&block, ids, most_bytes).ok_or(TOO_MUCH_FOUND)?)
        };
        let (mut first, mut versions) = (Vec::new(), Versions::default());
        file.for_each_block(&numbers, &decoding, scan, |[_, number], of_block: OfBlock| {
            if of_block.has_others {
                *is_out_of_order = true;
                return Err(reading.stopped());
            }
            append_versions(reading, &mut versions, of_block.versions)?;
            *nodes_seen += of_block.nodes;
            first.extend(of_block.ids.map(|ids| NodeBlob { number, ids }));
            of_block.found.into_iter().for_each(&mut *take);
            Ok(())
        })?;
        append_versions(reading, &mut versions, std::mem::take(&mut self.versions))?;
        first.append(node_blobs);
        *node_blobs = first;
        Ok(())
    }
}

impl<R: Read + Seek> NodeSource for NodesLast<'_, R> {
    fn read(
        &mut self,
        reading: &Reading<'_>,
        ids: &NodeIds,
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), ReadOsmError> {
        let take = &mut |(number, location, version)| places.set(number, location, version);
        let (unread, read) = (self.unread, self.node_blobs.len());
        let first: Vec<usize> = (0..unread).collect();
        let first_bytes = self.file.bytes_of(&first);
        if unread > 0 {
            let on_bytes = |bytes| tell_nodes(reading, share, bytes, first_bytes);
            self.read_first(reading, ids, &on_bytes, take)?;
        }
        // Blobs with ways and nodes come after those that were read now.
        let rest = if unread > 0 { self.node_blobs.len() - read } else { 0 };
        let on_bytes = |bytes, all_bytes| {
            tell_nodes(reading, share, first_bytes + bytes, first_bytes + all_bytes);
        };
        read_places(reading, self.file, &self.node_blobs[rest..], ids, &on_bytes, take)?;
        Ok(())
    }
}
