//! The decks of a network's bridges and tunnels. They are solved in another network, which has the
//! ways of all classes that carry or cross them.

use std::{collections::BTreeMap, sync::Arc};

use corniche_geom::LatticeBounds;
use corniche_network::{
    Breaks, ChainLengths, ChainNumber, Chains, Network, NetworkWay, NodeNumber,
};
use corniche_roads::Structure;
use corniche_spans::{Decks, Spans, crossings};
use corniche_work::Observer;

use crate::{
    dem_ground::DemNodes,
    error::ElevationError,
    places::Places,
    plane::mix,
    span_facts::{SpanFacts, ToldSpans},
};

/// Progress is reported after this many places.
const TOLD_PLACES: usize = 1024;
/// Lengths along the same points differ by rounding only, metres.
const SAME_M: f64 = 1e-6;

/// A part of a chain, and the same part of a chain in the other network.
#[derive(Clone, Copy)]
struct ChainPart {
    /// The beginning and the end of the part along the chain, ascending.
    own_m: [f64; 2],
    chain: ChainNumber,
    /// The same places along the other chain.
    others_m: [f64; 2],
}

/// The decks of a network, by chain.
pub(crate) struct SpanDecks {
    pub(crate) decks: Decks,
    parts: BTreeMap<ChainNumber, Vec<ChainPart>>,
    /// The nodes of the network that carry its bridges and tunnels, with their heights.
    pub(crate) supports: Vec<(NodeNumber, f64)>,
    pub(crate) facts: SpanFacts,
}

/// A stretch of a road: its chain, its beginning and end along the road, and the same places along
/// the chain.
#[derive(Clone, Copy)]
struct RoadStretchOnChain {
    chain: ChainNumber,
    along_m: [f64; 2],
    on_chain_m: [f64; 2],
}

/// A network with its chains and their lengths.
type Measured<'a> = (&'a Network, &'a Chains, &'a ChainLengths);

impl SpanDecks {
    /// Solves the decks over the ground of the elevation files. Only the decks of roads that reach
    /// `data` are reported.
    pub(crate) fn solve(
        own: Measured<'_>,
        (places, data): (&Places<'_>, &LatticeBounds),
        nodes: &mut DemNodes<'_>,
        observer: &dyn Observer,
    ) -> Result<Self, ElevationError> {
        let network = own.0;
        let of_spans = network.of_spans();
        let of_spans_chains = Chains::from_network(of_spans, Breaks::JunctionsAndStructures);
        let distance_m = places.metric();
        let spans = Spans::find(of_spans, &of_spans_chains, &distance_m);
        let crossings = crossings(of_spans, &of_spans_chains, &distance_m);
        let wanted: Vec<[f64; 2]> = Decks::places(&spans, &crossings).collect();
        let mut by_block: Vec<usize> = (0..wanted.len()).collect();
        by_block.sort_by_key(|&place| nodes.block_of(wanted[place]));
        let mut grounds_m = vec![None; wanted.len()];
        for some in by_block.chunks(TOLD_PLACES) {
            observer.check()?;
            for &place in some {
                grounds_m[place] = nodes.height_m(wanted[place])?;
            }
        }
        let decks = Decks::solve(Arc::new(spans), &crossings, &grounds_m);
        let lengths = of_spans_chains.lengths(of_spans, &distance_m);
        let others = (of_spans, &of_spans_chains, &lengths);
        let mut parts: BTreeMap<ChainNumber, Vec<ChainPart>> = BTreeMap::new();
        let mut told = ToldSpans::default();
        let mut next = 0;
        for way in network.ways().iter().filter(|way| way.structure != Structure::Ground) {
            // A way that was cut consists of several roads in the same order, and either network
            // may lack some of them.
            let roads = of_spans.roads_of(way.way_id);
            let is_same = |other: &usize| {
                of_spans.points_of(&of_spans.ways()[*other]) == network.points_of(way)
            };
            let Some(other) = (roads.start.max(next)..roads.end).find(is_same) else { continue };
            next = other + 1;
            let reaches = LatticeBounds::around(network.points_of(way))
                .is_some_and(|own| own.intersects(data));
            let other = stretches(others, &of_spans.ways()[other], places);
            for (chain, part) in parts_in_common(&stretches(own, way, places), &other) {
                if reaches {
                    told.spans.extend(decks.spans().span_of(part.chain));
                }
                parts.entry(chain).or_default().push(part);
            }
        }
        for way in of_spans.ways() {
            let of_way = of_spans_chains.of_road(way).map(|(chain, _)| chain);
            if of_way
                .filter_map(|chain| decks.spans().span_of(chain))
                .any(|of| told.spans.contains(&of))
            {
                told.ways.insert(way.way_id);
            }
        }
        for own in parts.values_mut() {
            own.sort_by(|one, other| one.own_m[0].total_cmp(&other.own_m[0]));
        }
        let supports = supports_of(own, (&of_spans_chains, &lengths), &decks, &parts);
        let facts = SpanFacts::from_decks(&decks, &told);
        Ok(Self { decks, parts, supports, facts })
    }

    /// The height at a distance along a chain, as if there were no ground; `None` on the ground,
    /// and if it is unknown.
    pub(crate) fn height_m(&self, chain: ChainNumber, along_m: f64) -> Option<f64> {
        let parts = self.parts.get(&chain)?;
        let after = parts.partition_point(|part| part.own_m[0] <= along_m);
        let part = parts.get(after.max(1) - 1)?;
        self.decks.height_m(part.chain, part.other_m(along_m))
    }

    /// The distances between two places of a chain at which its deck may bend, ascending, without
    /// these places.
    pub(crate) fn bends_m(&self, chain: ChainNumber, [from_m, to_m]: [f64; 2]) -> Vec<f64> {
        let mut bends_m = Vec::new();
        for part in self.parts.get(&chain).into_iter().flatten() {
            let within = part.own_m.map(|own_m| own_m.clamp(from_m, to_m));
            if within[0] >= within[1] {
                continue;
            }
            let mut others_m = within.map(|own_m| part.other_m(own_m));
            others_m.sort_by(f64::total_cmp);
            let found = self.decks.bends_m(part.chain, others_m);
            bends_m.extend(found.into_iter().map(|other_m| part.own_at_m(other_m)));
            bends_m.push(part.own_m[1]);
        }
        bends_m.retain(|&at_m| at_m > from_m + SAME_M && at_m < to_m - SAME_M);
        bends_m.sort_by(f64::total_cmp);
        bends_m.dedup();
        bends_m
    }
}

impl RoadStretchOnChain {
    /// The place on the chain for one along the way; exactly an end if it is as near.
    fn on_chain_m(&self, at_m: f64) -> f64 {
        near(carried(at_m, self.along_m, self.on_chain_m), self.on_chain_m)
    }
}

impl ChainPart {
    /// The place on the other chain; exact at the ends.
    fn other_m(&self, own_m: f64) -> f64 {
        carried(own_m, self.own_m, self.others_m)
    }

