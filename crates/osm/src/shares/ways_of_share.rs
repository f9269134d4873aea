//! Step *ways*: pass 1 over the blobs of a share.

use corniche_store::{SortRecord, Sorter};

use super::{
    blocks::ShareBlockWriter, kept::ShareStore, read_step::read_step, ways_record::WaysRecord,
};
use crate::{
    ExtractDefect, ReadOsmError,
    extracts::Extracts,
    failed::Failed,
    find_ways::{FoundWays, WaysWanted},
    open_file::Extract,
    outlines::found_nodes::FoundNodes,
    outlines::judge::OwnTags,
    read_request::ReadRequest,
    reading::{ExtractReading, ReadingStep},
    share::Share,
};

/// Reads the blobs of a share, and stores the road ways among them, with all facts about these
/// blobs that [`read_kept_roads`](super::read_kept_roads) needs. If these are already stored,
/// nothing is read. `on_progress` counts the file's bytes once.
///
/// The list of blobs does not require reading the whole file, because the reader seeks from frame
/// to frame.
///
/// # Errors
/// The errors of [`read_extract`](crate::read_extract) for these blobs, and [`ReadOsmError::Kept`].
pub fn keep_ways(
    request: &ReadRequest<'_>,
    share: Share,
    kept: ShareStore<'_>,
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    if kept.has_ways(share) {
        return Ok(());
    }
    read_step(request, ReadingStep::Ways, should_stop, |reading, file| {
        keep(reading, file, share, kept)
    })
}

fn keep(
    reading: &ExtractReading<'_>,
    file: &mut Extracts<Extract>,
    share: Share,
    kept: ShareStore<'_>,
) -> Result<(), Failed> {
    let own: Vec<usize> = share.part_of(file.sizes()).collect();
    let mut defects = ShareBlockWriter::<ExtractDefect>::new(kept, kept.kinds.defects, share);
    // The code that finds defects cannot return errors, so the first failure is stored.
    let mut not_kept = None;
    let wanted = WaysWanted {
        roads: Some(reading.request.table),
        are_railways_wanted: reading.request.node_ids,
        own_tags: OwnTags::Ignored,
        way_ids: Vec::new(),
        is_first: true,
        bytes: [0, file.bytes_of(&own)],
    };
    let mut found = FoundWays::new(reading);
    let no_layers = (&mut [][..], &mut FoundNodes::new(reading, &[]));
    found.read(reading, file, &own, &wanted, no_layers, &mut |defect| {
        if not_kept.is_none() {
            not_kept = defects.push(&defect).err();
        }
    })?;
    not_kept.map_or(Ok(()), Err)?;
    let FoundWays { ways, located, mut summary, looked_at, held_bytes, .. } = found;
    summary.nodes_seen = looked_at.nodes_seen;
    let record = WaysRecord {
        counts: summary,
        header: file.take_header(),
        blobs_passed_over: file.blobs_passed_over(),
        len_bytes: reading.len_bytes,
        node_blobs: looked_at.node_blobs,
        versions: looked_at.versions,
        held_bytes,
        way_blocks: keep_sorted(reading, ways, kept, (kept.kinds.ways, share))?,
        located_blocks: keep_sorted(reading, located, kept, (kept.kinds.located, share))?,
        defect_blocks: defects.finish()?,
    };
    Ok(record.put(kept, share)?)
}

/// Stores records in their order; returns the number of blocks.
fn keep_sorted<T: SortRecord>(
    reading: &ExtractReading<'_>,
    records: Sorter<'_, T>,
    kept: ShareStore<'_>,
    (kind, share): (u8, Share),
) -> Result<u32, Failed> {
    let mut blocks = ShareBlockWriter::<T>::new(kept, kind, share);
    for (count, record) in (0..).zip(records.finish()?) {
        reading.check_stop_at(count)?;
        blocks.push(&record?)?;
    }
    Ok(blocks.finish()?)
}
