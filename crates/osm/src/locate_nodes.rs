//! Pass 2: where the nodes of roads lie.
//!
//! The nodes that roads name come in ascending order of id. As many as fit in memory are a chunk; for each chunk the blobs are
//! read that may hold its nodes. In a file that is sorted by id these are a few neighbours, so a blob is read once, or twice where
//! a chunk ends within it. In a file that is not sorted all blobs with nodes are read for each chunk.

use std::io::{self, Read, Seek};

use corniche_store::{Sorted, Sorter};

use crate::{
    Defect, ReadOsmError,
    ahead::Ahead,
    blobs::Decoding,
    block::Block,
    extracts::{Extracts, TOO_MUCH_FOUND},
    find_ways::NodeBlob,
    id_range::IdRange,
    nodes::{FoundNode, NodeIds, NodePlaces, Precedence},
    reading::{Reading, Step},
    records::{Located, Mention, Stop},
    spool::{Spool, damaged},
    wire::{push_varint, varint},
};

/// What a node of a chunk takes at most: its id, its place, two marks, and of several extracts its version.
pub(crate) fn bytes_per_node(precedence: Precedence) -> u64 {
    match precedence {
        Precedence::First => 8 + 8 + 1 + 1,
        Precedence::Newest => 8 + 8 + 1 + 1 + 4,
    }
}

/// The nodes of all roads, in the order of ways.
pub(crate) struct LocatedNodes<'a> {
    pub(crate) stops: Sorter<'a, Stop>,
    /// Different nodes that roads name.
    pub(crate) needed: u64,
    /// How many of them have no place.
    pub(crate) missing: u64,
}

/// What is asked of the nodes.
pub(crate) struct NodeQuestions<'a, L> {
    pub(crate) mentions: Sorted<'a, Mention>,
    pub(crate) mentions_count: u64,
    /// Places that ways give, in order of node id.
    pub(crate) located: L,
}

/// Where the places of nodes come from.
pub(crate) trait NodeSource {
    /// Gives the places of nodes, in the order of the file. Their ids follow those that were asked for before.
    fn read(
        &mut self,
        reading: &Reading<'_>,
        ids: &NodeIds,
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), ReadOsmError>;
}

/// Places of nodes from an extract.
pub(crate) struct FileNodes<'a, R> {
    pub(crate) file: &'a mut Extracts<R>,
    pub(crate) node_blobs: &'a [NodeBlob],
}

/// Finds the places of all nodes that roads name. Nodes with several places go to `on_defect`, in order of id.
pub(crate) fn locate_nodes<'a>(
    reading: &Reading<'a>,
    source: &mut dyn NodeSource,
    questions: NodeQuestions<'a, impl Iterator<Item = io::Result<Located>>>,
    on_defect: &mut dyn FnMut(Defect),
) -> Result<LocatedNodes<'a>, ReadOsmError> {
    let NodeQuestions { mentions, mentions_count, located } = questions;
    let stops = reading.sorter(reading.shares().stops);
    let mut nodes = LocatedNodes { stops, needed: 0, missing: 0 };
    let mut mentions = Ahead::new(mentions);
    let mut located = Ahead::new(located);
    let mut done = 0;
    while let Some(chunk) = Chunk::gather(reading, &mut mentions, mentions_count - done)? {
        let mut places = NodePlaces::new(chunk.ids.ids().len(), reading.precedence());
        let share = ShareOfNodes { before: done, own: chunk.mentions_count, all: mentions_count };
        source.read(reading, &chunk.ids, &share, &mut places)?;
        chunk.take_located(reading, &mut located, &mut places)?;
        // What only ways name that are left out is needed for their lengths alone.
        let is_needed = |&number: &usize| chunk.named[number] != Named::Never;
        let needed = (0..chunk.named.len()).filter(is_needed);
        nodes.needed += needed.clone().count() as u64;
        nodes.missing += needed.filter(|&number| places.is_missing(number)).count() as u64;
        for number in places.conflicts().filter(is_needed) {
            on_defect(Defect::ConflictingNode { node_id: chunk.ids.ids()[number] });
        }
        done += chunk.mentions_count;
        chunk.answer(reading, &places, &mut nodes.stops)?;
    }
    if done == 0 {
        // Blobs that hold nodes are checked and counted, also if no road needs one.
        let share = ShareOfNodes { before: 0, own: 0, all: 0 };
        let mut none = NodePlaces::new(0, reading.precedence());
        source.read(reading, &NodeIds::new(Vec::new()), &share, &mut none)?;
    }
    reading.tell(Step::Nodes, 1, 1);
    Ok(nodes)
}

/// Which part of all mentions a chunk is; for the progress.
pub(crate) struct ShareOfNodes {
    pub(crate) before: u64,
    pub(crate) own: u64,
    pub(crate) all: u64,
}

impl ShareOfNodes {
    /// Mentions up to the end of the chunk.
    pub(crate) fn done(&self) -> u64 {
        self.before + self.own
    }
}

impl<R: Read + Seek> NodeSource for FileNodes<'_, R> {
    /// Reads the blobs that may hold nodes of the chunk.
    fn read(
        &mut self,
        reading: &Reading<'_>,
        ids: &NodeIds,
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), ReadOsmError> {
        let on_bytes = |bytes: u64, all_bytes: u64| tell_nodes(reading, share, bytes, all_bytes);
        let take = &mut |(number, location, version)| places.set(number, location, version);
        read_places(reading, self.file, self.node_blobs, ids, &on_bytes, take)?;
        Ok(())
    }
}

/// Tells that so many of the bytes were read that a chunk needs.
pub(crate) fn tell_nodes(reading: &Reading<'_>, share: &ShareOfNodes, bytes: u64, all_bytes: u64) {
    let done = u128::from(share.own) * u128::from(bytes) / u128::from(all_bytes.max(1));
    reading.tell(Step::Nodes, share.before + done as u64, share.all);
}

