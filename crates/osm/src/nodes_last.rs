//! Reads the nodes of an extract after its ways, including the nodes in the blobs before the first
//! way, which were skipped until then.
//!
//! This step finds out whether those blobs contain nodes alone. If they do not, the reading ends,
//! and starts again in the order of the extract.

use std::io::{Read, Seek};

use crate::{
    block::AuditedBlock,
    extracts::{Extracts, TOO_MUCH_FOUND},
    failed::Failed,
    locate_nodes::{NodeSource, ShareOfNodes, read_places, tell_nodes},
    looked::{BlockSurvey, LookedAt},
    nodes::{FoundNode, NodePlaces, listed_nodes},
    outlines::found_nodes::FoundNodes,
    reading::ExtractReading,
};

/// A source of node positions for an extract whose first blobs have not been read yet.
pub(crate) struct NodesLast<'a, 'b, R> {
    pub(crate) file: &'a mut Extracts<R>,
    /// The nodes of layers of points.
    pub(crate) points: &'a mut FoundNodes<'b>,
    /// The number of blobs that have not been read: the blobs before the ways.
    pub(crate) unread: usize,
    /// The facts of the blobs that were read, and finally of all blobs.
    pub(crate) looked_at: LookedAt,
    /// Whether there is anything other than nodes before the ways. Then the reading ends with an
    /// error that its caller ignores.
    pub(crate) is_out_of_order: bool,
}

impl<R: Read + Seek> NodesLast<'_, '_, R> {
    /// Reads all blobs that have not been read yet.
    fn read_first(
        &mut self,
        reading: &ExtractReading<'_>,
        ids: &[i64],
        on_bytes: &dyn Fn(u64),
        take: &mut dyn FnMut(FoundNode),
    ) -> Result<(), Failed> {
        let numbers: Vec<usize> = (0..std::mem::take(&mut self.unread)).collect();
        let points = self.points.scanned();
        let scan = |block: Vec<u8>, most_bytes| {
            let block = AuditedBlock::new(&block);
            let found = listed_nodes(ids, &block, most_bytes).ok_or(TOO_MUCH_FOUND)?;
            let points = points.scan(&block, most_bytes)?;
            Ok((BlockSurvey::scan(&block), block.has_others_than_nodes(), found, points))
        };
        let mut first = LookedAt::default();
        self.file.for_each_block(reading, &numbers, on_bytes, scan, |place, of_block| {
            let (looked, has_others, found, points): (_, _, Vec<FoundNode>, _) = of_block;
            if has_others {
                self.is_out_of_order = true;
                return Err(reading.stopped().into());
            }
            first.take(reading, place, looked)?;
            self.points.take(reading, place[0] as u32, points)?;
            found.into_iter().for_each(&mut *take);
            Ok(())
        })?;
        first.append(reading, std::mem::take(&mut self.looked_at))?;
        self.looked_at = first;
        Ok(())
    }
}

impl<R: Read + Seek> NodeSource for NodesLast<'_, '_, R> {
    fn read(
        &mut self,
        reading: &ExtractReading<'_>,
        ids: &[i64],
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), Failed> {
        let take = &mut |(number, location, version)| places.set(number, location, version);
        let (unread, read) = (self.unread, self.looked_at.node_blobs.len());
        let first: Vec<usize> = (0..unread).collect();
        let first_bytes = self.file.bytes_of(&first);
        if unread > 0 {
            let on_bytes = |bytes| tell_nodes(reading, share, bytes, first_bytes);
            self.read_first(reading, ids, &on_bytes, take)?;
        }
        // Blobs with ways and nodes follow the blobs that were read now.
        let rest = if unread > 0 { self.looked_at.node_blobs.len() - read } else { 0 };
        let on_bytes = |bytes, all_bytes| {
            tell_nodes(reading, share, first_bytes + bytes, first_bytes + all_bytes);
        };
        read_places(reading, self.file, &self.looked_at.node_blobs[rest..], ids, &on_bytes, take)?;
        Ok(())
    }
}
