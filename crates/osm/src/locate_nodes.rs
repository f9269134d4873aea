//! Finds the positions of the nodes that ways reference.
//!
//! The nodes that ways of all layers reference arrive in ascending order of ids. As many nodes as
//! fit in memory are a chunk. For each chunk, the blobs that may contain its nodes are read. In a
//! file that is sorted by id these are a few neighbours, so a blob is read once, or twice if a
//! chunk ends within it. In an unsorted file, all blobs with nodes are read for each chunk.

use std::io::{self, Read, Seek};

use corniche_store::{Sorted, Sorter};

use crate::{
    ExtractDefect,
    ahead::Ahead,
    block::AuditedBlock,
    extracts::{Extracts, TOO_MUCH_FOUND},
    failed::Failed,
    id_range::IdRange,
    left_out_lengths::{LeftOutNodes, Lengths, left_out_lengths},
    location::MISSING,
    looked::NodeBlob,
    nodes::{FoundNode, NodePlaces, Precedence, listed_nodes},
    reading::{ExtractReading, ReadingStep},
    records::{Located, Mention, SoughtId, Stop, WayUse},
    spool::{Spool, damaged},
    wire::{push_varint, varint},
};

/// Returns the maximum memory of a node in a chunk: its id, its position, two marks, its version if
/// there are several extracts, and one mark for each further layer. If lengths of skipped ways are
/// looked up, the index of ids takes up to one byte more.
pub(crate) fn bytes_per_node(precedence: Precedence, layers: u64) -> u64 {
    match precedence {
        Precedence::First => 8 + 8 + 1 + layers,
        Precedence::Newest => 8 + 8 + 1 + layers + 4,
    }
}

/// The nodes of all ways of a layer, in the order of the ways.
pub(crate) struct LocatedNodes<'a> {
    pub(crate) stops: Sorter<'a, Stop>,
    /// The number of different nodes that ways reference which are not skipped.
    pub(crate) needed: u64,
    /// The number of needed nodes that have no position.
    pub(crate) missing: u64,
    /// The lengths of skipped ways that were processed separately.
    pub(crate) lengths: Lengths,
}

/// The nodes that a layer requests.
pub(crate) struct NodeQuestions<'a> {
    pub(crate) mentions: Sorted<'a, Mention>,
    pub(crate) mentions_count: u64,
    /// Ways whose length alone is needed; only if all nodes fit in one chunk.
    pub(crate) left_out: Option<LeftOutNodes<'a>>,
}

/// Returns the maximum number of nodes in a chunk.
pub(crate) fn most_ids(reading: &ExtractReading<'_>, layers: u64) -> u64 {
    (reading.shares().ids / bytes_per_node(reading.precedence(), layers)).max(1)
}

/// The requests of a layer, node by node.
struct Asking<'a> {
    mentions: Ahead<Sorted<'a, Mention>>,
    /// Nodes that only need to be in the chunk.
    also: Option<Ahead<Sorted<'a, SoughtId>>>,
}

impl Asking<'_> {
    /// Returns the smallest requested node id.
    fn next(&mut self) -> io::Result<Option<i64>> {
        let mention = self.mentions.peek()?.map(|mention| mention.node_id);
        let also = match &mut self.also {
            Some(also) => also.peek()?.map(|&SoughtId(id)| id),
            None => None,
        };
        Ok(mention.into_iter().chain(also).min())
    }
}

/// A source of node positions.
pub(crate) trait NodeSource {
    /// Writes the positions of nodes to `places`, in the order of the file. The ids are larger than
    /// those of earlier calls.
    fn read(
        &mut self,
        reading: &ExtractReading<'_>,
        ids: &[i64],
        share: &ShareOfNodes,
        places: &mut NodePlaces,
    ) -> Result<(), Failed>;
}

