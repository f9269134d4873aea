//! The roads of which bridges and tunnels are known: themselves, and the pieces of others that can carry, touch or cross them.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{LatticePoint, Polyline};
use corniche_roads::{FunctionalRoadClass, Road, RoadAttributes, Structure};
use corniche_spans::Vicinity;
use corniche_store::Artifacts;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::pieces::{RoadPiece, TilePieces};
use crate::{
    BuildError,
    artifacts::{self, Kind},
};

/// Roads of a block of [`Kind::SpanRoads`]. The last block has fewer, perhaps none: it says that all are there.
const BLOCK_ROADS: usize = 4096;
/// What a segment takes in memory, half of it room that lists have left, and what a road takes without them, bytes.
const SEGMENT_BYTES: u64 = 160;
const ROAD_BYTES: u64 = 320;
/// Tiles whose pieces are read side by side.
const TILES_AT_ONCE: usize = 8;

/// A piece of a road.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct NearRoad {
    /// The number of its road.
    pub(crate) ordinal: u32,
    pub(crate) way_id: i64,
    pub(crate) class: FunctionalRoadClass,
    /// Which of [`Structure::ALL`] it is on.
    structure: u8,
    layer: i8,
    highway: String,
    /// How far along its road it begins, micrometres.
    pub(crate) from_um: u64,
    points: Vec<LatticePoint>,
    /// The true lengths of its segments, micrometres.
    pub(crate) segments_um: Vec<u64>,
    /// Its nodes at which roads may join: which points they are, and their ids.
    nodes: Vec<(u32, i64)>,
    /// Pairs of nodes that lie at one place; all are told by the first road.
    same_places: Vec<[i64; 2]>,
}

impl NearRoad {
    /// The same as a road. Its ends stay, where they are nodes and where not.
    pub(crate) fn road(&self) -> Option<Road> {
        let last = self.points.len().checked_sub(1)? as u32;
        let mut stops: BTreeMap<u32, Option<i64>> = BTreeMap::from([(0, None), (last, None)]);
        stops.extend(self.nodes.iter().map(|&(index, node_id)| (index, Some(node_id))));
        Some(Road {
            way_id: self.way_id,
            class: self.class,
            attributes: RoadAttributes {
                structure: *Structure::ALL.get(usize::from(self.structure))?,
                layer: self.layer,
                highway: self.highway.clone(),
                ..RoadAttributes::default()
            },
            line: Polyline::new(self.points.clone()).ok()?,
            fixed: stops.keys().copied().collect(),
            node_ids: stops.values().copied().collect(),
            same_places: self.same_places.clone(),
        })
    }
}

/// A segment of a road.
struct Segment {
    /// Where along the road it begins and ends, micrometres.
    along_um: [u64; 2],
    ends: [LatticePoint; 2],
    nodes: [Option<i64>; 2],
}

/// What was found of a road.
struct Found {
    way_id: i64,
    class: FunctionalRoadClass,
    structure: Structure,
    layer: i8,
    highway: String,
    /// What lies on several tiles is there more than once.
    segments: Vec<Segment>,
}

/// Gathers the roads near all bridges and tunnels from the finest tiles with such, and keeps them. What lies within `reach` lattice steps of a
/// node of theirs is near. So many bytes of them are in memory at once, beside what some tiles have of them: of the rest the tiles are read again.
pub(crate) fn keep(
    (tiles, same_places): (&BTreeSet<u64>, &[[i64; 2]]),
    store: &dyn Artifacts,
    reach: f64,
    (pool, memory_bytes): (&rayon::ThreadPool, u64),
) -> Result<(), BuildError> {
    let tiles: Vec<u64> = tiles.iter().copied().collect();
    let mut blocks = BlocksWriter { store, block: Vec::new(), number: 0 };
    let mut same_places = Some(same_places.to_vec());
    let mut next = Some(0);
    while let Some(first) = next {
        let mut some = SomeRoads::default();
        for tiles in tiles.chunks(TILES_AT_ONCE) {
            let found: Result<Vec<_>, BuildError> = pool.install(|| {
                tiles.par_iter().map(|&tile| in_tile((tile, first), store, reach)).collect()
            });
            for (ordinal, own) in found?.into_iter().flatten() {
                some.add(ordinal, own);
                some.shrink(memory_bytes);
            }
        }
        for (ordinal, found) in some.roads {
            for mut road in joined(ordinal, found) {
                road.same_places = same_places.take().unwrap_or_default();
                blocks.push(road)?;
            }
        }
        next = some.rest;
    }
    blocks.finish()
}

/// Roads in their order, as many as have room.
#[derive(Default)]
struct SomeRoads {
    roads: BTreeMap<u32, Found>,
    segments: u64,
    /// The first road that has no room.
    rest: Option<u32>,
}

impl SomeRoads {
    fn add(&mut self, ordinal: u32, own: Found) {
        if self.rest.is_some_and(|rest| ordinal >= rest) {
            return;
        }
        self.segments += own.segments.len() as u64;
        match self.roads.get_mut(&ordinal) {
            Some(known) => known.segments.extend(own.segments),
            None => drop(self.roads.insert(ordinal, own)),
        }
    }

    /// Leaves out the last roads until there is room for the others; one has room always.
    fn shrink(&mut self, memory_bytes: u64) {
        let bytes =
            |segments: u64, roads: usize| segments * SEGMENT_BYTES + roads as u64 * ROAD_BYTES;
        while bytes(self.segments, self.roads.len()) > memory_bytes && self.roads.len() > 1 {
            let Some((ordinal, last)) = self.roads.pop_last() else { return };
            self.segments -= last.segments.len() as u64;
            self.rest = Some(ordinal);
        }
    }
}