/// Reads those of some blobs that may hold some nodes, and hands on the places of these nodes by their numbers. `on_bytes` is told how
/// many of how many bytes were read. Returns how many bytes these blobs have.
pub(crate) fn read_places<R: Read + Seek>(
    reading: &Reading<'_>,
    file: &mut Extracts<R>,
    node_blobs: &[NodeBlob],
    ids: &NodeIds,
    on_bytes: &dyn Fn(u64, u64),
    take: &mut dyn FnMut(FoundNode),
) -> Result<u64, ReadOsmError> {
    let (Some(&least), Some(&most)) = (ids.ids().first(), ids.ids().last()) else { return Ok(0) };
    let own = IdRange { least, most };
    let numbers: Vec<usize> =
        node_blobs.iter().filter(|blob| blob.ids.meets(own)).map(|blob| blob.number).collect();
    let all_bytes = file.bytes_of(&numbers);
    let decoding = Decoding {
        pool: reading.request.pool,
        should_stop: reading.should_stop,
        on_bytes: &|bytes| on_bytes(bytes, all_bytes),
    };
    let take = |_, found: Vec<FoundNode>| {
        found.into_iter().for_each(&mut *take);
        Ok(())
    };
    let scan = |block: Vec<u8>, most_bytes| {
        Ok(ids.scan(&Block::new(&block), most_bytes).ok_or(TOO_MUCH_FOUND)?)
    };
    file.for_each_block(&numbers, &decoding, scan, take)?;
    Ok(all_bytes)
}

/// How often roads name a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Named {
    Never,
    Once,
    Often,
}

/// Some of the nodes that ways name, with neighbouring ids.
struct Chunk<'a> {
    ids: NodeIds,
    /// How often roads name it: not at all, once, or more often, by two roads or twice by one: a junction.
    named: Vec<Named>,
    /// Numbers of the mentions, node by node.
    ///
    /// ```text
    ///  │ number: 63 bits │ 1 if it is the first one of its node │
    /// ```
    visits: Spool<'a>,
    mentions_count: u64,
}

impl<'a> Chunk<'a> {
    /// Takes the mentions of as many nodes as fit; `None` if there are no more. `most` mentions are to come.
    fn gather(
        reading: &Reading<'a>,
        mentions: &mut Ahead<Sorted<'a, Mention>>,
        most: u64,
    ) -> Result<Option<Self>, ReadOsmError> {
        let shares = reading.shares();
        let failed = |error| reading.scratch_failed(error);
        let most_ids =
            (shares.ids / bytes_per_node(reading.precedence())).max(1).min(most) as usize;
        // Of this size at once: lists that grow by doubling would take up to three times as much.
        let mut ids: Vec<i64> = Vec::with_capacity(most_ids);
        let mut named = Vec::with_capacity(most_ids);
        let mut visits = Spool::new(reading.request.scratch, shares.visits);
        let mut mentions_count = 0;
        while let Some(mention) = mentions.peek().map_err(failed)? {
            let is_first = ids.last() != Some(&mention.node_id);
            if is_first {
                if ids.len() == most_ids {
                    break;
                }
                ids.push(mention.node_id);
                named.push(Named::Never);
            }
            if !mention.is_left_out()
                && let Some(named) = named.last_mut()
            {
                *named = match *named {
                    Named::Never => Named::Once,
                    Named::Once if mention.is_repeat() => Named::Once,
                    Named::Once | Named::Often => Named::Often,
                };
            }
            let visit = (mention.number() << 1) | u64::from(is_first);
            visits.push(|bytes| push_varint(bytes, visit)).map_err(failed)?;
            mentions.take();
            reading.check_stop_at(mentions_count)?;
            mentions_count += 1;
        }
        let chunk = Self { ids: NodeIds::new(ids), named, visits, mentions_count };
        Ok((mentions_count > 0).then_some(chunk))
    }

    /// Takes the places that ways give for nodes of the chunk, in the order of the file.
    fn take_located(
        &self,
        reading: &Reading<'_>,
        located: &mut Ahead<impl Iterator<Item = io::Result<Located>>>,
        places: &mut NodePlaces,
    ) -> Result<(), ReadOsmError> {
        let mut count = 0;
        while let Some(next) = located.peek().map_err(|error| reading.scratch_failed(error))? {
            if self.ids.ids().last().is_some_and(|&last| next.node_id > last) {
                break;
            }
            // Not there: a duplicate named the node, and was left out.
            if let Some(number) = self.ids.number(next.node_id) {
                places.set(number, next.location, 0);
            }
            located.take();
            reading.check_stop_at(count)?;
            count += 1;
        }
        Ok(())
    }

    /// Gives each mention the place of its node.
    fn answer(
        self,
        reading: &Reading<'_>,
        places: &NodePlaces,
        stops: &mut Sorter<'_, Stop>,
    ) -> Result<(), ReadOsmError> {
        let failed = |error| reading.scratch_failed(error);
        let mut visits = self.visits.read();
        let mut nodes = 0;
        for count in 0..self.mentions_count {
            reading.check_stop_at(count)?;
            let visit = visits.next(|bytes| varint(bytes).ok()).map_err(failed)?;
            let visit = visit.ok_or_else(damaged).map_err(failed)?;
            nodes += (visit & 1) as usize;
            let node = nodes.checked_sub(1).filter(|&node| node < self.named.len());
            let node = node.ok_or_else(damaged).map_err(failed)?;
            let stop =
                Stop::new(visit >> 1, self.named[node] == Named::Often, places.location(node));
            stops.push(stop).map_err(failed)?;
        }
        Ok(())
    }
}