/// Finds the positions of all nodes that the layers reference, and answers each reference.
/// `located` contains positions that ways give, in order of node ids. Nodes with several positions
/// go to `on_defect`, with the number of the layer, in order of ids.
pub(crate) fn locate_nodes<'a>(
    reading: &ExtractReading<'a>,
    source: &mut dyn NodeSource,
    questions: Vec<NodeQuestions<'a>>,
    located: impl Iterator<Item = io::Result<Located>>,
    on_defect: &mut dyn FnMut(usize, ExtractDefect),
) -> Result<Vec<LocatedNodes<'a>>, Failed> {
    let stops_bytes = reading.shares().stops;
    let none = || LocatedNodes {
        stops: reading.sorter(stops_bytes),
        needed: 0,
        missing: 0,
        lengths: Lengths::new(),
    };
    let mut nodes: Vec<LocatedNodes<'_>> = questions.iter().map(|_| none()).collect();
    let mut all: u64 = 0;
    let (mut asking, mut left_out) = (Vec::new(), Vec::new());
    for NodeQuestions { mentions, mentions_count, left_out: apart } in questions {
        let (mut ways, mut also) = (None, None);
        if let Some(apart) = apart {
            let LeftOutNodes { ways: own, ids, ids_count } = apart;
            ways = Some(own);
            also = Some(Ahead::new(ids.finish()?));
            all += ids_count;
        }
        all += mentions_count;
        left_out.push(ways);
        asking.push(Asking { mentions: Ahead::new(mentions), also });
    }
    let mut is_read = false;
    let mut located = Ahead::new(located);
    let mut done = 0;
    while let Some(chunk) = Chunk::gather(reading, &mut asking, all - done)? {
        let mut places = NodePlaces::new(chunk.ids.len(), reading.precedence());
        let own = chunk.named_count;
        is_read = true;
        source.read(reading, &chunk.ids, &ShareOfNodes { before: done, own, all }, &mut places)?;
        let mut by_ways = chunk.take_located(reading, &mut located, &places)?.into_iter();
        done += own;
        let layers = chunk.layers.into_iter().zip(&mut nodes).zip(&mut left_out);
        for (layer, ((asked, nodes), left_out)) in layers.enumerate() {
            let by_ways = by_ways.next().flatten();
            let places = by_ways.as_ref().unwrap_or(&places);
            // No road needs a node that only skipped ways reference.
            let is_needed = |&number: &usize| asked.named[number].is_needed();
            let needed = (0..asked.named.len()).filter(is_needed);
            nodes.needed += needed.clone().count() as u64;
            nodes.missing +=
                needed.filter(|&number| places.location(number) == MISSING).count() as u64;
            for number in places.conflicts().filter(is_needed) {
                let node_id = chunk.ids[number];
                on_defect(layer, ExtractDefect::ConflictingNode { node_id });
            }
            asked.answer(reading, places, &mut nodes.stops)?;
            // All nodes are in this chunk.
            if let Some(ways) = left_out.take() {
                nodes.lengths = left_out_lengths(reading, ways, &chunk.ids, places)?;
            }
        }
    }
    if !is_read {
        // Blobs that contain nodes are checked and counted even if no way needs a node.
        let share = ShareOfNodes { before: 0, own: 0, all: 0 };
        let mut none = NodePlaces::new(0, reading.precedence());
        source.read(reading, &[], &share, &mut none)?;
        // Ways without nodes count, too.
        for (nodes, left_out) in nodes.iter_mut().zip(&mut left_out) {
            if let Some(ways) = left_out.take() {
                nodes.lengths = left_out_lengths(reading, ways, &[], &none)?;
            }
        }
    }
    reading.tell(ReadingStep::Nodes, 1, 1);
    Ok(nodes)
}

/// The part of all references to nodes that belongs to a chunk; for progress reports.
pub(crate) struct ShareOfNodes {
    pub(crate) before: u64,
    pub(crate) own: u64,
    pub(crate) all: u64,
}

impl ShareOfNodes {
    /// Returns the number of references up to the end of the chunk.
    pub(crate) fn done(&self) -> u64 {
        self.before + self.own
    }
}

/// Reports how many of the bytes that a chunk needs were read.
pub(crate) fn tell_nodes(
    reading: &ExtractReading<'_>,
    share: &ShareOfNodes,
    bytes: u64,
    all_bytes: u64,
) {
    let done = u128::from(share.own) * u128::from(bytes) / u128::from(all_bytes.max(1));
    reading.tell(ReadingStep::Nodes, share.before + done as u64, share.all);
}

