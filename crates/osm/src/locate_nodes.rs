//! Where the nodes lie that ways name.
//!
//! The nodes that ways of all layers name come in ascending order of id. As many as fit in memory are a chunk; for each chunk the blobs are
//! read that may hold its nodes. In a file that is sorted by id these are a few neighbours, so a blob is read once, or twice where
//! a chunk ends within it. In a file that is not sorted all blobs with nodes are read for each chunk.

use std::io::{self, Read, Seek};

use corniche_store::{Sorted, Sorter};

use crate::{
    Defect,
    ahead::Ahead,
    block::Block,
    extracts::{Extracts, TOO_MUCH_FOUND},
    failed::Failed,
    id_range::IdRange,
    left_out_lengths::{LeftOutNodes, Lengths, left_out_lengths},
    looked::NodeBlob,
    nodes::{FoundNode, NodeIds, NodePlaces, Precedence},
    reading::{Reading, Step},
    records::{Located, Mention, SoughtId, Stop, WayUse},
    spool::{Spool, damaged},
    wire::{push_varint, varint},
};

/// What a node of a chunk takes at most: its id, its place, two marks, and of several extracts its version; for each further layer a mark. Where lengths of ways that are
/// left out are looked up, the index of ids takes up to a byte more.
pub(crate) fn bytes_per_node(precedence: Precedence, layers: u64) -> u64 {
    match precedence {
        Precedence::First => 8 + 8 + 1 + layers,
        Precedence::Newest => 8 + 8 + 1 + layers + 4,
    }
}

/// The nodes of all ways of a layer, in the order of the ways.
pub(crate) struct LocatedNodes<'a> {
    pub(crate) stops: Sorter<'a, Stop>,
    /// Different nodes that ways name which are not left out.
    pub(crate) needed: u64,
    /// How many of them have no place.
    pub(crate) missing: u64,
    /// Lengths of ways that are left out and were treated apart.
    pub(crate) lengths: Lengths,
}

/// The nodes that a layer asks for.
pub(crate) struct NodeQuestions<'a> {
    pub(crate) mentions: Sorted<'a, Mention>,
    pub(crate) mentions_count: u64,
    /// Ways that are asked for their lengths alone; only where all nodes fit in a chunk.
    pub(crate) left_out: Option<LeftOutNodes<'a>>,
}

/// How many nodes a chunk has at most.
pub(crate) fn most_ids(reading: &Reading<'_>, layers: u64) -> u64 {
    (reading.shares().ids / bytes_per_node(reading.precedence(), layers)).max(1)
}

/// What a layer asks, node by node.
struct Asking<'a> {
    mentions: Ahead<Sorted<'a, Mention>>,
    /// Nodes that only have to be there.
    also: Option<Ahead<Sorted<'a, SoughtId>>>,
}

impl Asking<'_> {
    /// The node with the least id.
    fn next(&mut self) -> io::Result<Option<i64>> {
        let mention = self.mentions.peek()?.map(|mention| mention.node_id);
        let also = match &mut self.also {
            Some(also) => also.peek()?.map(|&SoughtId(id)| id),
            None => None,
        };
        Ok(mention.into_iter().chain(also).min())
    }
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
    ) -> Result<(), Failed>;
}

/// Finds the places of all nodes that the layers name, and answers each of them. `located` are places that ways give, in order of node id.
/// Nodes with several places go to `on_defect`, with the number of the layer, in order of id.
pub(crate) fn locate_nodes<'a>(
    reading: &Reading<'a>,
    source: &mut dyn NodeSource,
    questions: Vec<NodeQuestions<'a>>,
    located: impl Iterator<Item = io::Result<Located>>,
    on_defect: &mut dyn FnMut(usize, Defect),
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
        let mut places = NodePlaces::new(chunk.ids.ids().len(), reading.precedence());
        let own = chunk.named_count;
        is_read = true;
        source.read(reading, &chunk.ids, &ShareOfNodes { before: done, own, all }, &mut places)?;
        let mut by_ways = chunk.take_located(reading, &mut located, &places)?.into_iter();
        done += own;
        let layers = chunk.layers.into_iter().zip(&mut nodes).zip(&mut left_out);
        for (layer, ((asked, nodes), left_out)) in layers.enumerate() {
            let by_ways = by_ways.next().flatten();
            let places = by_ways.as_ref().unwrap_or(&places);
            // What only ways name that are left out is needed by no road.
            let is_needed = |&number: &usize| asked.named[number].is_needed();
            let needed = (0..asked.named.len()).filter(is_needed);
            nodes.needed += needed.clone().count() as u64;
            nodes.missing += needed.filter(|&number| places.is_missing(number)).count() as u64;
            for number in places.conflicts().filter(is_needed) {
                let node_id = chunk.ids.ids()[number];
                on_defect(layer, Defect::ConflictingNode { node_id });
            }
            asked.answer(reading, places, &mut nodes.stops)?;
            // All nodes are in this chunk.
            if let Some(ways) = left_out.take() {
                nodes.lengths = left_out_lengths(reading, ways, &chunk.ids, places)?;
            }
        }
    }
    if !is_read {
        // Blobs that hold nodes are checked and counted, also if no way needs one.
        let share = ShareOfNodes { before: 0, own: 0, all: 0 };
        let (ids, mut none) = (NodeIds::new(Vec::new()), NodePlaces::new(0, reading.precedence()));
        source.read(reading, &ids, &share, &mut none)?;
        // Ways without nodes count, too.
        for (nodes, left_out) in nodes.iter_mut().zip(&mut left_out) {
            if let Some(ways) = left_out.take() {
                nodes.lengths = left_out_lengths(reading, ways, &ids, &none)?;
            }
        }
    }
    reading.tell(Step::Nodes, 1, 1);
    Ok(nodes)
}

