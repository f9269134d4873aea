//! The roads of which bridges and tunnels are known: themselves, and the pieces of others that can carry, touch or cross them.
//!
//! They are taken from whole roads, wherever these lie and whatever their classes, so what is known of a bridge does not depend on bounds, tiles and
//! classes. Left out are bridges and tunnels that depend on none that reaches the data and what was asked of it.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, MetNodes, Road, RoadAttributes, Structure};
use corniche_spans::{SpanLine, Vicinity, connected};
use corniche_spec::{
    Observer,
    artifacts::{self, Kind},
};
use corniche_store::{Artifacts, Scratch, record_bytes, take_record};
use serde::{Deserialize, Serialize};

use crate::{
    ExtractError,
    layers::{
        blocks::{BlockWriter, for_each_block},
        parts_by_tile::PartsByTile,
    },
};

/// Roads of a block of [`Kind::SpanRoads`]. The last block has fewer, perhaps none: it says that all are there.
const BLOCK_ROADS: usize = 4096;

/// A piece of a road.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NearRoad {
    /// The number of its road; `None` of a way whose class is off or not known, which is no road of the package.
    pub ordinal: Option<u32>,
    /// The way of the road.
    pub way_id: i64,
    /// The class of the road.
    pub class: FunctionalRoadClass,
    /// Which of [`Structure::ALL`] it is on.
    structure: u8,
    layer: i8,
    highway: String,
    /// Whether its way reaches the data, and what was asked of it.
    pub(crate) is_reached: bool,
    points: Vec<LatticePoint>,
    /// The true lengths of its segments, micrometres; of roads on the ground none.
    pub(crate) segments_um: Vec<u64>,
    /// Its nodes at which roads may join: which points they are, and their ids.
    nodes: Vec<(u32, i64)>,
    /// Pairs of nodes that lie at one place; all are told by the first road.
    same_places: Vec<[i64; 2]>,
}

impl NearRoad {
    /// A whole road.
    #[must_use]
    pub fn of(road: &Road, ordinal: Option<u32>, segments_um: &[u64], is_reached: bool) -> Self {
        let fixed = road.fixed.iter().zip(&road.node_ids);
        let mut nodes: Vec<(u32, i64)> =
            fixed.filter_map(|(&index, id)| Some((index, (*id)?))).collect();
        nodes.extend(&road.met.nodes);
        nodes.sort_unstable();
        nodes.dedup();
        let structure = road.attributes.structure;
        let is_span = structure != Structure::Ground;
        Self {
            ordinal,
            way_id: road.way_id,
            class: road.class,
            structure: structure as u8,
            layer: road.attributes.layer,
            highway: road.attributes.highway.clone(),
            is_reached,
            points: road.line.points().to_vec(),
            segments_um: if is_span { segments_um.to_vec() } else { Vec::new() },
            nodes,
            same_places: [&road.same_places[..], &road.met.same_places].concat(),
        }
    }

    /// The same as a road. Its ends stay, where they are nodes and where not.
    #[must_use]
    pub fn road(&self) -> Option<Road> {
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
            met: MetNodes::default(),
        })
    }

    fn is_span(&self) -> bool {
        self.structure != Structure::Ground as u8
    }

    fn segments(&self) -> impl Iterator<Item = [LatticePoint; 2]> + '_ {
        self.points.array_windows().copied()
    }

    /// The pieces of a road on the ground that its wanted segments make, those that follow each other together.
    fn pieces(&self, is_wanted: impl Fn([LatticePoint; 2]) -> bool) -> Vec<Self> {
        let wanted: Vec<bool> = self.segments().map(is_wanted).collect();
        let mut pieces = Vec::new();
        let mut first = 0;
        for run in wanted.chunk_by(PartialEq::eq) {
            let last = first + run.len();
            if run[0] {
                let of_run = |&(index, id): &(u32, i64)| {
                    let at = (index as usize).checked_sub(first)?;
                    (at <= run.len()).then_some((at as u32, id))
                };
                pieces.push(Self {
                    points: self.points[first..=last].to_vec(),
                    nodes: self.nodes.iter().filter_map(of_run).collect(),
                    highway: self.highway.clone(),
                    segments_um: Vec::new(),
                    same_places: Vec::new(),
                    ..*self
                });
            }
            first = last;
        }
        pieces
    }
}

/// Where among all roads a road comes: those of a way stay in their order.
type RoadPlace = (i64, u64);

