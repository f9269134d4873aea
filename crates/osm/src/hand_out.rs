//! Combines ways with the positions of their nodes, and builds roads from them.

use std::{io, ops::Range};

use corniche_roads::Road;
use corniche_store::Sorted;
use rayon::prelude::*;

use crate::{
    ExtractDefect, ExtractSummary, LeftOut, ReadOsmError,
    assemble::{AssembledWay, PlainWay, assemble},
    deferred::Deferred,
    failed::Failed,
    layer_sink::LayerSink,
    locate_nodes::LocatedNodes,
    number_nodes::{NumberedWays, take_numbered},
    read_request::LatticePlacement,
    reading::ExtractReading,
    records::Stop,
    spool::{SpoolReader, damaged},
    way_bytes::{take_node_ids, take_way},
};

const WAYS_PER_TASK: usize = 256;
const TASKS_PER_THREAD: usize = 4;
/// The number of stops per thread and batch. An ordinary way has about ten nodes; if ways have
/// more, a batch contains fewer ways.
const STOPS_PER_THREAD: usize = 16 * WAYS_PER_TASK * TASKS_PER_THREAD;

/// The ways of roads with the positions of their nodes, their counts and their defects.
pub(crate) struct RoadWays<'a> {
    pub(crate) ways: SpoolReader<'a>,
    pub(crate) ways_count: u64,
    pub(crate) stops: Sorted<'a, Stop>,
    pub(crate) summary: ExtractSummary,
    pub(crate) defects: Deferred<'a>,
}

impl<'a> RoadWays<'a> {
    /// Combines the ways, their number and the number of duplicate ids with the positions of the
    /// nodes.
    pub(crate) fn from_parts(
        NumberedWays { ways, count: ways_count, duplicates }: NumberedWays<'a>,
        nodes: LocatedNodes<'a>,
        mut summary: ExtractSummary,
        defects: Deferred<'a>,
    ) -> io::Result<Self> {
        let LocatedNodes { stops, needed, missing, lengths } = nodes;
        summary.left_out_ways = lengths;
        summary.left_out.duplicate = duplicates;
        (summary.nodes_needed, summary.nodes_missing) = (needed, missing);
        let stops = stops.finish()?;
        Ok(Self { ways, ways_count, stops, summary, defects })
    }
}

/// Delivers roads and defects in the order of the ways, and counts the results.
pub(crate) fn hand_out_roads(
    reading: &ExtractReading<'_>,
    found: RoadWays<'_>,
    sink: &mut dyn LayerSink<Road, ExtractSummary>,
    on_defect: &mut dyn FnMut(ExtractDefect),
) -> Result<(), Failed> {
    let RoadWays { mut ways, ways_count, mut stops, mut summary, defects } = found;
    sink.begin();
    defects.tell(on_defect)?;
    let take = |assembled: AssembledWay, sink: &mut dyn LayerSink<Road, ExtractSummary>| {
        let AssembledWay { roads, railway, defects, left_out } = assembled;
        let is_road = left_out.is_none() && railway.is_none();
        if let Some((reason, highway, length_um)) = left_out {
            let own = summary.left_out_ways.entry((reason, highway)).or_default();
            own.ways += 1;
            own.length_um += length_um;
        }
        if !is_road {
            for road in roads {
                sink.take_carrier(road, railway);
            }
            return;
        }
        summary.roads += roads.len() as u64;
        let LeftOut { without_line, .. } = &mut summary.left_out;
        *(if roads.is_empty() { without_line } else { &mut summary.road_ways }) += 1;
        defects.into_iter().for_each(&mut *on_defect);
        for road in roads {
            sink.take(road);
        }
    };
    hand_out(reading, (&mut ways, ways_count), &mut stops, sink, take)?;
    sink.end(summary);
    Ok(())
}

