//! Step *nodes*: pass 2 over a share of the blobs with nodes.

use corniche_store::Sorter;

use super::{
    blocks::{BlockReader, ShareBlockWriter},
    kept::ShareStore,
    kept_records::PlaceRecord,
    read_step::read_step,
    ways_record::WaysRecord,
};
use crate::{
    ReadOsmError,
    extracts::Extracts,
    failed::Failed,
    id_range::IdRange,
    kept_error::KeptError,
    locate_nodes::{bytes_per_node, read_places},
    looked::NodeBlob,
    nodes::{FoundNode, NodePlaces},
    open_file::Extract,
    read_request::ReadRequest,
    reading::{ExtractReading, ReadingStep},
    records::{SoughtId, WayRecord},
    share::Share,
    sought_ids::SoughtIds,
    way_bytes::take_node_ids,
};

/// Reads a share of the blobs that contain nodes, and stores the positions of those nodes that a
/// road way references. All ways must already be stored, in the same number of shares. If the
/// positions are already stored, nothing is read. `on_progress` counts the file's bytes once.
///
/// # Errors
/// The errors of [`read_extract`](crate::read_extract) for these blobs, and [`ReadOsmError::Kept`],
/// also if ways are missing.
pub fn keep_nodes(
    request: &ReadRequest<'_>,
    share: Share,
    kept: ShareStore<'_>,
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    if kept.has_nodes(share) {
        return Ok(());
    }
    read_step(request, ReadingStep::Nodes, should_stop, |reading, file| {
        keep(reading, file, share, kept)
    })
}

fn keep(
    reading: &ExtractReading<'_>,
    file: &mut Extracts<Extract>,
    share: Share,
    kept: ShareStore<'_>,
) -> Result<(), Failed> {
    let records = WaysRecord::all(kept, share.count())?;
    let node_blobs: Vec<NodeBlob> =
        records.iter().flat_map(|record| record.node_blobs.iter().copied()).collect();
    let sizes: Vec<u64> = node_blobs.iter().map(|blob| file.size(blob.number)).collect();
    let own = &node_blobs[share.part_of(sizes.iter().copied())];
    let way_blocks: Vec<u32> = records.iter().map(|record| record.way_blocks).collect();
    drop(records);
    let mut blocks = ShareBlockWriter::new(kept, kept.kinds.places, share);
    if let Some(range) = own.iter().map(|blob| blob.ids).reduce(IdRange::union) {
        let needed = needed_nodes(reading, kept, &way_blocks, range)?;
        keep_places(reading, file, own, needed, &mut blocks)?;
    }
    let blocks = blocks.finish()?;
    reading.tell(ReadingStep::Nodes, 1, 1);
    Ok(put_blocks(kept, share, blocks)?)
}

/// Records that a share of nodes is complete, and its number of blocks.
fn put_blocks(kept: ShareStore<'_>, share: Share, blocks: u32) -> Result<(), KeptError> {
    kept.put_record(kept.kinds.nodes_records, share, &blocks.to_le_bytes())
}

/// Returns the number of blocks of a share of nodes.
pub(crate) fn blocks_of(kept: ShareStore<'_>, share: Share) -> Result<u32, KeptError> {
    let bytes = kept.record(kept.kinds.nodes_records, "nodes", share)?;
    let bytes = <[u8; 4]>::try_from(bytes.as_slice());
    let damaged = KeptError::Damaged { share, what: "its record of nodes is invalid" };
    bytes.map(u32::from_le_bytes).map_err(|_| damaged)
}

/// Returns the nodes within a range that road ways of any share reference, sorted; a node that is
/// referenced twice occurs twice.
fn needed_nodes<'a>(
    reading: &ExtractReading<'a>,
    kept: ShareStore<'_>,
    way_blocks: &[u32],
    range: IdRange,
) -> Result<Sorter<'a, SoughtId>, Failed> {
    let shares = reading.shares();
    let mut needed = Sorter::new(reading.request.scratch, shares.ways + shares.mentions);
    let of = way_blocks.len() as u16;
    for (share, &blocks) in Share::all(of).zip(way_blocks) {
        let ways = BlockReader::<WayRecord>::new(kept, kept.kinds.ways, share, blocks);
        for (count, way) in (0..).zip(ways) {
            reading.check_stop_at(count)?;
            let mut last = None;
            take_node_ids(&mut &*way?.bytes, |id| {
                let is_repeat = last.replace(id) == Some(id);
                if is_repeat || !range.contains(id) { Ok(()) } else { needed.push(SoughtId(id)) }
            })?;
        }
    }
    Ok(needed)
}

/// Finds the positions of needed nodes in the blobs, as many nodes at a time as fit in memory, and
/// writes them in order of ids.
fn keep_places(
    reading: &ExtractReading<'_>,
    file: &mut Extracts<Extract>,
    own: &[NodeBlob],
    needed: Sorter<'_, SoughtId>,
    blocks: &mut ShareBlockWriter<'_, PlaceRecord>,
) -> Result<(), Failed> {
    let most =
        (reading.shares().ids / (bytes_per_node(reading.precedence(), 1) + 1)).max(1) as usize;
    let all_bytes: u64 = own.iter().map(|blob| file.size(blob.number)).sum();
    let mut needed = SoughtIds::from_sorter(needed)?;
    let mut done_bytes = 0;
    loop {
        let ids = needed.next(reading, most)?;
        if ids.is_empty() {
            return Ok(());
        }
        let mut places = NodePlaces::new(ids.len(), reading.precedence());
        let mut is_seen = vec![false; ids.len()];
        // An unsorted file is read again for each chunk; the progress is complete when the last
        // chunk begins.
        let on_bytes =
            |bytes: u64, _| reading.tell(ReadingStep::Nodes, done_bytes + bytes, all_bytes);
        let take = &mut |(number, location, version): FoundNode| {
            is_seen[number] = true;
            places.set(number, location, version);
        };
        done_bytes += read_places(reading, file, own, &ids, &on_bytes, take)?;
        for (number, &node_id) in ids.iter().enumerate().filter(|&(number, _)| is_seen[number]) {
            blocks.push(&PlaceRecord {
                node_id,
                location: places.location(number),
                is_conflicting: places.is_conflicting(number),
                version: places.version(number),
            })?;
        }
    }
}
