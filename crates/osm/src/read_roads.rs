//! The roads of an extract, read without other layers.

use std::io::{Read, Seek};

use corniche_roads::Road;

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    layer_sink::Only,
    layers::Layers,
    read_extract::{read_extract, read_extract_from},
    read_request::ReadRequest,
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
    let mut roads = Only::new(sink);
    let layers = Layers { roads: Some(&mut roads), ..Layers::default() };
    read_extract(request, layers, on_defect, should_stop)?;
    Ok(roads.summary())
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
    let mut roads = Only::new(sink);
    let layers = Layers { roads: Some(&mut roads), ..Layers::default() };
    read_extract_from(source, request, layers, on_defect, should_stop)?;
    Ok(roads.summary())
}
