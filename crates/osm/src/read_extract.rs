//! Reads an extract once for all requested layers: relations, ways and nodes.
//!
//! ```text
//!  │ nodes … nodes │ nodes and ways │ ways … │ relations … │     an extract that is sorted by type
//!  └─── third ─────┴─────── second ──────────┴─── first ───┘     the order of reading
//! ```
//!
//! Relations reference ways, and ways reference nodes. So the reader knows of each object that
//! comes later whether it is needed. Bisection finds where each type begins, which is correct only
//! if the extract is sorted by type. Whether it is sorted is known once its nodes are read. Nothing
//! is delivered before. If the extract is not sorted, it is read again: all blobs for relations and
//! objects, then those with ways, then those with nodes. Several extracts are read in this way from
//! the beginning. So each blob of a sorted extract is unpacked once, except for the blobs that the
//! bisections inspect. If no layer needs objects with outlines, relations are read with the ways,
//! only to check their versions.

use std::{
    cell::Cell,
    io::{Read, Seek},
};

use corniche_roads::FrcTable;

use crate::{
    ExtractDefect, ReadOsmError,
    areas::hand_out_areas,
    blobs::BlobFile,
    deferred::Deferred,
    extracts::{BlobOrder, Extracts},
    failed::Failed,
    find_ways::{FoundWays, WaysWanted},
    hand_out::{RoadWays, hand_out_roads},
    layers::{LayerReceiver, Layers},
    left_out_lengths::LeftOutNodes,
    lines::hand_out_lines,
    locate_nodes::{locate_nodes, most_ids},
    nodes_last::NodesLast,
    number_nodes::{NumberedNodes, NumberedWays, number_nodes},
    outlines::{
        find_objects::find_objects,
        found::{OutlineObjects, Outlines},
        found_nodes::FoundNodes,
        judge::OwnTags,
        located_ways::LocatedWays,
        wanted::WantedObjects,
    },
    points::hand_out_points,
    read_request::ReadRequest,
    reading::{ExtractReading, LayerCount},
    sought_ids::SoughtIds,
};

/// Reads an extract once, and delivers all requested layers, one after the other. [`Layers`]
/// describes the content of each layer, which does not depend on the other requested layers.
///
/// Defects of a layer go to `on_defect` between the layer's beginning and its end. The order of
/// defects and of delivered objects depends on the file alone.
///
/// With [`ReadRequest::others`], several extracts are read as one:
/// - A node, or a way with a `highway` tag, that is in two of them counts once. Of two versions the
///   newer one counts; otherwise the extract that is named first counts. Ways that differ cause an
///   [`ExtractDefect::ConflictingWay`], nodes with different positions an
///   [`ExtractDefect::ConflictingNode`].
/// - A way without a `highway` tag is not considered, so it does not replace an older version that
///   has one.
/// - Each single extract must not contain several versions of an object.
///
/// The file may be in any order. Nodes may be dense or plain, ids negative, blobs raw or zlib, and
/// locations in nodes or in ways (`LocationsOnWays`). An extract that is sorted by type is read
/// once: ways, then nodes, and also a few blobs in which the first way is searched. An unsorted
/// extract is read twice. If nodes come first and ways are among them, the blobs up to the first
/// way are read again, and scratch space is used again. If the needed nodes do not fit in a quarter
/// of [`ReadRequest::memory_bytes`], at 18 bytes each, blobs with nodes are read again for each
/// part that fits. If these blobs are sorted by id, only the blobs with nodes of that part are
/// read: each blob once more, and once more if a part ends within it.
///
/// Areas, lines, and points inside closed ways also need relations. A sorted extract is read once:
/// relations, ways, nodes. An unsorted one is read three times: for objects, for ways, for nodes.
/// If the ids of the ways that relations reference do not fit in memory, blobs with ways are read
/// again for each part that fits. `should_stop` is called every few blobs, and every 65 536 nodes
/// or ways while these are sorted and joined.
///
/// # Memory
/// Ways and nodes of all layers take about [`ReadRequest::memory_bytes`] at most. What does not fit
/// is sorted and joined in [`ReadRequest::scratch`], where it takes some 30 bytes for each
/// reference from a road to a node, and as much again each time that the sorters must merge their
/// runs in several steps. In addition, there are
/// - the blobs that are being decoded: see the limits;
/// - a few thousand ways that are delivered, assembled or read at a time, 100 bytes for each of
///   their nodes;
/// - 48 bytes for each blob of the file, and the texts of the summary;
/// - 32 bytes for each relation that gives ways a class, and 16 bytes for each point of coastlines.
///
/// # Limits
/// These limits apply to every file, including malicious ones; the limit of stored data applies to
/// each layer:
///
/// | subject | limit | above the limit |
/// |---|---|---|
/// | a blob header | 64 KiB | corrupt |
/// | a blob, packed and unpacked | 32 MiB, the format's own; 1 MiB for the file's header | corrupt |
/// | a block, decoded | 512 MiB | corrupt |
/// | findings in a block | 256 MiB | corrupt |
/// | the stored ways, tags and node ids, in memory or in scratch space | 64 MiB and 64 times the size of the file; real extracts need less than their own size | [`ReadOsmError::TooMuch`] |
/// | a tag's text | 255 characters, OSM's own | cut, [`ExtractDefect::LongText`] |
/// | tags of a way | 65 536 | corrupt |
/// | comparisons in the search for a way's self-crossings | 2 million, enough for the 2000 nodes that OSM allows | not all are found |
///
/// Blocks of up to 16 MiB unpacked, 64 MiB decoded and 16 MiB of findings are decoded in parallel.
/// Larger blocks, which ordinary programs do not write, are decoded alone. So, in addition to the
/// stored data, all blobs together take at most 256 MiB and eight packed blobs per thread, and 1
/// GiB for one that is decoded alone. A single way takes 100 bytes for each of its nodes, of which
/// OSM allows 2000. Scratch space contains at most four times the stored data, for each step of the
/// merging. The time, except for rereading an unsorted file, is proportional to the unpacked size,
/// which deflate keeps below 1032 times the size of the file.
///
/// # Errors
/// When the file cannot be read, is not `.osm.pbf`, or is truncated or corrupt; when it is a
/// history file (its header says so, it marks an object as deleted, or it contains two versions of
/// an object, next to each other or as roads); when it uses a feature or a compression that is not
/// supported; or when `should_stop` returns true. The caller must then discard what was delivered
/// before.
pub fn read_extract(
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let read = read_all(Extracts::open(request)?, request, layers, on_defect, should_stop);
    read.map_err(|failed| failed.at_path(request.path))
}

