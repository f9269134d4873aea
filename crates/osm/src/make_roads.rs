//! From the ways and nodes of an extract to its roads, wherever the ways and nodes come from.

use std::io;

use corniche_roads::Road;

use crate::{
    Defect, ExtractSummary, ReadOsmError,
    hand_out::hand_out,
    locate_nodes::{NodeQuestions, NodeSource, locate_nodes},
    number_nodes::{NumberedNodes, number_nodes},
    reading::Reading,
    records::{Located, WayRecord},
};

/// Road ways and places that ways give, both sorted, and where places of nodes come from.
pub(crate) struct WaysAndNodes<'a, W, L> {
    pub(crate) ways: W,
    pub(crate) located: L,
    pub(crate) nodes: &'a mut dyn NodeSource,
}

/// Hands out roads and defects, and counts what becomes of the ways.
pub(crate) fn make_roads(
    reading: &Reading<'_>,
    found: WaysAndNodes<
        '_,
        impl Iterator<Item = io::Result<WayRecord>>,
        impl Iterator<Item = io::Result<Located>>,
    >,
    summary: &mut ExtractSummary,
    sink: &mut dyn FnMut(Road),
    on_defect: &mut dyn FnMut(Defect),
) -> Result<(), ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let numbered = number_nodes(reading, found.ways, summary, on_defect)?;
    let NumberedNodes { ways, mentions, ways_count, mentions_count, duplicates } = numbered;
    let mentions = mentions.finish().map_err(failed)?;
    let questions = NodeQuestions { mentions, mentions_count, located: found.located };
    let nodes = locate_nodes(reading, found.nodes, questions, on_defect)?;
    summary.left_out.duplicate = duplicates;
    summary.nodes_needed = nodes.needed;
    summary.nodes_missing = nodes.missing;
    let stops = nodes.stops.finish().map_err(failed)?;
    hand_out(reading, ways.read(), ways_count, stops, &mut |assembled| {
        if let Some((reason, highway, length_um)) = assembled.left_out {
            let own = summary.left_out_ways.entry((reason, highway)).or_default();
            own.ways += 1;
            own.length_um += length_um;
            return;
        }
        let roads = assembled.roads.len() as u64;
        summary.roads += roads;
        *(if roads > 0 { &mut summary.road_ways } else { &mut summary.left_out.without_line }) += 1;
        assembled.defects.into_iter().for_each(&mut *on_defect);
        assembled.roads.into_iter().for_each(&mut *sink);
    })
}