/// Puts roads into the store, block by block.
struct BlocksWriter<'a> {
    store: &'a dyn Artifacts,
    block: Vec<NearRoad>,
    number: u64,
}

impl BlocksWriter<'_> {
    fn push(&mut self, road: NearRoad) -> Result<(), BuildError> {
        self.block.push(road);
        if self.block.len() == BLOCK_ROADS { self.put() } else { Ok(()) }
    }

    fn put(&mut self) -> Result<(), BuildError> {
        artifacts::put(self.store, Kind::SpanRoads.item(self.number), &self.block)?;
        self.number += 1;
        self.block.clear();
        Ok(())
    }

    fn finish(mut self) -> Result<(), BuildError> {
        self.put()
    }
}

/// Hands all roads near spans to `take`, in their order; one block of them is in memory.
pub(crate) fn for_each(
    store: &dyn Artifacts,
    mut take: impl FnMut(NearRoad),
) -> Result<(), BuildError> {
    for block in 0.. {
        let key = Kind::SpanRoads.item(block);
        let own: Option<Vec<NearRoad>> = artifacts::get(store, key)?;
        let own = own.ok_or_else(|| artifacts::damaged(key, &"it is missing"))?;
        let is_last = own.len() < BLOCK_ROADS;
        own.into_iter().for_each(&mut take);
        if is_last {
            break;
        }
    }
    Ok(())
}

/// What a finest tile has of bridges, tunnels and roads near them, from a road on.
fn in_tile(
    (tile, first): (u64, u32),
    store: &dyn Artifacts,
    reach: f64,
) -> Result<Vec<(u32, Found)>, BuildError> {
    let id = artifacts::tile_of(Kind::RoadPieces.item(tile))?;
    let pieces = TilePieces::load(store, id)?;
    let (of_spans, others): (Vec<_>, Vec<_>) = pieces
        .roads
        .into_iter()
        .partition(|(_, road)| road.attributes.structure != Structure::Ground);
    let of_spans: Vec<(u32, Found)> =
        of_spans.into_iter().map(|(ordinal, road)| (ordinal, Found::of(road, |_| true))).collect();
    let segments = || of_spans.iter().flat_map(|(_, found)| &found.segments);
    let nodes = segments().flat_map(|segment| {
        let both = segment.ends.into_iter().zip(segment.nodes);
        both.filter_map(|(at, node)| node.map(|_| at))
    });
    let near = Vicinity::new(segments().map(|segment| segment.ends), nodes, reach);
    let near_ones =
        others.into_iter().filter(|(ordinal, _)| *ordinal >= first).map(|(ordinal, road)| {
            let found = Found::of(road, |ends| near.may_meet(ends));
            (ordinal, found)
        });
    let near_ones: Vec<(u32, Found)> =
        near_ones.filter(|(_, found)| !found.segments.is_empty()).collect();
    let all = of_spans.into_iter().chain(near_ones);
    Ok(all.filter(|(ordinal, _)| *ordinal >= first).collect())
}

impl Found {
    /// The segments of a road that are wanted.
    fn of(mut road: RoadPiece, is_wanted: impl Fn([LatticePoint; 2]) -> bool) -> Self {
        let mut segments = Vec::new();
        for run in std::mem::take(&mut road.runs) {
            let mut from_um = run.from_um;
            let mut nodes = run.nodes.iter().peekable();
            let mut node_at = |index: usize| {
                while nodes.next_if(|(at, _)| (*at as usize) < index).is_some() {}
                nodes.peek().filter(|(at, _)| *at as usize == index).map(|(_, id)| *id)
            };
            for (index, (&ends, &length_um)) in
                run.line.points().array_windows().zip(&run.segments_um).enumerate()
            {
                let to_um = from_um + length_um;
                let nodes = [node_at(index), node_at(index + 1)];
                if is_wanted(ends) {
                    segments.push(Segment { along_um: [from_um, to_um], ends, nodes });
                }
                from_um = to_um;
            }
        }
        Self {
            way_id: road.way_id,
            class: road.class,
            structure: road.attributes.structure,
            layer: road.attributes.layer,
            highway: road.attributes.highway.clone(),
            segments,
        }
    }
}

/// The pieces of a road that its segments make, those that follow each other together.
fn joined(ordinal: u32, mut found: Found) -> Vec<NearRoad> {
    found.segments.sort_unstable_by_key(|segment| segment.along_um);
    found.segments.dedup_by_key(|segment| segment.along_um);
    let mut pieces: Vec<NearRoad> = Vec::new();
    let mut before = None;
    for segment in &found.segments {
        let ([from_um, to_um], [from, to]) = (segment.along_um, segment.ends);
        if before != Some((from_um, from)) {
            pieces.push(NearRoad {
                ordinal,
                way_id: found.way_id,
                class: found.class,
                structure: found.structure as u8,
                layer: found.layer,
                highway: found.highway.clone(),
                from_um,
                points: vec![from],
                segments_um: Vec::new(),
                nodes: segment.nodes[0].map(|id| (0, id)).into_iter().collect(),
                same_places: Vec::new(),
            });
        }
        if let Some(piece) = pieces.last_mut() {
            let index = piece.points.len() as u32;
            piece.nodes.extend(segment.nodes[1].map(|id| (index, id)));
            piece.points.push(to);
            piece.segments_um.push(to_um - from_um);
        }
        before = Some((to_um, to));
    }
    pieces
}

#[cfg(test)]
#[path = "near_spans_tests.rs"]
mod tests;