/// Reads the layers of one extract from any source of bytes, as [`read_extract`] does from a file.
/// `request.path` is only the name in messages, and `request.others` are not read.
///
/// # Errors
/// The same as for [`read_extract`].
pub fn read_extract_from<R: Read + Seek>(
    source: R,
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let request = ReadRequest { others: &[], ..*request };
    let file = BlobFile::open(request.path, source)?;
    let read = read_all(Extracts::from_files(vec![file]), &request, layers, on_defect, should_stop);
    read.map_err(|failed| failed.at_path(request.path))
}

fn read_all<R: Read + Seek>(
    mut file: Extracts<R>,
    request: &ReadRequest<'_>,
    layers: Layers<'_>,
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), Failed> {
    let most = Cell::new(0);
    let told = |done: u64, all: u64| {
        // Bytes that are read again are reported once.
        most.set(done.max(most.get()));
        if let Some(on_progress) = request.on_progress {
            on_progress(most.get(), all);
        }
    };
    let request = &ReadRequest { on_progress: Some(&told), ..*request };
    let wanted = LayersWanted {
        outlines: layers
            .layers
            .iter()
            .map(|(table, receiver)| WantedObjects { table, geometry: receiver.geometry() })
            .collect(),
        roads: layers.roads.is_some().then_some(request.table),
    };
    let reading = ExtractReading {
        request,
        should_stop,
        len_bytes: file.len_bytes(),
        layers: wanted.count(),
    };
    let order = file.seemingly_sorted(!wanted.outlines.is_empty());
    let mut found = None;
    if order != BlobOrder::NONE {
        found = LayerObjects::read(&reading, &mut file, order, &wanted)?;
    }
    if found.is_none() {
        found = LayerObjects::read(&reading, &mut file, BlobOrder::NONE, &wanted)?;
    }
    // If nothing is assumed to be sorted, nothing can be out of order.
    let Some(LayerObjects { outlines, roads }) = found else { return Ok(()) };
    for ((table, receiver), found) in layers.layers.into_iter().zip(outlines) {
        match receiver {
            LayerReceiver::Areas(sink) => hand_out_areas(&reading, found, sink, on_defect)?,
            LayerReceiver::Lines(sink) => hand_out_lines(&reading, found, sink, on_defect)?,
            LayerReceiver::Points(sink) => {
                hand_out_points(&reading, table, found, sink, on_defect)?;
            }
        }
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

/// The layers to look for.
struct LayersWanted<'w> {
    outlines: Vec<WantedObjects<'w>>,
    roads: Option<&'w FrcTable>,
}

impl LayersWanted<'_> {
    fn count(&self) -> LayerCount {
        let outlines = self.outlines.len() as u64;
        LayerCount { all: outlines + u64::from(self.roads.is_some()), outlines }
    }
}

