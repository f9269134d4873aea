//! The one reading of an extract: relations, ways and nodes once for all layers that are wanted.
//!
//! ```text
//!  │ nodes … nodes │ nodes and ways │ ways … │ relations … │     an extract that is sorted by kind
//!  └─── third ─────┴─────── second ──────────┴─── first ───┘     when what is read
//! ```
//!
//! Relations name ways, and ways name nodes, so what is read later is known to be wanted or not. Where the kinds begin is found by bisection,
//! which is right only if the extract is sorted by kind. Whether it is, is known when its nodes are read. Until then nothing is told, and if
//! it is not, it is read once more: all blobs for relations and objects, those with ways, those with nodes. Several extracts are read so
//! from the beginning. So a blob is unpacked once, but for those that the bisections look at. Without objects that ways outline, relations are read with the ways, and looked at for their versions alone.

use std::{
    cell::Cell,
    io::{Read, Seek},
};

use corniche_roads::FrcTable;

use crate::{
    Defect, ReadOsmError,
    areas::hand_out_areas,
    blobs::BlobFile,
    deferred::Deferred,
    extracts::{BlobOrder, Extracts},
    failed::Failed,
    find_ways::{FoundWays, WaysWanted},
    hand_out::{RoadWays, hand_out_roads},
    layers::Layers,
    left_out_lengths::LeftOutNodes,
    lines::hand_out_lines,
    locate_nodes::{NodeQuestions, locate_nodes, most_ids},
    nodes_last::NodesLast,
    number_nodes::{NumberedNodes, number_nodes},
    outlines::{
        find_objects::find_objects,
        found::{OutlineObjects, Outlines},
        judge::OwnTags,
        located_ways::LocatedWays,
        wanted::Wanted,
    },
    read_request::ReadRequest,
    reading::{LayerCount, Reading},
    sought_ids::SoughtIds,
};

/// Reads an extract once, and hands out all layers that are wanted, one after the other; each as [`Layers`] says, whatever other layers
/// are wanted.
///
/// What is wrong with a layer goes to `on_defect` between its beginning and its end, in an order that depends on the file alone, as what is
/// handed out does.
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
/// Areas and lines need relations, too: a sorted extract is read once, relations, ways, nodes; one that is not is read three times, for
/// objects, for ways, for nodes. Where the ids of the ways that relations name do not fit in memory, blobs with ways are read once more for
/// each part that fits. `should_stop` is asked every few blobs, and every 65 536 nodes or ways where these are sorted and joined.
///
/// # Memory
/// Ways and nodes of all layers take about [`ReadRequest::memory_bytes`] at most; what does not fit is sorted and joined in
/// [`ReadRequest::scratch`], where it takes some 30 bytes for each time that a road names a node, and once more as much for
/// each time that the sorters must merge their runs in several steps. On top come
/// - the blobs that are being decoded: see the limits;
/// - a few thousand ways that are handed out, made or read at a time, 100 bytes for each of their nodes;
/// - 48 bytes for each blob of the file, and the texts of the summary;
/// - a byte for each object that gives ways a class, and 16 bytes for each point of coastlines.
///
/// # Limits
/// These limits hold for every file, also for one that was made to do harm; what may be kept of a file holds for each layer:
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
/// compression that is not supported, or when `should_stop` says so. What was handed out before is to be forgotten then.
pub fn read_extract(
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let read = read_all(Extracts::open(request)?, request, layers, on_defect, should_stop);
    read.map_err(|failed| failed.of(request.path))
}

/// Reads the layers of one extract from any source of bytes, as [`read_extract`] does from a file. `request.path` only names it in
/// messages, and `request.others` are not read.
///
/// # Errors
/// As for [`read_extract`].
pub fn read_extract_from<R: Read + Seek>(
    source: R,
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let request = ReadRequest { others: &[], ..*request };
    let file = BlobFile::open(request.path, source)?;
    let read = read_all(Extracts::of(vec![file]), &request, layers, on_defect, should_stop);
    read.map_err(|failed| failed.of(request.path))
}

