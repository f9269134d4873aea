//! Puts ways and the places of their nodes together, and makes roads of them.

use std::ops::Range;

use corniche_store::Sorted;
use rayon::prelude::*;

use crate::{
    ReadOsmError,
    assemble::{Assembled, PlainWay, assemble},
    read_request::Placing,
    reading::{Reading, Step},
    records::Stop,
    spool::{SpoolReader, damaged},
    way_bytes::take_way,
    wire::{varint, zigzag},
};

const WAYS_PER_TASK: usize = 256;
const TASKS_PER_THREAD: usize = 4;
/// An ordinary way has about ten nodes; with more, fewer ways are taken at a time.
const STOPS_PER_THREAD: usize = 16 * WAYS_PER_TASK * TASKS_PER_THREAD;

/// Hands what becomes of each way to `take`, in the order of the ways. They are made a few thousand at a time, so that the
/// roads of a country never lie in memory at once. While some are made, this thread hands out those before, and reads those that follow.
pub(crate) fn hand_out(
    reading: &Reading<'_>,
    mut ways: SpoolReader<'_>,
    ways_count: u64,
    mut stops: Sorted<'_, Stop>,
    take: &mut dyn FnMut(Assembled),
) -> Result<(), ReadOsmError> {
    let pool = reading.request.pool;
    let placing = reading.request.placing();
    let mut done = 0;
    let mut next = || Batch::read(reading, &mut ways, &mut stops, pool.current_num_threads());
    let mut batch = next()?;
    let mut before: Vec<Vec<Assembled>> = Vec::new();
    while !(batch.ways.is_empty() && before.is_empty()) {
        reading.check_stop()?;
        let mut assembled = Vec::new();
        let following = pool.in_place_scope(|scope| {
            scope.spawn(|_| {
                let tasks = batch.ways.par_chunks(WAYS_PER_TASK);
                assembled = tasks.map(|some| batch.assemble(some, placing)).collect();
            });
            let following = next();
            before.drain(..).flatten().for_each(&mut *take);
            following
        });
        let results: Result<Vec<_>, HandOutError> = assembled.into_iter().collect();
        before = results.map_err(|error| error.of(reading))?;
        done += batch.ways.len() as u64;
        reading.tell(Step::Roads, done, ways_count);
        batch = following?;
    }
    reading.tell(Step::Roads, 1, 1);
    Ok(())
}

/// Some ways, and the places of all their nodes.
#[derive(Default)]
struct Batch {
    ways: Vec<PackedWay>,
    /// What the ways are, as bytes.
    kinds: Vec<u8>,
    stops: Vec<Stop>,
}

/// A way of a batch.
struct PackedWay {
    way_id: i64,
    kind: Range<usize>,
    stops: Range<usize>,
}

enum HandOutError {
    Damaged,
    Osm(ReadOsmError),
}

impl HandOutError {
    fn of(self, reading: &Reading<'_>) -> ReadOsmError {
        match self {
            Self::Damaged => reading.scratch_failed(damaged()),
            Self::Osm(error) => error,
        }
    }
}

impl Batch {
    fn read(
        reading: &Reading<'_>,
        ways: &mut SpoolReader<'_>,
        stops: &mut Sorted<'_, Stop>,
        threads: usize,
    ) -> Result<Self, ReadOsmError> {
        let failed = |error| reading.scratch_failed(error);
        let mut batch = Self::default();
        while batch.ways.len() < threads * WAYS_PER_TASK * TASKS_PER_THREAD
            && batch.stops.len() < threads * STOPS_PER_THREAD
        {
            let kinds = &mut batch.kinds;
            let way = ways.next(|bytes| {
                let way_id = zigzag(varint(bytes).ok()?);
                let nodes = varint(bytes).ok()?;
                let length = varint(bytes).ok()?.try_into().ok()?;
                let (kind, rest) = bytes.split_at_checked(length)?;
                *bytes = rest;
                let first = kinds.len();
                kinds.extend(kind);
                Some((way_id, nodes, first..kinds.len()))
            });
            let Some((way_id, nodes, kind)) = way.map_err(failed)? else { break };
            let first = batch.stops.len();
            for _ in 0..nodes {
                let stop = stops.next().ok_or_else(damaged).map_err(failed)?;
                batch.stops.push(stop.map_err(failed)?);
            }
            let stops = first..batch.stops.len();
            batch.ways.push(PackedWay { way_id, kind, stops });
        }
        Ok(batch)
    }

    fn assemble(
        &self,
        some: &[PackedWay],
        placing: Placing<'_>,
    ) -> Result<Vec<Assembled>, HandOutError> {
        let plain = |way: &PackedWay| {
            let kind = take_way(&mut &self.kinds[way.kind.clone()])?;
            Some(PlainWay { way_id: way.way_id, kind, stops: way.stops.clone() })
        };
        let ways: Option<Vec<PlainWay>> = some.iter().map(plain).collect();
        assemble(&ways.ok_or(HandOutError::Damaged)?, &self.stops, placing)
            .map_err(HandOutError::Osm)
    }
}