/// The contents of some layers of an extract, with the positions of nodes, ready to be delivered.
struct LayerObjects<'a> {
    outlines: Vec<(OutlineObjects<'a>, LocatedWays<'a>)>,
    roads: Option<RoadWays<'a>>,
}

impl<'a> LayerObjects<'a> {
    /// Reads the extract in this order; `None` if the extract is not in this order.
    fn read<R: Read + Seek>(
        reading: &ExtractReading<'a>,
        file: &mut Extracts<R>,
        order: BlobOrder,
        wanted: &LayersWanted<'a>,
    ) -> Result<Option<Self>, Failed> {
        let mut outlines: Vec<Outlines<'_>> =
            wanted.outlines.iter().map(|&wanted| Outlines::new(reading, wanted)).collect();
        let mut of_roads = Deferred::new(reading.request.scratch, reading.shares().defects);
        let on_defect = &mut |defect| of_roads.push(&defect);
        let mut points = FoundNodes::new(reading, &wanted.outlines);
        let found = (&mut outlines[..], &mut points);
        let Some(found) = read_ways(reading, file, order, wanted, found, on_defect)? else {
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
            // Lengths are looked up if the positions of all nodes are in memory together.
            let fits = others + nodes_named <= most_ids(reading, numbered.len() as u64 + 1);
            let left_out = fits.then(|| LeftOutNodes::new(reading));
            numbered.push(number_nodes(reading, ways, &mut summary, on_defect, left_out)?);
        }
        let mut layers = Vec::new();
        for own in numbered {
            let (ways, asked) = own.ask()?;
            questions.push(asked);
            layers.push(ways);
        }
        let mut nodes = NodesLast {
            file,
            points: &mut points,
            unread: order.nodes,
            looked_at,
            is_out_of_order: false,
        };
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
        points.number(reading, &mut objects)?;
        let mut found = Self { outlines: Vec::new(), roads: None };
        for own in objects {
            let Some((NumberedWays { ways, count, .. }, nodes)) = layers.next() else { break };
            let stops = nodes.stops.finish()?;
            found.outlines.push((own, LocatedWays { ways, stops, count, last: None }));
        }
        if let Some((ways, nodes)) = layers.next() {
            summary.nodes_seen = nodes_seen;
            found.roads = Some(RoadWays::from_parts(ways, nodes, summary, of_roads)?);
        }
        Ok(Some(found))
    }
}

/// Reads relations and ways; `None` if they are not in this order.
fn read_ways<'a, R: Read + Seek>(
    reading: &ExtractReading<'a>,
    file: &mut Extracts<R>,
    order: BlobOrder,
    wanted: &LayersWanted<'_>,
    (outlines, points): (&mut [Outlines<'a>], &mut FoundNodes<'a>),
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<Option<FoundWays<'a>>, Failed> {
    let mut found = FoundWays::new(reading);
    let end = if outlines.is_empty() { file.len() } else { order.relations };
    let [relations, ways]: [Vec<usize>; 2] =
        [(end..file.len()).collect(), (order.nodes..end).collect()];
    // If relations come last, objects that are ways are found in the same step as the ways that
    // objects reference; otherwise all objects are found before all ways.
    let is_sorted = end > 0;
    let [relations_bytes, ways_bytes] =
        [&relations, if is_sorted { &ways } else { &relations }].map(|blobs| file.bytes_of(blobs));
    let before =
        find_objects(reading, file, &relations, (outlines, points), !is_sorted, ways_bytes)?;
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
        are_railways_wanted: reading.request.node_ids,
        own_tags: if is_sorted { OwnTags::Kept } else { OwnTags::Ignored },
        way_ids: next_ids()?,
        is_first: true,
        bytes: [relations_bytes, all_bytes],
    };
    found.read(reading, file, &ways, &wanted, (outlines, points), on_defect)?;
    if !outlines.is_empty() && found.looked_at.has_relations {
        return Ok(None);
    }
    wanted = WaysWanted { is_first: false, bytes: [all_bytes - rest_bytes, all_bytes], ..wanted };
    let rest = &before.with_ways;
    found.read(reading, file, rest, &wanted, (outlines, points), on_defect)?;
    // Ways that relations reference, if their ids did not fit in memory together.
    let blobs = [&found.looked_at.with_ways[..], rest].concat();
    loop {
        let way_ids = next_ids()?;
        if way_ids.iter().all(Vec::is_empty) {
            break;
        }
        let own_tags = if is_sorted { OwnTags::KeptBefore } else { OwnTags::Ignored };
        wanted = WaysWanted { roads: None, own_tags, way_ids, bytes: [all_bytes; 2], ..wanted };
        found.read(reading, file, &blobs, &wanted, (outlines, points), on_defect)?;
    }
    found.looked_at.append(reading, before)?;
    Ok(Some(found))
}
