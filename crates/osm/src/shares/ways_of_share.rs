//! Step *ways*: pass 1 over the blobs of a share.

use std::io;

use super::{blocks::BlockWriter, kept::Kept, ways_record::WaysRecord};
use crate::{
    Defect, ReadOsmError,
    extracts::Extracts,
    find_ways::{FoundWays, WaysWanted},
    outlines::judge::OwnTags,
    read_request::ReadRequest,
    reading::{LayerCount, Reading},
    records::{Located, WayRecord},
    share::Share,
};

/// Reads the blobs of a share and keeps the road ways among them, with all that [`read_kept_roads`](super::read_kept_roads) must know of
/// these blobs. If that is there already, nothing is read. `on_progress` counts the file's bytes once.
///
/// The file is not read for the list of its blobs: their frames are sought one after the other.
///
/// # Errors
/// As [`read_extract`](crate::read_extract) for what is wrong in these blobs, and [`ReadOsmError::Kept`].
pub fn keep_ways(
    request: &ReadRequest<'_>,
    share: Share,
    kept: Kept<'_>,
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    if kept.has_ways(share) {
        return Ok(());
    }
    let mut file = Extracts::open(request)?;
    let len_bytes = file.len_bytes();
    let told = |done: u64, _| {
        if let Some(on_progress) = request.on_progress {
            on_progress(done.min(len_bytes), len_bytes);
        }
    };
    let request = ReadRequest { on_progress: Some(&told), ..*request };
    let reading = Reading { request: &request, should_stop, len_bytes, layers: LayerCount::ROADS };
    let failed = |error: io::Error| reading.failed(error);
    let kept_failed = |source| reading.kept_failed(source);

    let own: Vec<usize> = share.part_of(file.sizes()).collect();
    let mut defects = BlockWriter::<Defect>::new(kept, kept.kinds.defects, share);
    // Who finds defects cannot fail; the first failure is kept.
    let mut not_kept = None;
    let wanted = WaysWanted {
        roads: Some(request.table),
        own_tags: OwnTags::Ignored,
        way_ids: Vec::new(),
        is_first: true,
        bytes: [0, file.bytes_of(&own)],
    };
    let mut found = FoundWays::new(&reading);
    found
        .read(&reading, &mut file, &own, &wanted, &mut [], &mut |defect| {
            if not_kept.is_none() {
                not_kept = defects.push(&defect).err();
            }
        })
        .map_err(|error| reading.failed(error))?;
    not_kept.map_or(Ok(()), Err).map_err(kept_failed)?;
    let FoundWays { ways, located, mut summary, looked_at, held_bytes, .. } = found;
    summary.nodes_seen = looked_at.nodes_seen;

    let mut blocks = BlockWriter::<WayRecord>::new(kept, kept.kinds.ways, share);
    for (count, way) in (0..).zip(ways.finish().map_err(failed)?) {
        reading.check_stop_at(count)?;
        blocks.push(&way.map_err(failed)?).map_err(kept_failed)?;
    }
    let way_blocks = blocks.finish().map_err(kept_failed)?;
    let mut blocks = BlockWriter::<Located>::new(kept, kept.kinds.located, share);
    for (count, located) in (0..).zip(located.finish().map_err(failed)?) {
        reading.check_stop_at(count)?;
        blocks.push(&located.map_err(failed)?).map_err(kept_failed)?;
    }
    let record = WaysRecord {
        counts: summary,
        header: file.take_header(),
        blobs_passed_over: file.blobs_passed_over(),
        len_bytes,
        node_blobs: looked_at.node_blobs,
        versions: looked_at.versions,
        held_bytes,
        way_blocks,
        located_blocks: blocks.finish().map_err(kept_failed)?,
        defect_blocks: defects.finish().map_err(kept_failed)?,
    };
    record.put(kept, share).map_err(kept_failed)
}
