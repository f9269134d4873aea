//! The network of bridges, tunnels and the roads and railways near them, with the position of each
//! stretch along its road.

use std::{collections::HashMap, sync::Arc};

use corniche_drape::OwnedBorders;
use corniche_geom::{GridFrame, LatticeBounds, LatticePoint, Projection, known_line_length_m};
use corniche_network::{Breaks, ChainNumber, Chains, Network, NetworkBuilder};
use corniche_spans::{Crossing, Crossings, Decks, Order, Spans, crossings};
use corniche_spec::true_lengths::TrueLengths;
use corniche_store::Artifacts;

use crate::{
    ExtractError,
    layers::{fixed_points::road_of_part, span_pieces::CarriedLine},
    roads::near_spans::{self, NearRoad},
};

/// The sources of bridges and tunnels.
#[derive(Clone, Copy)]
pub struct SpanInputs<'a> {
    /// The store with the roads near spans and the ground beneath them; the sections are written to
    /// it.
    pub store: &'a dyn Artifacts,
    /// The package's grid.
    pub frame: &'a GridFrame,
    /// Measures lengths. The table of a package is not used, because lengths must not depend on the
    /// table's extent.
    pub projection: &'a (dyn Projection + Sync),
    /// The rectangle of the whole elevation data, regardless of the requested bounds: roads end
    /// there.
    pub whole: LatticeBounds,
}

/// A position along a road or a line of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OnCarriedLine {
    /// The line.
    pub line: CarriedLine,
    /// Distance along the line, micrometres.
    pub along_um: u64,
}

/// Bridges and tunnels of a build, before their heights are known.
pub struct SpanNetwork {
    /// Stretches in the order of their lines, and along each line.
    stretches: Vec<Stretch>,
    /// Bridges and tunnels with their junctions.
    pub spans: Arc<Spans>,
    pub(crate) crossings: Crossings,
    /// For each span, whether it has a road of the package, and whether it has a railway, that
    /// reaches the requested region: only these spans are counted.
    pub(crate) is_counted: Vec<[bool; 2]>,
    /// The ways of the counted spans, ascending.
    pub(crate) counted_ways: Vec<i64>,
    /// For each span, the segments of its roads.
    segments: Vec<Vec<[LatticePoint; 2]>>,
    /// For each span, the spans on whose heights its own depend: it is lifted over them or lowered
    /// beneath them.
    depends_on: Vec<Vec<usize>>,
    /// For each span, whether it, or one that depends on it, reaches the requested region.
    is_needed: Vec<bool>,
}

/// A place where spans need ground.
pub struct SpanPlace {
    pub(crate) at: LatticePoint,
    /// The span that depends on it; `None` if no such span reaches the requested region.
    pub(crate) span: Option<usize>,
}

/// A stretch of a bridge or a tunnel between two nodes at which roads may join.
struct Stretch {
    line: CarriedLine,
    from_um: u64,
    to_um: u64,
    chain: ChainNumber,
    /// Positions of its ends along the chain (roads joined end to end), metres: those at `from_um`
    /// and `to_um`.
    on_chain_m: [f64; 2],
}