/// Passes the result of each way to `take`, in the order of the ways. Ways are assembled a few
/// thousand at a time, so that the roads of a country are never in memory together. While one batch
/// is assembled, this thread delivers the previous batch and reads the next one.
fn hand_out(
    reading: &ExtractReading<'_>,
    (ways, ways_count): (&mut SpoolReader<'_>, u64),
    stops: &mut Sorted<'_, Stop>,
    sink: &mut dyn LayerSink<Road, ExtractSummary>,
    mut take: impl FnMut(AssembledWay, &mut dyn LayerSink<Road, ExtractSummary>),
) -> Result<(), Failed> {
    let pool = reading.request.pool;
    let placing = reading.request.placing();
    let with_ids = reading.request.node_ids;
    let mut done = 0;
    let mut next = || Batch::read(ways, stops, pool.current_num_threads());
    let mut batch = next()?;
    let mut before: Vec<Vec<AssembledWay>> = Vec::new();
    while !(batch.ways.is_empty() && before.is_empty()) {
        reading.check_stop()?;
        let mut assembled = Vec::new();
        let following = pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                let tasks = batch.ways.par_chunks(WAYS_PER_TASK);
                assembled = tasks.map(|some| batch.assemble(some, with_ids, placing)).collect();
            });
            let following = next();
            before.drain(..).flatten().for_each(|assembled| take(assembled, sink));
            following
        });
        let made = |some: Option<Result<_, _>>| -> Result<Vec<AssembledWay>, Failed> {
            Ok(some.ok_or_else(damaged)??)
        };
        before = assembled.into_iter().map(made).collect::<Result<_, _>>()?;
        done += batch.ways.len() as u64;
        sink.reached(done, ways_count);
        batch = following?;
    }
    Ok(())
}

/// Some ways, and the positions of all their nodes.
#[derive(Default)]
struct Batch {
    ways: Vec<PackedWay>,
    /// The properties of the ways, as bytes.
    kinds: Vec<u8>,
    stops: Vec<Stop>,
}

/// A way of a batch.
struct PackedWay {
    way_id: i64,
    kind: Range<usize>,
    stops: Range<usize>,
}

impl Batch {
    fn read(
        ways: &mut SpoolReader<'_>,
        stops: &mut Sorted<'_, Stop>,
        threads: usize,
    ) -> io::Result<Self> {
        let mut batch = Self::default();
        while batch.ways.len() < threads * WAYS_PER_TASK * TASKS_PER_THREAD
            && batch.stops.len() < threads * STOPS_PER_THREAD
        {
            let kinds = &mut batch.kinds;
            let way = ways.next(|bytes| {
                let (way_id, nodes, kind) = take_numbered(bytes)?;
                let first = kinds.len();
                kinds.extend(kind);
                Some((way_id, nodes, first..kinds.len()))
            });
            let Some((way_id, nodes, kind)) = way? else { break };
            let first = batch.stops.len();
            for _ in 0..nodes {
                let stop = stops.next().ok_or_else(damaged)?;
                batch.stops.push(stop?);
            }
            let stops = first..batch.stops.len();
            batch.ways.push(PackedWay { way_id, kind, stops });
        }
        Ok(batch)
    }

    /// Assembles the ways; `None` if their stored bytes are corrupt.
    fn assemble(
        &self,
        some: &[PackedWay],
        with_ids: bool,
        placing: LatticePlacement<'_>,
    ) -> Option<Result<Vec<AssembledWay>, ReadOsmError>> {
        let plain = |way: &PackedWay| {
            let mut bytes = &self.kinds[way.kind.clone()];
            let mut node_ids = Vec::new();
            if with_ids {
                let mut take = |id| {
                    node_ids.push(id);
                    Ok(())
                };
                take_node_ids(&mut bytes, &mut take).ok()?;
            }
            let kind = take_way(&mut bytes)?;
            Some(PlainWay { way_id: way.way_id, kind, node_ids, stops: way.stops.clone() })
        };
        let ways = some.iter().map(plain).collect::<Option<_>>()?;
        Some(assemble(ways, &self.stops, placing))
    }
}
