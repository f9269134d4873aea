//! The lengths of skipped ways, for extracts whose requested nodes all fit in memory.
//!
//! Only the length of a skipped way is needed. So its nodes need no numbers, and their positions
//! need not be sorted by way: each position is looked up. This takes a third to a half less time
//! than the treatment of road nodes.

use std::{collections::BTreeMap, io, ops::Range};

use corniche_store::Sorter;
use rayon::prelude::*;

use crate::{
    LeftOutReason, LeftOutWays,
    assemble::length_um,
    failed::Failed,
    id_index::IdIndex,
    nodes::NodePlaces,
    reading::ExtractReading,
    records::SoughtId,
    spool::{Spool, damaged},
    way_bytes::{LeftOutWay, take_left_out, take_node_ids},
    wire::{push_bytes, take_bytes},
};

/// The number and the length of ways, by reason and `highway` value.
pub(crate) type Lengths = BTreeMap<(LeftOutReason, String), LeftOutWays>;

/// Skipped ways, and the nodes that they reference.
pub(crate) struct LeftOutNodes<'a> {
    /// The length of each way's bytes, then the bytes; see [`crate::way_bytes`].
    pub(crate) ways: Spool<'a>,
    pub(crate) ids: Sorter<'a, SoughtId>,
    pub(crate) ids_count: u64,
}

impl<'a> LeftOutNodes<'a> {
    pub(crate) fn new(reading: &ExtractReading<'a>) -> Self {
        let shares = reading.shares();
        // The memory for visits is free, because skipped ways have no visits.
        let ways = Spool::new(reading.request.scratch, shares.visits);
        Self { ways, ids: reading.sorter(shares.mentions), ids_count: 0 }
    }

    pub(crate) fn push(&mut self, way: &[u8], node_ids: &[i64]) -> io::Result<()> {
        let mut last = None;
        for &id in node_ids {
            if last.replace(id) != Some(id) {
                self.ids.push(SoughtId(id))?;
                self.ids_count += 1;
            }
        }
        self.ways.push(|bytes| push_bytes(bytes, way))
    }
}

/// Adds up the lengths of ways from the positions of their nodes.
pub(crate) fn left_out_lengths(
    reading: &ExtractReading<'_>,
    ways: Spool<'_>,
    ids: &[i64],
    places: &NodePlaces,
) -> Result<Lengths, Failed> {
    const WAYS_PER_TASK: usize = 256;
    const BATCH_BYTES: usize = 1 << 20;
    let mut ways = ways.read();
    let mut lengths = Lengths::new();
    let index = IdIndex::new(ids);
    let (mut bytes, mut own): (Vec<u8>, Vec<Range<usize>>) = Default::default();
    loop {
        reading.check_stop()?;
        bytes.clear();
        own.clear();
        while bytes.len() < BATCH_BYTES {
            let take = |page: &mut &[u8]| {
                let first = bytes.len();
                bytes.extend(take_bytes(page)?);
                Some(first..bytes.len())
            };
            let Some(way) = ways.next(take)? else { break };
            own.push(way);
        }
        if own.is_empty() {
            return Ok(lengths);
        }
        let found: Vec<Option<BTreeMap<_, _>>> = reading.request.pool.install(|| {
            let tasks = own.par_chunks(WAYS_PER_TASK);
            tasks.map(|some| add_up(some, &bytes, &index, places)).collect()
        });
        for found in found {
            for ((reason, highway), found) in found.ok_or_else(damaged)? {
                let all = lengths.entry((reason, highway.to_owned())).or_default();
                all.ways += found.ways;
                all.length_um += found.length_um;
            }
        }
    }
}

/// Adds up the lengths of some ways; `None` if their bytes are corrupt.
fn add_up<'b>(
    some: &[Range<usize>],
    bytes: &'b [u8],
    ids: &IdIndex<'_>,
    places: &NodePlaces,
) -> Option<BTreeMap<(LeftOutReason, &'b str), LeftOutWays>> {
    let mut lengths: BTreeMap<_, LeftOutWays> = BTreeMap::new();
    let mut number = 0;
    let mut locations = Vec::new();
    for way in some {
        let mut way = &bytes[way.clone()];
        locations.clear();
        take_node_ids(&mut way, |id| {
            number = ids.find(id, number).ok_or_else(damaged)?;
            locations.push(places.location(number));
            Ok(())
        })
        .ok()?;
        let LeftOutWay { reason, highway, .. } = take_left_out(&mut way)?;
        let own = lengths.entry((reason, highway)).or_default();
        own.ways += 1;
        own.length_um += length_um(locations.iter().copied());
    }
    Some(lengths)
}