impl SpanNetwork {
    /// Finds the spans of the stored roads.
    ///
    /// # Errors
    /// See [`ExtractError`].
    pub fn load(inputs: &SpanInputs<'_>) -> Result<Self, ExtractError> {
        let (network, places) = network(inputs)?;
        let chains = Chains::from_network(&network, Breaks::JunctionsAndStructures);
        let known = degrees_of(&network, inputs)?;
        let projected = |at_m: [f64; 2]| {
            let mut position = [at_m];
            let found = inputs.projection.wgs84_from_working(&mut position);
            found.map_or([f64::NAN; 2], |()| position[0])
        };
        let distance_m = |from: [f64; 2], to: [f64; 2]| {
            let ends_m = [from, to].map(|at| inputs.frame.position_of_fraction_m(at));
            let of_point = |at: [f64; 2]| known.get(&at.map(f64::to_bits)).copied();
            let [from, to] = [of_point(from), of_point(to)];
            let ends_deg = [
                from.unwrap_or_else(|| projected(ends_m[0])),
                to.unwrap_or_else(|| projected(ends_m[1])),
            ];
            known_line_length_m(ends_m, ends_deg, &projected)
        };
        let spans = Spans::find(&network, &chains, &distance_m);
        let crossings = crossings(&network, &chains, &distance_m);
        let lengths = chains.lengths(&network, &distance_m);
        let mut stretches = Vec::new();
        let mut is_counted = vec![[false; 2]; spans.len()];
        let mut is_reached = vec![false; spans.len()];
        let mut segments = vec![Vec::new(); spans.len()];
        let mut ways: Vec<(usize, i64)> = Vec::new();
        for (way, place) in network.ways().iter().zip(&places) {
            let mut from_um = place.from_um;
            let mut lengths_um = place.segments_um.iter();
            for (chain, index) in chains.of_road(way) {
                let link = chains.get(chain).links[index];
                let points = network.points_of_link(link).count();
                let to_um = from_um + lengths_um.by_ref().take(points - 1).sum::<u64>();
                let mut on_chain_m = lengths.links_m[chains.place_of(chain, index)];
                if link.is_against {
                    on_chain_m.reverse();
                }
                if let Some(span) = spans.span_of(chain) {
                    is_reached[span] |= place.is_reached;
                    let [by_roads, by_railways] = &mut is_counted[span];
                    *by_roads |= place.is_reached && place.ordinal.is_some();
                    *by_railways |= place.is_reached && way.railway.is_some();
                    ways.push((span, way.way_id));
                    let points: Vec<LatticePoint> = network.points_of_link(link).collect();
                    segments[span].extend(points.array_windows());
                    let road = place.ordinal.map(CarriedLine::Road);
                    let way = CarriedLine::Way(way.way_id, place.start);
                    stretches.extend(road.into_iter().chain([way]).map(|line| Stretch {
                        line,
                        from_um,
                        to_um,
                        chain,
                        on_chain_m,
                    }));
                }
                from_um = to_um;
            }
        }
        stretches.sort_by_key(|own| (own.line, own.from_um));
        let counted = ways.into_iter().filter(|(span, _)| is_counted[*span] != [false; 2]);
        let mut counted_ways: Vec<i64> = counted.map(|(_, way_id)| way_id).collect();
        counted_ways.sort_unstable();
        counted_ways.dedup();
        let depends_on = depends_on(&spans, &crossings.all);
        let is_needed = with_dependencies(&depends_on, is_reached);
        let spans = Arc::new(spans);
        Ok(Self {
            stretches,
            spans,
            crossings,
            is_counted,
            counted_ways,
            segments,
            depends_on,
            is_needed,
        })
    }

    /// The places whose ground solving needs, in the order of [`Decks::places`].
    #[must_use]
    pub fn places(&self) -> Vec<SpanPlace> {
        // If no span is moved, none needs the ground.
        let of_crossing = |crossing: &Crossing| {
            let [moved, _] = Some(crossing.moved()).filter(|_| crossing.order == Order::Known)?;
            self.spans.span_of(moved.chain)
        };
        let spans = self.spans.spans_of_joints().chain(self.crossings.all.iter().map(of_crossing));
        let all = Decks::places(&self.spans, &self.crossings).zip(spans);
        all.map(|([u, v], span)| {
            let at = LatticePoint::new(u.round() as i64, v.round() as i64);
            SpanPlace { at, span: span.filter(|&span| self.is_needed[span]) }
        })
        .collect()
    }

    /// For each span, whether it, or one that depends on it, has a segment that `is_wanted`.
    pub(crate) fn needed_where(
        &self,
        mut is_wanted: impl FnMut([LatticePoint; 2]) -> bool,
    ) -> Vec<bool> {
        let mut has = |own: &Vec<[LatticePoint; 2]>| own.iter().any(|&segment| is_wanted(segment));
        with_dependencies(&self.depends_on, self.segments.iter().map(&mut has).collect())
    }

    /// The chain at a position on a bridge or a tunnel, and the distance along the chain, metres.
    pub(crate) fn on_chain(&self, at: OnCarriedLine) -> Option<(ChainNumber, f64)> {
        let after =
            self.stretches.partition_point(|own| (own.line, own.from_um) <= (at.line, at.along_um));
        let own = self.stretches.get(after.checked_sub(1)?)?;
        if own.line != at.line || own.to_um < at.along_um {
            return None;
        }
        Some((own.chain, own.along_m(at.along_um)))
    }

    /// The bends of a deck between two positions of a line, as distances along it, ascending; both
    /// positions are on one stretch.
    pub(crate) fn bends(
        &self,
        decks: &Decks,
        line: CarriedLine,
        [from_um, to_um]: [u64; 2],
    ) -> Vec<u64> {
        let mut bends = Vec::new();
        let first = self.stretches.partition_point(|own| (own.line, own.to_um) <= (line, from_um));
        let own = self.stretches[first..]
            .iter()
            .take_while(|own| own.line == line && own.from_um < to_um);
        for stretch in own {
            let ends = [from_um, to_um].map(|um| um.clamp(stretch.from_um, stretch.to_um));
            let mut on_chain_m = ends.map(|um| stretch.along_m(um));
            on_chain_m.sort_by(f64::total_cmp);
            let found = decks.bends_m(stretch.chain, on_chain_m);
            bends.extend(found.into_iter().map(|at_m| stretch.along_um(at_m)));
            // A deck may also bend where two stretches meet.
            bends.push(stretch.to_um);
        }
        bends.sort_unstable();
        bends.dedup();
        bends.retain(|&um| um > from_um && um < to_um);
        bends
    }
}

