//! Sorts the ways by id and numbers their nodes consecutively.

use std::io;

use corniche_store::Sorter;

use crate::{
    ExtractDefect, ExtractSummary, ReadOsmError,
    failed::Failed,
    left_out_lengths::LeftOutNodes,
    locate_nodes::NodeQuestions,
    reading::ExtractReading,
    records::{Mention, Origin, WayRecord, WayUse},
    spool::{Spool, SpoolReader},
    versions::{known_version, two_versions},
    way_bytes::{is_carrier, is_left_out, is_railway, take_node_ids},
    way_facts::WayFacts,
    ways::add_summary,
    wire::{push_bytes, push_signed, push_varint, take_bytes, take_number, take_signed},
};

/// The remaining ways, and the nodes that they reference.
pub(crate) struct NumberedNodes<'a> {
    /// Per way, in ascending order of way ids: its id, its number of nodes, their ids if requested,
    /// and its properties; see [`crate::hand_out`].
    pub(crate) ways: Spool<'a>,
    pub(crate) mentions: Sorter<'a, Mention>,
    /// Skipped ways, if they are processed separately.
    pub(crate) left_out: Option<LeftOutNodes<'a>>,
    pub(crate) ways_count: u64,
    pub(crate) mentions_count: u64,
    /// The number of ways with the id of another way.
    pub(crate) duplicates: u64,
}

/// The ways of [`NumberedNodes`], ready to be read.
pub(crate) struct NumberedWays<'a> {
    pub(crate) ways: SpoolReader<'a>,
    pub(crate) count: u64,
    pub(crate) duplicates: u64,
}

/// The first of several roads with the same id in a file is kept; skipped ways are all kept. If
/// several extracts contain a way, the ways of the extract with the newest version count, or else
/// of the first extract; their counts go to `summary`.
///
/// Skipped ways go to `left_out`, except ways that carry bridges and tunnels if these are
/// requested. Without `left_out`, all skipped ways are numbered like the others. Railways are
/// numbered only if bridges and tunnels are requested, and the first of several with the same id
/// counts.
///
/// Fails if a way is present in two versions.
pub(crate) fn number_nodes<'a>(
    reading: &ExtractReading<'a>,
    ways: impl Iterator<Item = io::Result<WayRecord>>,
    summary: &mut ExtractSummary,
    on_defect: &mut dyn FnMut(ExtractDefect),
    left_out: Option<LeftOutNodes<'a>>,
) -> Result<NumberedNodes<'a>, Failed> {
    let (request, shares) = (reading.request, reading.shares());
    let mut numbered = NumberedNodes {
        ways: Spool::new(request.scratch, shares.spool),
        mentions: reading.sorter(shares.mentions),
        left_out,
        ways_count: 0,
        mentions_count: 0,
        duplicates: 0,
    };
    let mut last: Option<(i64, Option<i32>)> = None;
    let mut newest: Option<Newest> = None;
    let mut last_railway: Option<i64> = None;
    let mut node_ids = Vec::new();
    for (count, way) in (0..).zip(ways) {
        reading.check_stop_at(count)?;
        let way = way?;
        // Without several extracts, nothing is counted per way.
        let kind = way.take_apart(&mut node_ids)?;
        if !way.facts.is_empty() {
            if let Some(newest) = newest.as_mut().filter(|newest| newest.way_id == way.way_id) {
                // A record of the way from another extract does not count; that it differs is
                // reported once.
                if way.origin.file != newest.origin.file {
                    let differs =
                        (way.origin.version, &way.bytes) != (newest.origin.version, &newest.bytes);
                    let is_new = differs && !std::mem::replace(&mut newest.is_told, true);
                    if is_new && !is_railway(kind) {
                        on_defect(ExtractDefect::ConflictingWay { way_id: way.way_id });
                    }
                    continue;
                }
            } else {
                let &WayRecord { way_id, origin, ref bytes, .. } = &way;
                newest = Some(Newest { way_id, origin, bytes: bytes.clone(), is_told: false });
            }
            let facts = WayFacts::of_bytes(&way.facts)?;
            add_summary(summary, facts.counts);
            facts.defects.into_iter().for_each(&mut *on_defect);
        }
        // If ids are requested, they are stored before the properties of the way.
        let kept = if request.node_ids { &*way.bytes } else { kind };
        if is_left_out(kind) || is_railway(kind) {
            // If bridges and tunnels are requested, so are the ways that may carry or cross them.
            let carries = request.node_ids && is_carrier(kind);
            let is_repeated =
                is_railway(kind) && last_railway.replace(way.way_id) == Some(way.way_id);
            if is_repeated || (is_railway(kind) && !carries) {
                continue;
            }
            match &mut numbered.left_out {
                Some(apart) if !carries => apart.push(&way.bytes, &node_ids),
                _ => {
                    let used = if carries { WayUse::Carrier } else { WayUse::Length };
                    numbered.add(way.way_id, &node_ids, used, kept)
                }
            }?;
            continue;
        }
        let version = known_version(way.origin.version);
        match &mut last {
            Some((way_id, first)) if *way_id == way.way_id => {
                if let (Some(first), Some(second)) = (*first, version)
                    && first != second
                {
                    let reason = two_versions("way", way.way_id, [first, second]);
                    let path = request.extract(way.origin.file);
                    return Err(ReadOsmError::History { path, reason }.into());
                }
                *first = first.or(version);
                numbered.duplicates += 1;
                on_defect(ExtractDefect::DuplicateWay { way_id: way.way_id });
            }
            _ => {
                last = Some((way.way_id, version));
                numbered.add(way.way_id, &node_ids, WayUse::Road, kept)?;
            }
        }
    }
    Ok(numbered)
}