    fn own_at_m(&self, other_m: f64) -> f64 {
        carried(other_m, self.others_m, self.own_m)
    }
}

/// Maps a place from one range to another.
fn carried(at_m: f64, [from_m, to_m]: [f64; 2], [other_from_m, other_to_m]: [f64; 2]) -> f64 {
    let share = ((at_m - from_m) / (to_m - from_m)).clamp(0.0, 1.0);
    mix(other_from_m, other_to_m, share)
}

/// The stretches of a road, in its order.
fn stretches(
    (network, chains, lengths): Measured<'_>,
    way: &NetworkWay,
    places: &Places<'_>,
) -> Vec<RoadStretchOnChain> {
    let mut along_m = 0.0;
    let mut stretches = Vec::new();
    for (chain, index) in chains.of_road(way) {
        let link = chains.get(chain).links[index];
        let length_m = places.length_m(network.points_of_link(link));
        let mut on_chain_m = lengths.links_m[chains.place_of(chain, index)];
        if link.is_against {
            on_chain_m.reverse();
        }
        stretches.push(RoadStretchOnChain {
            chain,
            along_m: [along_m, along_m + length_m],
            on_chain_m,
        });
        along_m += length_m;
    }
    stretches
}

/// Returns the common parts of a road's stretches in two networks; both ascend along the road.
fn parts_in_common(
    own: &[RoadStretchOnChain],
    others: &[RoadStretchOnChain],
) -> Vec<(ChainNumber, ChainPart)> {
    let mut parts = Vec::new();
    let mut first = 0;
    for own in own {
        let is_before = |other: &&RoadStretchOnChain| other.along_m[1] <= own.along_m[0];
        first += others[first..].iter().take_while(is_before).count();
        let is_near = |other: &&RoadStretchOnChain| other.along_m[0] < own.along_m[1];
        for other in others[first..].iter().take_while(is_near) {
            let along_m =
                [own.along_m[0].max(other.along_m[0]), own.along_m[1].min(other.along_m[1])];
            if along_m[1] - along_m[0] <= SAME_M {
                continue;
            }
            let [mut own_m, mut others_m] =
                [own, other].map(|of| along_m.map(|at_m| of.on_chain_m(at_m)));
            if own_m[0] > own_m[1] {
                own_m.reverse();
                others_m.reverse();
            }
            parts.push((own.chain, ChainPart { own_m, chain: other.chain, others_m }));
        }
    }
    parts
}

/// Returns the nodes at the ends of chains that are supports in the network of the decks. A node
/// may have another id there.
fn supports_of(
    (_, chains, lengths): Measured<'_>,
    (others, others_lengths): (&Chains, &ChainLengths),
    decks: &Decks,
    parts: &BTreeMap<ChainNumber, Vec<ChainPart>>,
) -> Vec<(NodeNumber, f64)> {
    let heights_m: BTreeMap<NodeNumber, f64> = decks.supports().collect();
    let mut supports = Vec::new();
    for (&number, own) in parts {
        let ends = [0.0, lengths.chains_m[number.0]];
        for (end, &at_m) in ends.iter().enumerate() {
            let is_there = |part: &&ChainPart| (part.own_m[end] - at_m).abs() <= SAME_M;
            let Some(part) = own.iter().find(is_there) else { continue };
            let others_ends_m = [0.0, others_lengths.chains_m[part.chain.0]];
            let nodes = others.get(part.chain).ends.into_iter().zip(others_ends_m);
            let found = nodes
                .filter(|(_, end_m)| (end_m - part.others_m[end]).abs() <= SAME_M)
                .find_map(|(node, _)| heights_m.get(&node));
            supports.extend(found.map(|&height_m| (chains.get(number).ends[end], height_m)));
        }
    }
    supports
}

/// Returns the end of a range that is within rounding of this place.
fn near(at_m: f64, ends_m: [f64; 2]) -> f64 {
    ends_m.into_iter().find(|end_m| (end_m - at_m).abs() <= SAME_M).unwrap_or(at_m)
}
