use std::{
    fs::{self, File},
    io::{Read, Seek},
};

use corniche_roads::Road;
use osmpbf::PrimitiveBlock;
use rayon::prelude::*;

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    assemble::{Assembled, assemble},
    blobs::{BlobFile, Decoding},
    location::Location,
    nodes::NodeTable,
    read_request::ReadRequest,
    versions::Versions,
    ways::Ways,
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
/// (`LocationsOnWays`). It is read twice: ways, then nodes; of the nodes only those of roads are
/// held: 17 bytes each, and 8 for every mention in a way.
/// `should_stop` is asked every few blobs.
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
/// | the ways, tags and node ids that are kept | 64 MiB and 64 times the size of the file; real extracts keep less than their own size | [`ReadOsmError::TooMuch`] |
/// | a tag's text | 255 characters, OSM's own | cut, [`Defect::LongText`] |
/// | tags of a way | 65 536 | damaged |
/// | comparisons in search of a way's self-crossings | 2 million, enough for the 2000 nodes that OSM allows | not all are found |
///
/// Blocks of up to 16 MiB unpacked, 64 MiB decoded and 16 MiB found are decoded side by side; larger ones, which
/// ordinary programs do not write, are decoded alone. So blobs take, together and beside what is kept, at most 192
/// MiB and four packed blobs per thread, and 1 GiB for one that is alone. Lookup and sorting of the nodes take at
/// most four times the room of what is kept. Time is proportional to the unpacked size, which deflate keeps below
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
    let path = request.path;
    let not_open = |source| ReadOsmError::Open { path: path.to_path_buf(), source };
    // Opening a pipe would block until something is written to it.
    let kind = fs::metadata(path).map_err(not_open)?.file_type();
    if !kind.is_file() {
        let found = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
        return Err(ReadOsmError::NotAFile { path: path.to_path_buf(), found });
    }
    let file = File::open(path).map_err(not_open)?;
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
    let decoding = Decoding { pool: request.pool, should_stop };
    let mut file = BlobFile::open(request.path, source)?;
    let (mut ways, blobs_with_nodes) = read_ways(&mut file, request, &decoding)?;
    ways.defects.drain(..).for_each(&mut *on_defect);

    let mut table = NodeTable::new(&ways, request.pool);
    locate_nodes(&mut file, &blobs_with_nodes, &mut ways, &mut table, &decoding)?;
    table.conflicts().for_each(&mut *on_defect);

    let mut summary = std::mem::take(&mut ways.summary);
    summary.nodes_needed = table.ids.len() as u64;
    summary.nodes_missing = table.places.missing() as u64;
    summary.blobs_passed_over = file.blobs_passed_over;
    summary.header_bounds_deg = file.header.bounds_deg;
    summary.generator = file.header.generator.take();
    summary.timestamp_s = file.header.timestamp_s;
    emit_roads(request, &ways, &table, should_stop, &mut |assembled| {
        let roads = assembled.roads.len() as u64;
        summary.roads += roads;
        *(if roads > 0 { &mut summary.road_ways } else { &mut summary.left_out.without_line }) += 1;
        assembled.defects.into_iter().for_each(&mut *on_defect);
        assembled.roads.into_iter().for_each(&mut *sink);
    })?;
    Ok(summary)
}

/// What may be kept of any file …
const HELD_BYTES: u64 = 64 << 20;
/// … and on top of it for each of its bytes.
const HELD_BYTES_PER_BYTE: u64 = 64;

/// Pass 1. Also returns which blobs contain nodes.
fn read_ways<R: Read + Seek>(
    file: &mut BlobFile<R>,
    request: &ReadRequest<'_>,
    decoding: &Decoding<'_>,
) -> Result<(Ways, Vec<usize>), ReadOsmError> {
    let mut ways = Ways::default();
    let mut versions = Versions::default();
    let mut blobs_with_nodes = Vec::new();
    let history = |reason| ReadOsmError::History { path: request.path.to_path_buf(), reason };
    let all: Vec<usize> = (0..file.len()).collect();
    let len_bytes = file.len_bytes();
    let most_bytes = HELD_BYTES.saturating_add(len_bytes.saturating_mul(HELD_BYTES_PER_BYTE));
    file.for_each(
        &all,
        decoding,
        Versions::scan,
        |block, most_bytes| Ways::scan(block, request.table, most_bytes),
        |number, versions_of_block, of_block| {
            versions.append(versions_of_block);
            if let Some(reason) = versions.history.take() {
                return Err(history(reason));
            }
            if of_block.summary.nodes_seen > 0 {
                blobs_with_nodes.push(number);
            }
            ways.append(of_block);
            if ways.held_bytes > most_bytes {
                return Err(ReadOsmError::TooMuch { path: request.path.to_path_buf(), len_bytes });
            }
            Ok(())
        },
    )?;
    ways.sort().map_err(history)?;
    Ok((ways, blobs_with_nodes))
}

/// Pass 2.
fn locate_nodes<R: Read + Seek>(
    file: &mut BlobFile<R>,
    blobs_with_nodes: &[usize],
    ways: &mut Ways,
    table: &mut NodeTable,
    decoding: &Decoding<'_>,
) -> Result<(), ReadOsmError> {
    let NodeTable { ids, places } = table;
    if ids.len() > 0 {
        let take = |_, (), found: Vec<(usize, Location)>| {
            for (number, location) in found {
                places.set(number, location);
            }
            Ok(())
        };
        let scan = |block: &PrimitiveBlock, most_bytes| ids.scan(block, most_bytes);
        file.for_each(blobs_with_nodes, decoding, |_| (), scan, take)?;
    }
    for (id, location) in std::mem::take(&mut ways.located) {
        if let Some(number) = ids.number(id) {
            places.set(number, location);
        }
    }
    Ok(())
}

/// Places and assembles the ways a few thousand at a time, so that the roads of a country never lie in memory at once.
fn emit_roads(
    request: &ReadRequest<'_>,
    ways: &Ways,
    table: &NodeTable,
    should_stop: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(Assembled),
) -> Result<(), ReadOsmError> {
    const WAYS_PER_TASK: usize = 256;
    const TASKS_PER_THREAD: usize = 8;
    let batch_ways = WAYS_PER_TASK * TASKS_PER_THREAD * request.pool.current_num_threads();
    for batch in ways.roads.chunks(batch_ways) {
        if should_stop() {
            return Err(ReadOsmError::Stopped { path: request.path.to_path_buf() });
        }
        let assembled: Vec<_> = request.pool.install(|| {
            batch
                .par_chunks(WAYS_PER_TASK)
                .map(|some| assemble(some, ways, table, request.place))
                .collect()
        });
        for some in assembled {
            some?.into_iter().for_each(&mut *take);
        }
    }
    Ok(())
}