/// The newest version of a way that is in several extracts; the way's records begin with it.
struct Newest {
    way_id: i64,
    origin: Origin,
    bytes: Box<[u8]>,
    is_told: bool,
}

impl WayRecord {
    /// Writes the ids of the way's nodes to a list, and returns its properties as bytes.
    fn take_apart(&self, node_ids: &mut Vec<i64>) -> io::Result<&[u8]> {
        let mut bytes = &*self.bytes;
        node_ids.clear();
        take_node_ids(&mut bytes, |id| {
            node_ids.push(id);
            Ok(())
        })?;
        Ok(bytes)
    }
}

impl<'a> NumberedNodes<'a> {
    /// Returns the ways, and the requests for their nodes.
    pub(crate) fn ask(self) -> io::Result<(NumberedWays<'a>, NodeQuestions<'a>)> {
        let Self { ways, mentions, left_out, ways_count: count, mentions_count, duplicates } = self;
        let ways = NumberedWays { ways: ways.read(), count, duplicates };
        Ok((ways, NodeQuestions { mentions: mentions.finish()?, mentions_count, left_out }))
    }

    /// Adds a way; `kept` is the part of its bytes that is stored.
    fn add(&mut self, way_id: i64, node_ids: &[i64], used: WayUse, kept: &[u8]) -> io::Result<()> {
        let Self { ways, mentions, ways_count, mentions_count, .. } = self;
        let mut previous = None;
        for &id in node_ids {
            let is_repeat = previous.replace(id) == Some(id);
            mentions.push(Mention::new(id, *mentions_count, used, is_repeat))?;
            *mentions_count += 1;
        }
        *ways_count += 1;
        ways.push(|bytes| {
            push_signed(bytes, way_id);
            push_varint(bytes, node_ids.len() as u64);
            push_bytes(bytes, kept);
        })
    }
}

/// Takes a way of [`NumberedNodes`] from the front of `bytes`: its id, its number of nodes, and the
/// rest of its bytes.
pub(crate) fn take_numbered<'b>(bytes: &mut &'b [u8]) -> Option<(i64, usize, &'b [u8])> {
    Some((take_signed(bytes)?, take_number(bytes)?, take_bytes(bytes)?))
}
