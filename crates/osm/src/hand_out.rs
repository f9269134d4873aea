//! Puts ways and the places of their nodes together, and makes roads of them.

use corniche_store::Sorted;
use rayon::prelude::*;

use crate::{
    ReadOsmError,
    assemble::{Assembled, PlainWay, assemble},
    reading::{Reading, Step},
    records::Stop,
    spool::{SpoolReader, damaged},
    way_bytes::take_way,
    wire::{varint, zigzag},
};

const WAYS_PER_TASK: usize = 256;
const TASKS_PER_THREAD: usize = 8;
/// An ordinary way has about ten nodes; with more, fewer ways are taken at a time.
const STOPS_PER_THREAD: usize = 16 * WAYS_PER_TASK * TASKS_PER_THREAD;

/// Hands what becomes of each way to `take`, in the order of the ways. They are made a few thousand at a time, so that the
/// roads of a country never lie in memory at once.
pub(crate) fn hand_out(
    reading: &Reading<'_>,
    mut ways: SpoolReader<'_>,
    ways_count: u64,
    mut stops: Sorted<'_, Stop>,
    take: &mut dyn FnMut(Assembled),
) -> Result<(), ReadOsmError> {
    let pool = reading.request.pool;
    let place = reading.request.place;
    let mut done = 0;
    loop {
        reading.check_stop()?;
        let batch = Batch::read(reading, &mut ways, &mut stops, pool.current_num_threads())?;
        if batch.ways.is_empty() {
            reading.tell(Step::Roads, 1, 1);
            return Ok(());
        }
        let assembled: Vec<_> = pool.install(|| {
            let tasks = batch.ways.par_chunks(WAYS_PER_TASK);
            tasks.map(|some| assemble(some, &batch.stops, place)).collect()
        });
        for some in assembled {
            some?.into_iter().for_each(&mut *take);
        }
        done += batch.ways.len() as u64;
        reading.tell(Step::Roads, done, ways_count);
    }
}

/// Some ways, and the places of all their nodes.
#[derive(Default)]
struct Batch {
    ways: Vec<PlainWay>,
    stops: Vec<Stop>,
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
            let way = ways.next(|bytes| {
                let way_id = zigzag(varint(bytes).ok()?);
                let nodes = varint(bytes).ok()?;
                Some((way_id, nodes, take_way(bytes)?))
            });
            let Some((way_id, nodes, kind)) = way.map_err(failed)? else { break };
            let first = batch.stops.len();
            for _ in 0..nodes {
                let stop = stops.next().ok_or_else(damaged).map_err(failed)?;
                batch.stops.push(stop.map_err(failed)?);
            }
            let stops = first..batch.stops.len();
            batch.ways.push(PlainWay { way_id, kind, stops });
        }
        Ok(batch)
    }
}
