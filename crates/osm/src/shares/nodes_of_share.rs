//! Step *nodes*: pass 2 over a share of the blobs with nodes.

use corniche_store::Sorter;

use super::{
    blocks::{BlockReader, BlockWriter},
    kept::Kept,
    kept_records::PlaceRecord,
    ways_record::WaysRecord,
};
use crate::{
    ReadOsmError,
    extracts::Extracts,
    id_range::IdRange,
    kept_error::KeptError,
    locate_nodes::{bytes_per_node, read_places},
    looked::NodeBlob,
    nodes::{FoundNode, NodeIds, NodePlaces},
    read_request::ReadRequest,
    reading::{LayerCount, Reading, Step},
    records::{SoughtId, WayRecord},
    share::Share,
    sought_ids::SoughtIds,
    way_bytes::take_node_ids,
};

/// Reads a share of the blobs that have nodes and keeps the places of those nodes that a road way names. All ways must be kept already, in
/// as many shares. If the places are there already, nothing is read. `on_progress` counts the file's bytes once.
///
/// # Errors
/// As [`read_extract`](crate::read_extract) for what is wrong in these blobs; [`ReadOsmError::Kept`], also if ways are not there.
pub fn keep_nodes(
    request: &ReadRequest<'_>,
    share: Share,
    kept: Kept<'_>,
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    if kept.has_nodes(share) {
        return Ok(());
    }
    let mut file = Extracts::open(request)?;
    let len_bytes = file.len_bytes();
    let told = |done: u64, _| {
        if let Some(on_progress) = request.on_progress {
            on_progress(done.saturating_sub(len_bytes).min(len_bytes), len_bytes);
        }
    };
    let request = ReadRequest { on_progress: Some(&told), ..*request };
    let reading = Reading { request: &request, should_stop, len_bytes, layers: LayerCount::ROADS };
    let kept_failed = |source| reading.kept_failed(source);

    let records: Vec<WaysRecord> = Share::all(share.of())
        .map(|share| WaysRecord::get(kept, share))
        .collect::<Result<_, _>>()
        .map_err(kept_failed)?;
    let node_blobs: Vec<NodeBlob> =
        records.iter().flat_map(|record| record.node_blobs.iter().copied()).collect();
    let sizes: Vec<u64> = node_blobs.iter().map(|blob| file.size(blob.number)).collect();
    let own = &node_blobs[share.part_of(sizes.iter().copied())];
    let way_blocks: Vec<u32> = records.iter().map(|record| record.way_blocks).collect();
    drop(records);
    let mut blocks = BlockWriter::new(kept, kept.kinds.places, share);
    if let Some(range) = own.iter().map(|blob| blob.ids).reduce(IdRange::union) {
        let needed = needed_nodes(&reading, kept, &way_blocks, range)?;
        keep_places(&reading, &mut file, own, needed, &mut blocks)?;
    }
    let blocks = blocks.finish().map_err(kept_failed)?;
    reading.tell(Step::Nodes, 1, 1);
    put_blocks(kept, share, blocks).map_err(kept_failed)
}

/// Says that a share of nodes is complete, and how many blocks it has.
fn put_blocks(kept: Kept<'_>, share: Share, blocks: u32) -> Result<(), KeptError> {
    kept.put_record(kept.kinds.nodes_records, share, &blocks.to_le_bytes())
}

/// How many blocks a share of nodes has.
pub(crate) fn blocks_of(kept: Kept<'_>, share: Share) -> Result<u32, KeptError> {
    let bytes = kept.record(kept.kinds.nodes_records, "nodes", share)?;
    let bytes = <[u8; 4]>::try_from(bytes.as_slice());
    let damaged = KeptError::Damaged { share, what: "its record of nodes makes no sense" };
    bytes.map(u32::from_le_bytes).map_err(|_| damaged)
}

/// The nodes within a range that road ways of any share name, sorted; a node that is named twice comes twice.
fn needed_nodes<'a>(
    reading: &Reading<'a>,
    kept: Kept<'_>,
    way_blocks: &[u32],
    range: IdRange,
) -> Result<Sorter<'a, SoughtId>, ReadOsmError> {
    let failed = |error: std::io::Error| reading.failed(error);
    let shares = reading.shares();
    let mut needed = Sorter::new(reading.request.scratch, shares.ways + shares.mentions);
    let of = way_blocks.len() as u16;
    for (share, &blocks) in Share::all(of).zip(way_blocks) {
        let ways = BlockReader::<WayRecord>::new(kept, kept.kinds.ways, share, blocks);
        for (count, way) in (0..).zip(ways) {
            reading.check_stop_at(count)?;
            let way = way.map_err(failed)?;
            let mut last = None;
            take_node_ids(&mut &*way.bytes, |id| {
                let is_repeat = last.replace(id) == Some(id);
                if is_repeat || !range.contains(id) { Ok(()) } else { needed.push(SoughtId(id)) }
            })
            .map_err(failed)?;
        }
    }
    Ok(needed)
}

/// Finds the places of needed nodes in the blobs, as many nodes at a time as fit in memory, and writes them in order of id.
fn keep_places<R: std::io::Read + std::io::Seek>(
    reading: &Reading<'_>,
    file: &mut Extracts<R>,
    own: &[NodeBlob],
    needed: Sorter<'_, SoughtId>,
    blocks: &mut BlockWriter<'_, PlaceRecord>,
) -> Result<(), ReadOsmError> {
    let most =
        (reading.shares().ids / (bytes_per_node(reading.precedence(), 1) + 1)).max(1) as usize;
    let all_bytes: u64 = own.iter().map(|blob| file.size(blob.number)).sum();
    let failed = |error| reading.failed(error);
    let mut needed = SoughtIds::of(needed).map_err(failed)?;
    let mut done_bytes = 0;
    loop {
        let ids = needed.next(reading, most).map_err(|error| reading.failed(error))?;
        if ids.is_empty() {
            return Ok(());
        }
        let mut places = NodePlaces::new(ids.len(), reading.precedence());
        let mut is_seen = vec![false; ids.len()];
        let ids = NodeIds::new(ids);
        // A file that is not sorted is read anew for each chunk: then it is done when the last one begins.
        let on_bytes = |bytes: u64, _| reading.tell(Step::Nodes, done_bytes + bytes, all_bytes);
        let take = &mut |(number, location, version): FoundNode| {
            is_seen[number] = true;
            places.set(number, location, version);
        };
        let read = read_places(reading, file, own, &ids, &on_bytes, take);
        done_bytes += read.map_err(|error| reading.failed(error))?;
        for (number, &node_id) in
            ids.ids().iter().enumerate().filter(|&(number, _)| is_seen[number])
        {
            let (location, is_conflicting) =
                (places.location(number), places.is_conflicting(number));
            let version = places.version(number);
            let record = PlaceRecord { node_id, location, is_conflicting, version };
            blocks.push(&record).map_err(|source| reading.kept_failed(source))?;
        }
    }
}