/// Reads those of some blobs that may contain the nodes, and passes on the positions of the nodes
/// by their numbers. `on_bytes` receives the bytes read and their total. Returns the size of these
/// blobs in bytes.
pub(crate) fn read_places<R: Read + Seek>(
    reading: &ExtractReading<'_>,
    file: &mut Extracts<R>,
    node_blobs: &[NodeBlob],
    ids: &[i64],
    on_bytes: &dyn Fn(u64, u64),
    take: &mut dyn FnMut(FoundNode),
) -> Result<u64, Failed> {
    let (Some(&least), Some(&most)) = (ids.first(), ids.last()) else { return Ok(0) };
    let own = IdRange { least, most };
    let numbers: Vec<usize> =
        node_blobs.iter().filter(|blob| blob.ids.meets(own)).map(|blob| blob.number).collect();
    let all_bytes = file.bytes_of(&numbers);
    let take = |_, found: Vec<FoundNode>| {
        found.into_iter().for_each(&mut *take);
        Ok(())
    };
    let scan = |block: Vec<u8>, most_bytes| {
        Ok(listed_nodes(ids, &AuditedBlock::new(&block), most_bytes).ok_or(TOO_MUCH_FOUND)?)
    };
    file.for_each_block(reading, &numbers, &|bytes| on_bytes(bytes, all_bytes), scan, take)?;
    Ok(all_bytes)
}

/// The number of references to a node by the ways of a layer.
///
/// ```text
///  │ by roads and ways that carry them: 2 bits │ by roads: 2 bits │      0: never, 1: once, 2: more often, a junction
/// ```
#[derive(Debug, Clone, Copy, Default)]
struct Named(u8);

impl Named {
    fn and_by(self, mention: &Mention) -> Self {
        let more = |often: u8| match often {
            1 if mention.is_repeat() => 1,
            often => 2.min(often + 1),
        };
        let [by_roads, by_carriers] = [self.0 & 3, self.0 >> 2];
        match mention.way_use() {
            WayUse::Road => Self(more(by_carriers) << 2 | more(by_roads)),
            WayUse::Carrier => Self(more(by_carriers) << 2 | by_roads),
            WayUse::Length => self,
        }
    }

    /// Whether a road references the node.
    fn is_needed(self) -> bool {
        self.0 & 3 > 0
    }

    /// Whether the node is a junction of roads, and whether it is a junction of roads and the ways
    /// that carry them.
    fn is_junction(self) -> [bool; 2] {
        [self.0 & 3 == 2, self.0 >> 2 == 2]
    }
}

/// Some of the referenced nodes, with neighbouring ids.
struct Chunk<'a> {
    ids: Vec<i64>,
    layers: Vec<RequestedNodes<'a>>,
    /// The number of references to its nodes.
    named_count: u64,
}

/// The nodes of a chunk that a layer requests.
struct RequestedNodes<'a> {
    /// The number of references to each node.
    named: Vec<Named>,
    /// The numbers of the references, node by node.
    ///
    /// ```text
    ///  │ number: 63 bits │ 1 if it is the first one of its node │   if it is: │ how many nodes after the one before │
    /// ```
    visits: Spool<'a>,
    mentions_count: u64,
    /// The number of the node that was referenced last.
    last: u64,
}