/// Which part of all that names nodes a chunk is; for the progress.
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
) -> Result<u64, Failed> {
    let (Some(&least), Some(&most)) = (ids.ids().first(), ids.ids().last()) else { return Ok(0) };
    let own = IdRange { least, most };
    let numbers: Vec<usize> =
        node_blobs.iter().filter(|blob| blob.ids.meets(own)).map(|blob| blob.number).collect();
    let all_bytes = file.bytes_of(&numbers);
    let take = |_, found: Vec<FoundNode>| {
        found.into_iter().for_each(&mut *take);
        Ok(())
    };
    let scan = |block: Vec<u8>, most_bytes| {
        Ok(ids.scan(&Block::new(&block), most_bytes).ok_or(TOO_MUCH_FOUND)?)
    };
    file.for_each_block(reading, &numbers, &|bytes| on_bytes(bytes, all_bytes), scan, take)?;
    Ok(all_bytes)
}

/// How often the ways of a layer name a node.
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

    /// Whether a road names it.
    fn is_needed(self) -> bool {
        self.0 & 3 > 0
    }

    /// Whether it is a junction of roads, and whether it is one of roads and ways that carry them.
    fn is_junction(self) -> [bool; 2] {
        [self.0 & 3 == 2, self.0 >> 2 == 2]
    }
}

/// Some of the nodes that ways name, with neighbouring ids.
struct Chunk<'a> {
    ids: NodeIds,
    layers: Vec<Asked<'a>>,
    /// How often its nodes are named.
    named_count: u64,
}

/// The nodes of a chunk that a layer asks for.
struct Asked<'a> {
    /// How often its ways name a node.
    named: Vec<Named>,
    /// Numbers of the mentions, node by node.
    ///
    /// ```text
    ///  │ number: 63 bits │ 1 if it is the first one of its node │   if it is: │ how many nodes after the one before │
    /// ```
    visits: Spool<'a>,
    mentions_count: u64,
    /// The number of the node that was named last.
    last: u64,
}

impl<'a> Chunk<'a> {
    /// Takes the mentions of as many nodes as fit; `None` if there are no more. `most` mentions are to come.
    fn gather(
        reading: &Reading<'a>,
        asking: &mut [Asking<'a>],
        most: u64,
    ) -> Result<Option<Self>, Failed> {
        let most_ids = most_ids(reading, asking.len() as u64).min(most) as usize;
        // Of this size at once: lists that grow by doubling would take up to three times as much.
        let mut ids: Vec<i64> = Vec::with_capacity(most_ids);
        let mut layers: Vec<Asked<'_>> =
            asking.iter().map(|_| Asked::new(reading, most_ids)).collect();
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
        Ok(is_any.then(|| Self { ids: NodeIds::new(ids), layers, named_count: count }))
    }

    /// Takes the places that ways give for nodes of the chunk, in the order of the file: the places that hold for each layer whose ways give
    /// some. A layer does not depend on what ways of others say.
    fn take_located(
        &self,
        reading: &Reading<'_>,
        located: &mut Ahead<impl Iterator<Item = io::Result<Located>>>,
        places: &NodePlaces,
    ) -> Result<Vec<Option<NodePlaces>>, Failed> {
        let mut by_layer: Vec<Option<NodePlaces>> = self.layers.iter().map(|_| None).collect();
        let mut count = 0;
        while let Some(next) = located.peek()? {
            if self.ids.ids().last().is_some_and(|&last| next.node_id > last) {
                break;
            }
            // Not there: a duplicate named the node, and was left out.
            if let (Some(number), Some(own)) =
                (self.ids.number(next.node_id), by_layer.get_mut(usize::from(next.layer)))
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

impl<'a> Asked<'a> {
    fn new(reading: &Reading<'a>, most_ids: usize) -> Self {
        let visits = Spool::new(reading.request.scratch, reading.shares().visits);
        Self { named: Vec::with_capacity(most_ids), visits, mentions_count: 0, last: 0 }
    }

    /// Takes the mentions of the node with this id, which is the chunk's next.
    fn take(
        &mut self,
        reading: &Reading<'_>,
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

    /// Gives each mention the place of its node.
    fn answer(
        self,
        reading: &Reading<'_>,
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
