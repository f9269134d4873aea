//! Passes 2 and 3: the ways of outlines, and where their nodes lie.

use std::io::{Read, Seek};

use corniche_store::Sorter;

use super::{find_outlines::find_outlines, located_ways::LocatedWays, records::MemberRecord};
use crate::{
    Defect, ExtractSummary, ReadOsmError,
    extracts::Extracts,
    find_ways::NodeBlob,
    locate_nodes::{FileNodes, NodeQuestions, locate_nodes},
    number_nodes::{NumberedNodes, number_nodes},
    reading::Reading,
    spool::Spool,
};

/// The ways of outlines with the places of their nodes, and who needs them, both by way id.
pub(crate) struct OutlineWays<'a> {
    pub(crate) members: Spool<'a>,
    pub(crate) located: LocatedWays<'a>,
}

/// Reads the ways that `members` name, and their nodes.
pub(crate) fn read_outline_ways<'a, R: Read + Seek>(
    reading: &Reading<'a>,
    file: &mut Extracts<R>,
    (way_blobs, node_blobs): (&[usize], &[NodeBlob]),
    members: Sorter<'a, MemberRecord>,
    held_bytes: &mut u64,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<OutlineWays<'a>, ReadOsmError> {
    let failed = |error| reading.scratch_failed(error);
    let outlines = find_outlines(reading, file, way_blobs, members, held_bytes)?;
    // What these count is of roads.
    let mut of_roads = ExtractSummary::default();
    let ways = outlines.ways.finish().map_err(failed)?;
    let numbered = number_nodes(reading, ways, &mut of_roads, on_defect)?;
    let NumberedNodes { ways, mentions, mentions_count, .. } = numbered;
    let mentions = mentions.finish().map_err(failed)?;
    let located = outlines.located.finish().map_err(failed)?;
    let questions = NodeQuestions { mentions, mentions_count, located };
    let mut nodes = FileNodes { file, node_blobs };
    let nodes = locate_nodes(reading, &mut nodes, questions, on_defect)?;
    let stops = nodes.stops.finish().map_err(failed)?;
    let located = LocatedWays { ways: ways.read(), stops };
    Ok(OutlineWays { members: outlines.members, located })
}
