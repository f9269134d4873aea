//! Stores the roads and railways that spans depend on: bridges and tunnels themselves, and the
//! pieces of others that can carry, touch or cross them.
//!
//! They are taken from whole ways, independently of position and class, so the data about a bridge
//! do not depend on bounds, tiles and classes. Bridges and tunnels are skipped if neither they nor
//! any span that may depend on them reaches the data and the requested region.

use std::collections::BTreeMap;

use corniche_geom::{LatticePoint, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, MetNodes, Railway, Road, RoadAttributes, Structure};
use corniche_spans::{SpanLine, Vicinity, connected};
use corniche_spec::{
    BuildObserver,
    artifacts::{self, ArtifactKind},
};
use corniche_store::{Artifacts, ScratchSpace, record_bytes, take_record};
use serde::{Deserialize, Serialize};

use crate::{
    ExtractError,
    layers::{
        blocks::{ListBlockWriter, for_each_block},
        parts_by_tile::{EncodedPart, PartsByTile},
    },
};

/// Roads in a block of [`ArtifactKind::SpanRoads`]. The last block has fewer, possibly none: it
/// marks the list as complete.
const BLOCK_ROADS: usize = 4096;

/// A road near spans, or a piece of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NearRoad {
    /// The number of its road; `None` for a way that is not a road of the package: a railway, or a
    /// road whose class is off or unknown.
    pub ordinal: Option<u32>,
    /// The kind of railway, if it is one.
    pub railway: Option<Railway>,
    /// The way of the road.
    pub way_id: i64,
    /// The class of the road.
    pub class: FunctionalRoadClass,
    /// The structure of the road, one of [`Structure::ALL`].
    structure: Structure,
    layer: i8,
    highway: String,
    /// Whether its way reaches the data and the requested region.
    pub(crate) is_reached: bool,
    points: Vec<LatticePoint>,
    /// The true lengths of its segments, micrometres; empty for roads on the ground.
    pub(crate) segments_um: Vec<u64>,
    /// Its nodes at which roads may join: the indices of their points, and their ids.
    nodes: Vec<(u32, i64)>,
    /// Pairs of nodes at the same position; the first road stores all pairs.
    same_places: Vec<[i64; 2]>,
}

impl NearRoad {
    /// Creates the record of a whole road.
    #[must_use]
    pub fn from_road(
        road: &Road,
        ordinal: Option<u32>,
        segments_um: &[u64],
        is_reached: bool,
    ) -> Self {
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
            railway: None,
            way_id: road.way_id,
            class: road.class,
            structure,
            layer: road.attributes.layer,
            highway: road.attributes.highway.clone(),
            is_reached,
            points: road.line.points().to_vec(),
            segments_um: if is_span { segments_um.to_vec() } else { Vec::new() },
            nodes,
            same_places: [&road.same_places[..], &road.met.same_places].concat(),
        }
    }

    /// Creates the record of a whole way that is not a road of the package.
    #[must_use]
    pub fn of_carrier(
        road: &Road,
        railway: Option<Railway>,
        segments_um: &[u64],
        is_reached: bool,
    ) -> Self {
        Self { railway, ..Self::from_road(road, None, segments_um, is_reached) }
    }

    /// Returns the record as a road. Its ends are preserved, whether they are nodes or not.
    #[must_use]
    pub fn road(&self) -> Option<Road> {
        let last = self.points.len().checked_sub(1)? as u32;
        let mut stops: BTreeMap<u32, Option<i64>> = BTreeMap::from([(0, None), (last, None)]);
        stops.extend(self.nodes.iter().map(|&(index, node_id)| (index, Some(node_id))));
        Some(Road {
            way_id: self.way_id,
            class: self.class,
            attributes: RoadAttributes {
                structure: self.structure,
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
        self.structure != Structure::Ground
    }

    fn segments(&self) -> impl Iterator<Item = [LatticePoint; 2]> + '_ {
        self.points.array_windows().copied()
    }

    /// Returns the pieces that the requested segments of a road on the ground form; adjacent
    /// segments form one piece.
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

/// The position of a road among all roads: the roads of a way keep their order.
type RoadPlace = (i64, u64);

/// Receives all roads of the extract in any order, and stores those near bridges and tunnels.
pub struct NearRoadsWriter<'a> {
    count: u64,
    /// All roads on bridges and in tunnels; solving later holds them in memory, too.
    of_spans: Vec<(RoadPlace, NearRoad)>,
    others: PartsByTile<'a, RoadPlace>,
    same_places: Vec<[i64; 2]>,
}

impl<'a> NearRoadsWriter<'a> {
    /// Creates the writer; it sorts roads within `memory_bytes` of memory.
    pub fn new(scratch: &'a dyn ScratchSpace, memory_bytes: u64) -> Self {
        let others = PartsByTile::new(scratch, memory_bytes);
        Self { count: 0, of_spans: Vec::new(), others, same_places: Vec::new() }
    }

    /// Adds a road.
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

    /// Marks the bridges and tunnels of more ways as reached.
    pub fn reach(&mut self, is_reached: impl Fn(i64) -> bool) {
        for (_, road) in &mut self.of_spans {
            road.is_reached |= is_reached(road.way_id);
        }
    }

    /// Stores the roads near those bridges and tunnels that reach the requested region, or on which
    /// such spans depend. Roads within `reach` lattice steps of a node of these spans are near.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn finish(
        self,
        (store, observer): (&dyn Artifacts, &dyn BuildObserver),
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
        let mut blocks = ListBlockWriter::new(store, ArtifactKind::SpanRoads, BLOCK_ROADS);
        // The first road stores the pairs.
        let mut same_places = Some(same_places);
        let mut put = |road: NearRoad| {
            let same_places = same_places.take().unwrap_or_default();
            blocks.push(NearRoad { same_places, ..road })
        };
        let mut of_spans = of_spans.into_iter().peekable();
        let damaged =
            || artifacts::damaged(ArtifactKind::SpanRoads.item(0), &"its content is invalid");
        for part in others.sorted()? {
            observer.check()?;
            let EncodedPart { key: place, bytes, .. } = part?;
            let other: NearRoad = take_record(&mut &bytes[..]).ok_or_else(damaged)?;
            while let Some((_, road)) = of_spans.next_if(|(own, _)| *own < place) {
                put(road)?;
            }
            other.pieces(|ends| near.may_meet(ends)).into_iter().try_for_each(&mut put)?;
        }
        of_spans.try_for_each(|(_, road)| put(road))?;
        Ok(blocks.finish_with_mark()?)
    }
}

/// The bridges and tunnels that reach the requested region, and those on which they may depend.
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

/// Passes all roads near spans to `take`, in their order; memory holds one block of them.
///
/// # Errors
/// See [`ExtractError`].
pub fn for_each(store: &dyn Artifacts, mut take: impl FnMut(NearRoad)) -> Result<(), ExtractError> {
    for_each_block(store, ArtifactKind::SpanRoads, BLOCK_ROADS, |roads| {
        roads.into_iter().for_each(&mut take);
        Ok(())
    })
}

#[cfg(test)]
#[path = "near_spans_tests.rs"]
mod tests;