/// Takes all roads of the extract in any order, and keeps those near bridges and tunnels.
pub struct NearRoadsWriter<'a> {
    count: u64,
    /// All on bridges and in tunnels; what is known of them is in memory later, too.
    of_spans: Vec<(RoadPlace, NearRoad)>,
    others: PartsByTile<'a, RoadPlace>,
    same_places: Vec<[i64; 2]>,
}

impl<'a> NearRoadsWriter<'a> {
    /// Roads are sorted within `memory_bytes`.
    pub fn new(scratch: &'a dyn Scratch, memory_bytes: u64) -> Self {
        let others = PartsByTile::new(scratch, memory_bytes);
        Self { count: 0, of_spans: Vec::new(), others, same_places: Vec::new() }
    }

    /// Takes a road.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn push(&mut self, mut road: NearRoad) -> Result<(), ExtractError> {
        self.same_places.append(&mut road.same_places);
        let place = (road.way_id, self.count);
        self.count += 1;
        if road.is_span() {
            self.of_spans.push((place, road));
            return Ok(());
        }
        self.others.push(TileId::ROOT, place, record_bytes(&road))
    }

    /// Counts bridges and tunnels of more ways as reached.
    pub fn reach(&mut self, is_reached: impl Fn(i64) -> bool) {
        for (_, road) in &mut self.of_spans {
            road.is_reached |= is_reached(road.way_id);
        }
    }

    /// Keeps what lies near bridges and tunnels that reach what was asked for, or that others depend on which do. What lies within `reach` lattice steps of
    /// a node of theirs is near.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn finish(
        self,
        (store, observer): (&dyn Artifacts, &dyn Observer),
        reach: f64,
    ) -> Result<(), ExtractError> {
        let Self { mut of_spans, others, same_places, .. } = self;
        of_spans.sort_unstable_by_key(|(place, _)| *place);
        let of_spans = needed(of_spans, &same_places);
        let segments = of_spans.iter().flat_map(|(_, road)| road.segments());
        let nodes = of_spans
            .iter()
            .flat_map(|(_, road)| road.nodes.iter().map(|&(index, _)| road.points[index as usize]));
        let near = Vicinity::new(segments, nodes, reach);
        let mut blocks = BlockWriter::new(store, Kind::SpanRoads, BLOCK_ROADS);
        // The first road tells them.
        let mut same_places = Some(same_places);
        let mut put = |road: NearRoad| {
            let same_places = same_places.take().unwrap_or_default();
            blocks.push(NearRoad { same_places, ..road })
        };
        let mut of_spans = of_spans.into_iter().peekable();
        let damaged = || artifacts::damaged(Kind::SpanRoads.item(0), &"it makes no sense");
        others.for_each_tile(
            observer,
            |(): &mut (), _, place, bytes| {
                let other: NearRoad = take_record(&mut &*bytes).ok_or_else(damaged)?;
                while let Some((_, road)) = of_spans.next_if(|(own, _)| *own < place) {
                    put(road)?;
                }
                let pieces = other.pieces(|ends| near.may_meet(ends));
                Ok(pieces.into_iter().try_for_each(&mut put)?)
            },
            |_, ()| Ok(()),
        )?;
        of_spans.try_for_each(|(_, road)| put(road))?;
        Ok(blocks.finish_with_mark()?)
    }
}

/// The bridges and tunnels that reach what was asked for, and those on which they may depend.
fn needed(all: Vec<(RoadPlace, NearRoad)>, same_places: &[[i64; 2]]) -> Vec<(RoadPlace, NearRoad)> {
    if all.iter().all(|(_, road)| road.is_reached) {
        return all;
    }
    let lines: Vec<SpanLine<'_>> =
        all.iter().map(|(_, road)| SpanLine { points: &road.points, nodes: &road.nodes }).collect();
    let groups = connected(&lines, same_places);
    let mut is_needed = vec![false; all.len()];
    for ((_, road), &group) in all.iter().zip(&groups) {
        is_needed[group] |= road.is_reached;
    }
    let needed = all.into_iter().zip(groups).filter(|(_, group)| is_needed[*group]);
    needed.map(|(road, _)| road).collect()
}

/// Hands all roads near spans to `take`, in their order; one block of them is in memory.
///
/// # Errors
/// See [`ExtractError`].
pub fn for_each(store: &dyn Artifacts, mut take: impl FnMut(NearRoad)) -> Result<(), ExtractError> {
    for_each_block(store, Kind::SpanRoads, BLOCK_ROADS, |roads| {
        roads.into_iter().for_each(&mut take);
        Ok(())
    })
}

#[cfg(test)]
#[path = "near_spans_tests.rs"]
mod tests;
