use std::io::{Read, Seek};

use corniche_roads::Road;

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    blobs::BlobFile,
    find_ways::{FoundWays, find_ways},
    hand_out::hand_out,
    locate_nodes::{NodeQuestions, locate_nodes},
    number_nodes::{NumberedNodes, number_nodes},
    open_file::open_file,
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
/// The file may be in any order, with nodes dense or plain, ids negative, blobs raw or zlib, locations in nodes or in ways
/// (`LocationsOnWays`). It is read twice: ways, then nodes. Blobs whose nodes no road needs are read once. Of an extract that
/// is sorted by id, each blob is read at most twice, and once more for each time that the needed nodes fill a quarter of
/// [`ReadRequest::memory_bytes`], at 18 bytes each; one that is not sorted is read anew each time.
/// `should_stop` is asked every few blobs, and every 65 536 nodes or ways where these are sorted and joined.
///
/// # Memory
/// Ways and nodes of roads take about [`ReadRequest::memory_bytes`] at most; what does not fit is sorted and joined in
/// [`ReadRequest::scratch`], where it takes some 30 bytes for each time that a road names a node, and once more as much for
/// each time that the sorters must merge their runs in several steps. On top come
/// - the blobs that are being decoded: see the limits;
/// - a few thousand ways that are handed out at a time, 100 bytes for each of their nodes;
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
/// ordinary programs do not write, are decoded alone. So blobs take, together and beside what is kept, at most 192
/// MiB and four packed blobs per thread, and 1 GiB for one that is alone. A single way takes 100 bytes for each of its nodes, of
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
    let file = open_file(request.path)?;
    read_roads_from(file, request, sink, on_defect, should_stop)
}

/// Reads the roads of an extract from any source of bytes, as [`read_roads`] does from a file. `request.path` only names it in
/// messages.
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
    let mut file = BlobFile::open(request.path, source)?;
    let reading = Reading { request, should_stop, len_bytes: file.len_bytes() };
    let failed = |error| reading.scratch_failed(error);

    let FoundWays { ways, located, node_blobs, mut summary } =
        find_ways(&reading, &mut file, on_defect)?;
    let ways = ways.finish().map_err(failed)?;
    let numbered = number_nodes(&reading, ways, on_defect)?;
    let NumberedNodes { ways, mentions, ways_count, mentions_count, duplicates } = numbered;
    let questions = NodeQuestions {
        mentions: mentions.finish().map_err(failed)?,
        mentions_count,
        located: located.finish().map_err(failed)?,
        node_blobs: &node_blobs,
    };
    let nodes = locate_nodes(&reading, &mut file, questions, on_defect)?;

    summary.left_out.duplicate = duplicates;
    summary.nodes_needed = nodes.needed;
    summary.nodes_missing = nodes.missing;
    summary.blobs_passed_over = file.blobs_passed_over;
    summary.header_bounds_deg = file.header.bounds_deg;
    summary.generator = file.header.generator.take();
    summary.timestamp_s = file.header.timestamp_s;
    let stops = nodes.stops.finish().map_err(failed)?;
    hand_out(&reading, ways.read(), ways_count, stops, &mut |assembled| {
        let roads = assembled.roads.len() as u64;
        summary.roads += roads;
        *(if roads > 0 { &mut summary.road_ways } else { &mut summary.left_out.without_line }) += 1;
        assembled.defects.into_iter().for_each(&mut *on_defect);
        assembled.roads.into_iter().for_each(&mut *sink);
    })?;
    Ok(summary)
}