fn read_all<R: Read + Seek>(
    mut file: Extracts<R>,
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), Failed> {
    let most = Cell::new(0);
    let told = |done: u64, all: u64| {
        // What is read once more is told once.
        most.set(done.max(most.get()));
        if let Some(on_progress) = request.on_progress {
            on_progress(most.get(), all);
        }
    };
    let request = &ReadRequest { on_progress: Some(&told), ..*request };
    let of_areas = layers.areas.as_ref().map(|&(table, _)| Wanted::Areas(table));
    let of_lines = layers.lines.iter().map(|&(layer, _)| Wanted::Lines(layer));
    let wanted = LayersWanted {
        outlines: of_areas.into_iter().chain(of_lines).collect(),
        roads: layers.roads.is_some().then_some(request.table),
    };
    let reading =
        Reading { request, should_stop, len_bytes: file.len_bytes(), layers: wanted.count() };
    let order = file.seemingly_sorted(!wanted.outlines.is_empty());
    let in_order =
        if order.is_none() { None } else { Found::read(&reading, &mut file, order, &wanted)? };
    let found = match in_order {
        Some(found) => Some(found),
        None => Found::read(&reading, &mut file, BlobOrder::NONE, &wanted)?,
    };
    // Where nothing is taken for sorted, nothing can be out of order.
    let Some(Found { outlines, roads }) = found else { return Ok(()) };
    let mut outlines = outlines.into_iter();
    if let (Some((_, sink)), Some(found)) = (layers.areas, of_areas.and_then(|_| outlines.next())) {
        hand_out_areas(&reading, found, sink, on_defect)?;
    }
    let mut on_name = layers.line_names;
    for ((layer, sink), found) in layers.lines.into_iter().zip(outlines) {
        hand_out_lines(&reading, layer, found, (sink, on_defect), on_name.as_deref_mut())?;
    }
    if let (Some(sink), Some(mut found)) = (layers.roads, roads) {
        let header = file.take_header();
        let summary = &mut found.summary;
        summary.blobs_passed_over = file.blobs_passed_over();
        summary.header_bounds_deg = header.bounds_deg;
        summary.generator = header.generator;
        summary.timestamp_s = header.timestamp_s;
        hand_out_roads(&reading, found, sink, on_defect)?;
    }
    Ok(())
}

/// What is looked for.
struct LayersWanted<'w> {
    outlines: Vec<Wanted<'w>>,
    roads: Option<&'w FrcTable>,
}

impl LayersWanted<'_> {
    fn count(&self) -> LayerCount {
        let outlines = self.outlines.len() as u64;
        LayerCount { all: outlines + u64::from(self.roads.is_some()), outlines }
    }
}

/// All that an extract holds of some layers, with the places of nodes, to be handed out.
struct Found<'a> {
    outlines: Vec<(OutlineObjects<'a>, LocatedWays<'a>)>,
    roads: Option<RoadWays<'a>>,
}

