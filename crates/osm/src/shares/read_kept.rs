//! Reads roads from the results of all shares.

use corniche_roads::Road;

use super::{
    blocks::{BLOCK_BYTES, BlockReader},
    kept::ShareStore,
    kept_records::PlaceRecord,
    merged::Merged,
    nodes_of_share::blocks_of,
    ways_record::WaysRecord,
};
use crate::{
    ExtractDefect, ExtractSummary, ReadOsmError,
    ahead::Ahead,
    deferred::Deferred,
    failed::Failed,
    hand_out::{RoadWays, hand_out_roads},
    kept_error::KeptError,
    layer_sink::LayerSink,
    locate_nodes::{NodeSource, ShareOfNodes, locate_nodes},
    looked::{append_versions, check_held},
    nodes::NodePlaces,
    number_nodes::number_nodes,
    read_request::ReadRequest,
    reading::{ExtractReading, LayerCount, ReadingStep},
    records::{Located, WayRecord},
    search::IdSearch,
    share::Share,
    versions::Versions,
    ways::add_summary,
};

/// Delivers the roads of an extract from the stored results of all its shares: the same roads,
/// defects and counts, in the same order, as [`read_extract`](crate::read_extract). The extract
/// itself is not read; `request.path` is only the name in messages.
///
/// # Errors
/// [`ReadOsmError::Kept`] if results are missing, and the errors that
/// [`read_extract`](crate::read_extract) finds when it compares ways with each other.
pub fn read_kept_roads(
    request: &ReadRequest<'_>,
    of: u16,
    kept: ShareStore<'_>,
    sink: &mut dyn LayerSink<Road, ExtractSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let read = read(request, (of, kept), sink, on_defect, should_stop);
    read.map_err(|failed| failed.at_path(request.path))
}

fn read(
    request: &ReadRequest<'_>,
    (of, kept): (u16, ShareStore<'_>),
    sink: &mut dyn LayerSink<Road, ExtractSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), Failed> {
    let shares: Vec<Share> = Share::all(of).collect();
    let records = WaysRecord::all(kept, of)?;
    let none = KeptError::Missing { what: "ways", share: Share::WHOLE };
    let first = records.first().ok_or(none)?;
    // For each share, one block of positions and one block of positions in ways are in memory;
    // sorting gets the rest.
    let blocks_bytes = u64::from(of) * 2 * BLOCK_BYTES as u64;
    let sorted_bytes = request.memory_bytes.saturating_sub(blocks_bytes);
    let memory_bytes = sorted_bytes.max(request.memory_bytes / 2);
    let request = &ReadRequest { memory_bytes, ..*request };
    let reading = ExtractReading {
        request,
        should_stop,
        len_bytes: first.len_bytes,
        layers: LayerCount::ROADS,
    };
    let mut summary = ExtractSummary {
        blobs_passed_over: first.blobs_passed_over,
        header_bounds_deg: first.header.bounds_deg,
        generator: first.header.generator.clone(),
        timestamp_s: first.header.timestamp_s,
        ..ExtractSummary::default()
    };
    let blocks: Vec<[u32; 2]> =
        records.iter().map(|record| [record.way_blocks, record.located_blocks]).collect();
    let (mut versions, mut held_bytes) = (Versions::default(), 0);
    let mut defects = Deferred::new(request.scratch, reading.shares().defects);
    for (&share, record) in shares.iter().zip(records) {
        reading.check_stop()?;
        append_versions(&reading, &mut versions, record.versions)?;
        held_bytes += record.held_bytes;
        check_held(&reading, held_bytes)?;
        let kind = kept.kinds.defects;
        for defect in BlockReader::new(kept, kind, share, record.defect_blocks) {
            defects.push(&defect?);
        }
        add_summary(&mut summary, record.counts);
    }
    reading.tell(ReadingStep::Ways, 1, 1);
    let with_blocks = || shares.iter().copied().zip(&blocks);
    let ways = with_blocks()
        .map(|(share, &[blocks, _])| BlockReader::new(kept, kept.kinds.ways, share, blocks));
    let located = with_blocks()
        .map(|(share, &[_, blocks])| BlockReader::new(kept, kept.kinds.located, share, blocks));
    let places: Result<Vec<_>, KeptError> = shares
        .iter()
        .map(|&share| Ok(BlockReader::new(kept, kept.kinds.places, share, blocks_of(kept, share)?)))
        .collect();
    let mut nodes =
        KeptNodes { places: Ahead::new(Merged::new(places?, |place| (place.node_id, 0))) };
    let ways = Merged::new(ways.collect(), |way: &WayRecord| (way.way_id, way.origin.age));
    let on_duplicate = &mut |defect| defects.push(&defect);
    let numbered = number_nodes(&reading, ways, &mut summary, on_duplicate, None)?;
    let (ways, questions) = numbered.ask()?;
    let located = Merged::new(located.collect(), |located: &Located| (located.node_id, 0));
    let on_conflict = &mut |_, defect| defects.push(&defect);
    let answers = locate_nodes(&reading, &mut nodes, vec![questions], located, on_conflict)?;
    // There is one answer for each request.
    let Some(nodes) = answers.into_iter().next() else { return Ok(()) };
    hand_out_roads(&reading, RoadWays::from_parts(ways, nodes, summary, defects)?, sink, on_defect)
}

/// The positions that all shares of nodes found.
struct KeptNodes<'a> {
    places: Ahead<Merged<'a, PlaceRecord>>,
}

impl NodeSource for KeptNodes<'_> {
    fn read(
        &mut self,
        reading: &ExtractReading<'_>,
        ids: &[i64],
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), Failed> {
        let Some(&last) = ids.last() else { return Ok(()) };
        let mut search = IdSearch::new(ids);
        let mut count = 0;
        while let Some(&place) = self.places.peek()? {
            if place.node_id > last {
                break;
            }
            // The node may be missing: only a way that was skipped as a duplicate references it.
            if let Some(number) = search.find(place.node_id) {
                let own = (place.location, place.version);
                places.add(number, own, place.is_conflicting);
            }
            self.places.take();
            reading.check_stop_at(count)?;
            count += 1;
        }
        reading.tell(ReadingStep::Nodes, share.done(), share.all);
        Ok(())
    }
}