impl<'a> Chunk<'a> {
    /// Collects the references to as many nodes as fit; `None` if there are no more. `most`
    /// references are left.
    fn gather(
        reading: &ExtractReading<'a>,
        asking: &mut [Asking<'a>],
        most: u64,
    ) -> Result<Option<Self>, Failed> {
        let most_ids = most_ids(reading, asking.len() as u64).min(most) as usize;
        // Allocated at full size: lists that grow by doubling would take up to three times as much.
        let mut ids: Vec<i64> = Vec::with_capacity(most_ids);
        let mut layers: Vec<RequestedNodes<'_>> =
            asking.iter().map(|_| RequestedNodes::new(reading, most_ids)).collect();
        let mut count = 0;
        while ids.len() < most_ids {
            let mut next: Option<i64> = None;
            for own in &mut *asking {
                next = next.into_iter().chain(own.next()?).min();
            }
            let Some(id) = next else { break };
            for (asked, Asking { mentions, also }) in layers.iter_mut().zip(&mut *asking) {
                asked.take(reading, id, ids.len() as u64, mentions, &mut count)?;
                while let Some(also) = also
                    && also.peek()? == Some(&SoughtId(id))
                {
                    also.take();
                    reading.check_stop_at(count)?;
                    count += 1;
                }
            }
            ids.push(id);
        }
        let is_any = !ids.is_empty();
        Ok(is_any.then_some(Self { ids, layers, named_count: count }))
    }

    /// Applies the positions that ways give for nodes of the chunk, in the order of the file, to
    /// each layer whose ways give some. A layer does not depend on the ways of other layers.
    fn take_located(
        &self,
        reading: &ExtractReading<'_>,
        located: &mut Ahead<impl Iterator<Item = io::Result<Located>>>,
        places: &NodePlaces,
    ) -> Result<Vec<Option<NodePlaces>>, Failed> {
        let mut by_layer: Vec<Option<NodePlaces>> = self.layers.iter().map(|_| None).collect();
        let mut count = 0;
        while let Some(next) = located.peek()? {
            if self.ids.last().is_some_and(|&last| next.node_id > last) {
                break;
            }
            // The node may be missing: a duplicate that was skipped referenced it.
            if let (Ok(number), Some(own)) =
                (self.ids.binary_search(&next.node_id), by_layer.get_mut(usize::from(next.layer)))
            {
                own.get_or_insert_with(|| places.clone()).set(number, next.location, 0);
            }
            located.take();
            reading.check_stop_at(count)?;
            count += 1;
        }
        Ok(by_layer)
    }
}

impl<'a> RequestedNodes<'a> {
    fn new(reading: &ExtractReading<'a>, most_ids: usize) -> Self {
        let visits = Spool::new(reading.request.scratch, reading.shares().visits);
        Self { named: Vec::with_capacity(most_ids), visits, mentions_count: 0, last: 0 }
    }

    /// Collects the references to the node with this id, which is the next node of the chunk.
    fn take(
        &mut self,
        reading: &ExtractReading<'_>,
        id: i64,
        number: u64,
        mentions: &mut Ahead<Sorted<'a, Mention>>,
        count: &mut u64,
    ) -> Result<(), Failed> {
        let mut named = Named::default();
        let mut is_first = true;
        while let Some(mention) = mentions.peek()? {
            if mention.node_id != id {
                break;
            }
            named = named.and_by(mention);
            let visit = (mention.number() << 1) | u64::from(is_first);
            let push = |bytes: &mut Vec<u8>| {
                push_varint(bytes, visit);
                if is_first {
                    push_varint(bytes, number - self.last);
                }
            };
            self.visits.push(push)?;
            self.last = number;
            is_first = false;
            mentions.take();
            self.mentions_count += 1;
            reading.check_stop_at(*count)?;
            *count += 1;
        }
        self.named.push(named);
        Ok(())
    }

    /// Answers each reference with the position of its node.
    fn answer(
        self,
        reading: &ExtractReading<'_>,
        places: &NodePlaces,
        stops: &mut Sorter<'_, Stop>,
    ) -> Result<(), Failed> {
        let mut visits = self.visits.read();
        let mut node = 0;
        for count in 0..self.mentions_count {
            reading.check_stop_at(count)?;
            let visit = |bytes: &mut &[u8]| {
                let visit = varint(bytes).ok()?;
                let after = if visit & 1 == 1 { varint(bytes).ok()? } else { 0 };
                Some((visit, usize::try_from(after).ok()?))
            };
            let visit = visits.next(visit)?;
            let (visit, after) = visit.ok_or_else(damaged)?;
            node += after;
            let named = self.named.get(node).ok_or_else(damaged)?;
            let stop = Stop::new(visit >> 1, named.is_junction(), places.location(node));
            stops.push(stop)?;
        }
        Ok(())
    }
}