impl<'a> Found<'a> {
    /// Reads the extract in this order; `None` if it is not in this order.
    fn read<R: Read + Seek>(
        reading: &Reading<'a>,
        file: &mut Extracts<R>,
        order: BlobOrder,
        wanted: &LayersWanted<'a>,
    ) -> Result<Option<Self>, Failed> {
        let mut outlines: Vec<Outlines<'_>> =
            wanted.outlines.iter().map(|&wanted| Outlines::new(reading, wanted)).collect();
        let mut of_roads = Deferred::new(reading.request.scratch, reading.shares().defects);
        let on_defect = &mut |defect| of_roads.push(&defect);
        let Some(found) = read_ways(reading, file, order, wanted, &mut outlines, on_defect)? else {
            return Ok(None);
        };
        let FoundWays { ways, located, mut summary, looked_at, nodes_named, .. } = found;

        let (mut numbered, mut questions) = (Vec::new(), Vec::new());
        let mut objects = Vec::new();
        for own in outlines {
            let (own, nodes) = own.number(reading)?;
            objects.push(own);
            numbered.push(nodes);
        }
        if wanted.roads.is_some() {
            let ways = ways.finish()?;
            let on_defect = &mut |defect| of_roads.push(&defect);
            let others: u64 =
                numbered.iter().map(|own: &NumberedNodes<'_>| own.mentions_count).sum();
            // Lengths are looked up where the places of all nodes are there at once.
            let fits = others + nodes_named <= most_ids(reading, numbered.len() as u64 + 1);
            let left_out = fits.then(|| LeftOutNodes::new(reading));
            numbered.push(number_nodes(reading, ways, &mut summary, on_defect, left_out)?);
        }
        let mut layers = Vec::new();
        for own in numbered {
            let NumberedNodes { ways, mentions, left_out, ways_count, mentions_count, duplicates } =
                own;
            let mentions = mentions.finish()?;
            questions.push(NodeQuestions { mentions, mentions_count, left_out });
            layers.push((ways.read(), ways_count, duplicates));
        }
        let mut nodes = NodesLast { file, unread: order.nodes, looked_at, is_out_of_order: false };
        let located = located.finish()?;
        let answers =
            locate_nodes(reading, &mut nodes, questions, located, &mut |layer, defect| {
                objects.get_mut(layer).map_or(&mut of_roads, |own| &mut own.defects).push(&defect);
            });
        if nodes.is_out_of_order {
            return Ok(None);
        }
        let nodes_seen = nodes.looked_at.nodes_seen;
        let mut layers = layers.into_iter().zip(answers?);
        let mut found = Self { outlines: Vec::new(), roads: None };
        for own in objects {
            let Some(((ways, count, _), nodes)) = layers.next() else { break };
            let stops = nodes.stops.finish()?;
            found.outlines.push((own, LocatedWays { ways, stops, count, last: None }));
        }
        if let Some((ways, nodes)) = layers.next() {
            summary.nodes_seen = nodes_seen;
            found.roads = Some(RoadWays::of(ways, nodes, summary, of_roads)?);
        }
        Ok(Some(found))
    }
}

/// Reads relations and ways; `None` if they are not in this order.
fn read_ways<'a, R: Read + Seek>(
    reading: &Reading<'a>,
    file: &mut Extracts<R>,
    order: BlobOrder,
    wanted: &LayersWanted<'_>,
    outlines: &mut [Outlines<'a>],
    on_defect: &mut dyn FnMut(Defect),
) -> Result<Option<FoundWays<'a>>, Failed> {
    let mut found = FoundWays::new(reading);
    let end = if outlines.is_empty() { file.len() } else { order.relations };
    let [relations, ways]: [Vec<usize>; 2] =
        [(end..file.len()).collect(), (order.nodes..end).collect()];
    // Where relations come last, objects are found with the ways that they name; else all objects come before all ways.
    let is_sorted = end > 0;
    let [relations_bytes, ways_bytes] =
        [&relations, if is_sorted { &ways } else { &relations }].map(|blobs| file.bytes_of(blobs));
    let before = find_objects(reading, file, &relations, outlines, !is_sorted, ways_bytes)?;
    let mut way_ids: Vec<SoughtIds<'_>> =
        outlines.iter_mut().map(|own| own.take_way_ids(reading)).collect::<Result<_, _>>()?;
    let most_ids = (reading.shares().way_ids / size_of::<i64>() as u64).max(1) as usize;
    let mut next_ids = || -> Result<Vec<Vec<i64>>, Failed> {
        way_ids.iter_mut().map(|ids| ids.next(reading, most_ids)).collect()
    };
    let rest_bytes = file.bytes_of(&before.with_ways);
    let all_bytes = relations_bytes + file.bytes_of(&ways) + rest_bytes;
    let mut wanted = WaysWanted {
        roads: wanted.roads,
        own_tags: if is_sorted { OwnTags::Kept } else { OwnTags::Ignored },
        way_ids: next_ids()?,
        is_first: true,
        bytes: [relations_bytes, all_bytes],
    };
    found.read(reading, file, &ways, &wanted, outlines, on_defect)?;
    if !outlines.is_empty() && found.looked_at.has_relations {
        return Ok(None);
    }
    wanted = WaysWanted { is_first: false, bytes: [all_bytes - rest_bytes, all_bytes], ..wanted };
    let rest = &before.with_ways;
    found.read(reading, file, rest, &wanted, outlines, on_defect)?;
    // Ways that relations name, where their ids did not fit in memory together.
    let blobs = [&found.looked_at.with_ways[..], rest].concat();
    loop {
        let way_ids = next_ids()?;
        if way_ids.iter().all(Vec::is_empty) {
            break;
        }
        let own_tags = if is_sorted { OwnTags::KeptBefore } else { OwnTags::Ignored };
        wanted = WaysWanted { roads: None, own_tags, way_ids, bytes: [all_bytes; 2], ..wanted };
        found.read(reading, file, &blobs, &wanted, outlines, on_defect)?;
    }
    found.looked_at.append(reading, before)?;
    Ok(Some(found))
}