impl Stretch {
    fn along_m(&self, along_um: u64) -> f64 {
        let [from_m, to_m] = self.on_chain_m;
        if along_um <= self.from_um {
            from_m
        } else if along_um >= self.to_um {
            to_m
        } else {
            let share = (along_um - self.from_um) as f64 / (self.to_um - self.from_um) as f64;
            from_m + share * (to_m - from_m)
        }
    }

    fn along_um(&self, along_m: f64) -> u64 {
        let [from_m, to_m] = self.on_chain_m;
        let share = ((along_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
        self.from_um + (share * (self.to_um - self.from_um) as f64).round() as u64
    }
}

/// A road of the network: a piece of a road of the extract.
struct PlacedRoad {
    ordinal: Option<u32>,
    /// The first point of the whole road.
    start: LatticePoint,
    is_reached: bool,
    from_um: u64,
    segments_um: Vec<u64>,
}

/// For each span, the spans on whose heights its own depend.
fn depends_on(spans: &Spans, crossings: &[Crossing]) -> Vec<Vec<usize>> {
    let mut depends_on = vec![Vec::new(); spans.len()];
    for crossing in crossings.iter().filter(|crossing| crossing.order == Order::Known) {
        let both = crossing.moved().map(|place| spans.span_of(place.chain));
        if let [Some(moved), Some(other)] = both
            && moved != other
        {
            depends_on[moved].push(other);
        }
    }
    depends_on
}

/// The chosen spans, and all spans on which their heights depend.
fn with_dependencies(depends_on: &[Vec<usize>], mut is_chosen: Vec<bool>) -> Vec<bool> {
    let mut waiting: Vec<usize> = (0..is_chosen.len()).filter(|&span| is_chosen[span]).collect();
    while let Some(span) = waiting.pop() {
        for &other in &depends_on[span] {
            if !std::mem::replace(&mut is_chosen[other], true) {
                waiting.push(other);
            }
        }
    }
    is_chosen
}

/// Longitude and latitude of all points of a network, by the bits of their positions in steps.
fn degrees_of(
    network: &Network,
    inputs: &SpanInputs<'_>,
) -> Result<HashMap<[u64; 2], [f64; 2]>, ExtractError> {
    let all = || network.ways().iter().flat_map(|way| network.points_of(way));
    let mut positions: Vec<[f64; 2]> = all().map(|&point| inputs.frame.position_m(point)).collect();
    inputs.projection.wgs84_from_working(&mut positions).map_err(ExtractError::Project)?;
    Ok(all().map(|point| point.in_steps().map(f64::to_bits)).zip(positions).collect())
}

/// The roads and railways as a network, with the origin of each of them. They end at the edge of
/// the data.
fn network(inputs: &SpanInputs<'_>) -> Result<(Network, Vec<PlacedRoad>), ExtractError> {
    let lengths = TrueLengths::projected(*inputs.frame, inputs.projection);
    let mut builder = NetworkBuilder::default();
    let mut places = Vec::new();
    near_spans::for_each(inputs.store, |near| {
        let Some(road) = near.road() else { return };
        let NearRoad { ordinal, railway, is_reached, segments_um, .. } = near;
        let start = road.line.points()[0];
        if road.line.points().iter().all(|point| inputs.whole.contains(*point)) {
            builder.push_way(&road, railway);
            places.push(PlacedRoad { ordinal, start, is_reached, from_um: 0, segments_um });
            return;
        }
        for part in corniche_drape::clip_parts(&road.line, &inputs.whole, OwnedBorders::ALL) {
            let mut placed =
                PlacedRoad { ordinal, start, is_reached, from_um: 0, segments_um: Vec::new() };
            // The position along the way is not needed for roads on the ground.
            if !segments_um.is_empty() {
                (placed.from_um, placed.segments_um) =
                    lengths.part_um(&road.line, &part, &segments_um);
            }
            places.push(placed);
            builder.push_way(&road_of_part(&road, part), railway);
        }
    })?;
    Ok((builder.finish(), places))
}
