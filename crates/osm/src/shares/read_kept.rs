//! Roads from what all shares kept.

use corniche_roads::Road;

use super::{
    blocks::{BLOCK_BYTES, BlockReader},
    kept::Kept,
    kept_records::PlaceRecord,
    merged::Merged,
    nodes_of_share::blocks_of,
    ways_record::WaysRecord,
};
use crate::{
    Defect, ExtractSummary, ReadOsmError,
    ahead::Ahead,
    deferred::Deferred,
    failed::Failed,
    hand_out::{RoadWays, hand_out_roads},
    kept_error::KeptError,
    layer_sink::LayerSink,
    locate_nodes::{NodeQuestions, NodeSource, ShareOfNodes, locate_nodes},
    looked::{append_versions, check_held},
    nodes::{NodeIds, NodePlaces},
    number_nodes::{NumberedNodes, number_nodes},
    read_request::ReadRequest,
    reading::{LayerCount, Reading, Step},
    records::{Located, WayRecord},
    share::Share,
    versions::Versions,
    ways::add_summary,
};

/// Hands out the roads of an extract whose ways and nodes were kept in so many shares: the same roads, defects and counts, in the same
/// order, as [`read_extract`](crate::read_extract) does. The extract itself is not read, `request.path` only names it in messages.
///
/// # Errors
/// [`ReadOsmError::Kept`] if not all is there, and what [`read_extract`](crate::read_extract) finds by comparing ways with each other.
pub fn read_kept_roads(
    request: &ReadRequest<'_>,
    of: u16,
    kept: Kept<'_>,
    sink: &mut dyn LayerSink<Road, ExtractSummary>,
    on_defect: &mut dyn FnMut(Defect),
    should_stop: &(dyn Fn() -> bool + Sync),
) -> Result<(), ReadOsmError> {
    let failed = |source| ReadOsmError::Kept { path: request.path.to_path_buf(), source };
    let shares: Vec<Share> = Share::all(of).collect();
    let records: Result<Vec<_>, KeptError> =
        shares.iter().map(|&share| WaysRecord::get(kept, share)).collect();
    let records = records.map_err(failed)?;
    let Some(first) = records.first() else {
        return Err(failed(KeptError::Missing { what: "ways", share: Share::WHOLE }));
    };
    // A block of places and one of those in ways is in memory for each share; what is sorted gets the rest.
    let blocks_bytes = u64::from(of) * 2 * BLOCK_BYTES as u64;
    let sorted_bytes = request.memory_bytes.saturating_sub(blocks_bytes);
    let memory_bytes = sorted_bytes.max(request.memory_bytes / 2);
    let request = &ReadRequest { memory_bytes, ..*request };
    let reading =
        Reading { request, should_stop, len_bytes: first.len_bytes, layers: LayerCount::ROADS };
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
            defects.push(&defect.map_err(|error| reading.failed(error))?);
        }
        add_summary(&mut summary, record.counts);
    }
    reading.tell(Step::Ways, 1, 1);
    let with_blocks = || shares.iter().copied().zip(&blocks);
    let ways = with_blocks()
        .map(|(share, &[blocks, _])| BlockReader::new(kept, kept.kinds.ways, share, blocks));
    let located = with_blocks()
        .map(|(share, &[_, blocks])| BlockReader::new(kept, kept.kinds.located, share, blocks));
    let places: Result<Vec<_>, KeptError> = shares
        .iter()
        .map(|&share| Ok(BlockReader::new(kept, kept.kinds.places, share, blocks_of(kept, share)?)))
        .collect();
    let mut nodes = KeptNodes {
        places: Ahead::new(Merged::new(places.map_err(failed)?, |place| (place.node_id, 0))),
    };
    let ways = Merged::new(ways.collect(), |way: &WayRecord| (way.way_id, way.origin.age));
    let on_duplicate = &mut |defect| defects.push(&defect);
    let numbered = number_nodes(&reading, ways, &mut summary, on_duplicate, None)
        .map_err(|error| reading.failed(error))?;
    let NumberedNodes { ways, mentions, left_out, ways_count, mentions_count, duplicates } =
        numbered;
    let mentions = mentions.finish().map_err(|error| reading.failed(error))?;
    let questions = vec![NodeQuestions { mentions, mentions_count, left_out }];
    let located = Merged::new(located.collect(), |located: &Located| (located.node_id, 0));
    let on_conflict = &mut |_, defect| defects.push(&defect);
    let answers = locate_nodes(&reading, &mut nodes, questions, located, on_conflict)
        .map_err(|error| reading.failed(error))?;
    // There is one for each question.
    let Some(nodes) = answers.into_iter().next() else { return Ok(()) };
    let ways = (ways.read(), ways_count, duplicates);
    let found =
        RoadWays::of(ways, nodes, summary, defects).map_err(|error| reading.failed(error))?;
    hand_out_roads(&reading, found, sink, on_defect).map_err(|error| reading.failed(error))
}

/// The places that all shares of nodes found.
struct KeptNodes<'a> {
    places: Ahead<Merged<'a, PlaceRecord>>,
}

impl NodeSource for KeptNodes<'_> {
    fn read(
        &mut self,
        reading: &Reading<'_>,
        ids: &NodeIds,
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), Failed> {
        let Some(&last) = ids.ids().last() else { return Ok(()) };
        let mut search = ids.search();
        let mut count = 0;
        while let Some(&place) = self.places.peek()? {
            if place.node_id > last {
                break;
            }
            // Not there: only a way that was left out as a duplicate names the node.
            if let Some(number) = search.find(place.node_id) {
                let own = (place.location, place.version);
                places.add(number, own, place.is_conflicting);
            }
            self.places.take();
            reading.check_stop_at(count)?;
            count += 1;
        }
        reading.tell(Step::Nodes, share.done(), share.all);
        Ok(())
    }
}
