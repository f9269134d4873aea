//! The roads of an extract are read and handed out in order of their ways.

use std::{
    cell::Cell,
    io::{Read, Seek},
};

use corniche_roads::Road;

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    blobs::BlobFile,
    deferred::Deferred,
    extracts::Extracts,
    find_ways::{FoundWays, find_ways},
    make_roads::{WaysAndNodes, make_roads},
    nodes_last::NodesLast,
    read_request::ReadRequest,
    reading::Reading,
};

/// Reads the roads of an extract and hands them to `sink`, in ascending order of way id.
///
/// - A way is one [`Road`], except where nodes in its middle are missing, out of range or outside the projection: it
///   is cut there, and each piece of two or more points is a road with the same way id, in the way's order. A gap is
///   never closed by a straight line.
/// - [`Road::fixed`] holds the ends and every node that two of the roads share or one visits twice.
/// - What is wrong with the data goes to `on_defect`, in an order that depends on the file alone, as the roads do.
/// - An extract without roads is no error: the summary says 0.
///
/// With [`ReadRequest::others`], several extracts are read as one:
/// - A node, or a way with a `highway` tag, that is in two of them counts once. Of two versions the newer one counts, else that of
///   the extract named first. Ways that differ are a [`Defect::ConflictingWay`], nodes with different places a
///   [`Defect::ConflictingNode`].
/// - A way without a `highway` tag is not looked at, so it does not replace an older version that has one.
/// - Each extract for itself must be none with several versions.
///
/// The file may be in any order, with nodes dense or plain, ids negative, blobs raw or zlib, locations in nodes or in ways
/// (`LocationsOnWays`). An extract that is sorted by kind is read once: ways, then nodes, but for a few blobs among which the first way is
/// sought. One that is not is read twice; if nodes come first and ways among them, blobs up to the first way are read once more, and
/// scratch space is taken once more. If the needed nodes do not
/// fit in a quarter of [`ReadRequest::memory_bytes`], at 18 bytes each, blobs with nodes are read anew for each part that fits: if they
/// are sorted by id, those with nodes of that part alone, so each blob once more, and once more where a part ends within it.
/// `should_stop` is asked every few blobs, and every 65 536 nodes or ways where these are sorted and joined.
///
/// # Memory
/// Ways and nodes of roads take about [`ReadRequest::memory_bytes`] at most; what does not fit is sorted and joined in
/// [`ReadRequest::scratch`], where it takes some 30 bytes for each time that a road names a node, and once more as much for
/// each time that the sorters must merge their runs in several steps. On top come
/// - the blobs that are being decoded: see the limits;
/// - a few thousand ways that are handed out, made or read at a time, 100 bytes for each of their nodes;
/// - 48 bytes for each blob of the file, and the texts of the summary.
///
/// # Limits
/// These limits hold for every file, also for one that was made to do harm:
///
/// | of | limit | beyond it |
/// |---|---|---|
/// | a blob header | 64 KiB | damaged |
/// | a blob, packed and unpacked | 32 MiB, the format's own; 1 MiB for the file's header | damaged |
/// | a block, decoded | 512 MiB | damaged |
/// | what is found in a block | 256 MiB | damaged |
/// | the ways, tags and node ids that are kept, in memory or in scratch space | 64 MiB and 64 times the size of the file; real extracts keep less than their own size | [`ReadOsmError::TooMuch`] |
/// | a tag's text | 255 characters, OSM's own | cut, [`Defect::LongText`] |
/// | tags of a way | 65 536 | damaged |
/// | comparisons in search of a way's self-crossings | 2 million, enough for the 2000 nodes that OSM allows | not all are found |
///
/// Blocks of up to 16 MiB unpacked, 64 MiB decoded and 16 MiB found are decoded side by side; larger ones, which
/// ordinary programs do not write, are decoded alone. So blobs take, together and beside what is kept, at most 256
/// MiB and eight packed blobs per thread, and 1 GiB for one that is alone. A single way takes 100 bytes for each of its nodes, of
/// which OSM allows 2000. In scratch space there is at most four times as much as is kept, for each step of the
/// merging. Time, without that of reading an unsorted file anew, is proportional to the unpacked size, which deflate keeps below
/// 1032 times that of the file.
///
/// # Errors
/// When the file cannot be read, is no `.osm.pbf`, is cut off or damaged, is a history file (its header says so, it marks an
/// object as deleted, or holds one in two versions, neighbours or roads), uses a feature or a
/// compression that is not supported, or when `should_stop` says so.
pub fn read_roads(
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<ExtractSummary, ReadOsmError> {
    read_all(Extracts::open(request)?, request, sink, on_defect, should_stop)
}

/// Reads the roads of one extract from any source of bytes, as [`read_roads`] does from a file. `request.path` only names it in
/// messages, and `request.others` are not read.
///
/// # Errors
/// As for [`read_roads`].
pub fn read_roads_from<R: Read + Seek>(
    source: R,
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<ExtractSummary, ReadOsmError> {
    let request = ReadRequest { others: &[], ..*request };
    let file = BlobFile::open(request.path, source)?;
    read_all(Extracts::of(vec![file]), &request, sink, on_defect, should_stop)
}

fn read_all<R: Read + Seek>(
    mut file: Extracts<R>,
    request: &ReadRequest<'_>,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<ExtractSummary, ReadOsmError> {
    let most = Cell::new(0);
    let told = |done: u64, all: u64| {
        // What is read once more is told once.
        most.set(done.max(most.get()));
        if let Some(on_progress) = request.on_progress {
            on_progress(most.get(), all);
        }
    };
    let request = &ReadRequest { on_progress: Some(&told), ..*request };
    let reading = Reading { request, should_stop, len_bytes: file.len_bytes() };
    let leading = file.leading_node_blobs();
    let read =
        if leading > 0 { read_once(&reading, &mut file, leading, sink, on_defect)? } else { None };
    let mut summary = match read {
        Some(summary) => summary,
        // Nothing comes before all ways, so nothing can be out of order.
        None => read_once(&reading, &mut file, 0, sink, on_defect)?.unwrap_or_default(),
    };
    summary.blobs_passed_over = file.blobs_passed_over();
    let header = file.take_header();
    summary.header_bounds_deg = header.bounds_deg;
    summary.generator = header.generator;
    summary.timestamp_s = header.timestamp_s;
    Ok(summary)
}

/// Reads so many first blobs, which seem to hold nodes alone, after all others. `None` if there is something else in them; then nothing
/// was handed on.
fn read_once<R: Read + Seek>(
    reading: &Reading<'_>,
    file: &mut Extracts<R>,
    leading: usize,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(Defect),
) -> Result<Option<ExtractSummary>, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let defects = Deferred::new(reading.request.scratch, reading.shares().defects, on_defect);
    if leading == 0 {
        defects.release().map_err(failed)?;
    }
    let mut on_defect = |defect| defects.push(defect);
    let others: Vec<usize> = (leading..file.len()).collect();
    let FoundWays { ways, located, node_blobs, mut summary, versions, .. } =
        find_ways(reading, file, &others, &mut on_defect)?;
    let mut nodes = NodesLast {
        file,
        unread: leading,
        node_blobs,
        versions,
        defects: &defects,
        nodes_seen: 0,
        is_out_of_order: false,
    };
    let found = WaysAndNodes {
        ways: ways.finish().map_err(failed)?,
        located: located.finish().map_err(failed)?,
        nodes: &mut nodes,
    };
    let made = make_roads(reading, found, &mut summary, sink, &mut on_defect);
    if nodes.is_out_of_order {
        return Ok(None);
    }
    made?;
    summary.nodes_seen += nodes.nodes_seen;
    Ok(Some(summary))
}
