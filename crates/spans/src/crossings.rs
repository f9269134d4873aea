//! Where bridges and tunnels cross other roads without a node in common.

use corniche_geom::{LatticePoint, Side, TooMuchWork, Work, cross, side};
use corniche_network::{ChainNumber, Chains, Network, NetworkWay};
use corniche_roads::grade_limit;
use rstar::{
    AABB, RTree,
    primitives::{GeomWithData, Rectangle},
};

use crate::{Distance, spans::SpanKind};

/// A place on a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingPlace {
    /// The chain.
    pub chain: ChainNumber,
    /// OSM's id of the way there.
    pub way_id: i64,
    /// The distance along the chain, metres; on the ground nobody needs it, and it is 0.
    pub along_m: f64,
    /// What it is there; `None` on the ground.
    pub kind: Option<SpanKind>,
    /// How it is ordered: OSM's `layer`, but at least 1 on a bridge, 0 on the ground and at most −1 in a tunnel.
    pub layer: i8,
    /// The steepest grade with which roads of its kind are built, rise over run.
    pub steepest: f64,
}

/// Whether it is known what is above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// It is, by what they are or by their layers.
    Known,
    /// Both are bridges, or both tunnels, of one layer.
    Tie,
}

/// Where two chains cross, of which one at least is a bridge or a tunnel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Where on the lattice.
    pub at: [f64; 2],
    /// The upper one; where that is not known, either.
    pub upper: CrossingPlace,
    /// The lower one.
    pub lower: CrossingPlace,
    /// Whether it is known which is which.
    pub order: Order,
}

/// Ways for which no grade is known may be as steep as service roads, percent.
const OTHER_LIMIT_PCT: f64 = 20.0;

/// A piece of a chain between two points.
#[derive(Debug, Clone, Copy)]
struct Segment {
    ends: [LatticePoint; 2],
    place: CrossingPlace,
    length_m: f64,
}

/// Pairs of segments that are looked at, at least and for each segment of bridges and tunnels: in a city it is a handful. A crossing counts for
/// as many as it takes memory.
const MOST_PAIRS: u64 = 1 << 26;
const MOST_PAIRS_OF_SEGMENT: u64 = 1 << 10;
const PAIRS_OF_CROSSING: usize = 64;

type Boxed = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// All crossings of a network's bridges and tunnels with its roads and with each other, in the order of their chains.
///
/// Orientations are exact. Roads that end on one another, or share a point, do not cross there.
///
/// # Errors
/// Where more lines cross each other than in any real network.
pub fn crossings(
    network: &Network,
    chains: &Chains,
    distance_m: &Distance<'_>,
) -> Result<Vec<Crossing>, TooMuchWork> {
    let mut of_spans: Vec<Segment> = Vec::new();
    for chain in chains.numbers() {
        if SpanKind::of(network.structure_of(&chains.get(chain))).is_some() {
            of_spans.extend(segments(network, chains, chain, distance_m));
        }
    }
    let corners = |[a, b]: [LatticePoint; 2]| [a.in_steps(), b.in_steps()];
    let boxed = |(number, segment): (usize, &Segment)| -> Boxed {
        let [a, b] = corners(segment.ends);
        GeomWithData::new(Rectangle::from_corners(a, b), number)
    };
    let tree = RTree::bulk_load(of_spans.iter().enumerate().map(boxed).collect());
    let mut found = Vec::new();
    if of_spans.is_empty() {
        return Ok(found);
    }
    let work = Work::new(MOST_PAIRS + MOST_PAIRS_OF_SEGMENT * of_spans.len() as u64);
    let mut numbers: Vec<usize> = Vec::new();
    let mut own_number = 0;
    for chain in chains.numbers() {
        let is_span = SpanKind::of(network.structure_of(&chains.get(chain))).is_some();
        for segment in segments(network, chains, chain, distance_m) {
            let [a, b] = corners(segment.ends);
            numbers.clear();
            let near = tree.locate_in_envelope_intersecting(&AABB::from_corners(a, b));
            // Two spans are compared once.
            numbers.extend(near.map(|of| of.data).filter(|&other| !is_span || other < own_number));
            numbers.sort_unstable();
            work.add(numbers.len());
            let before = found.len();
            found.extend(numbers.iter().filter_map(|&other| segment.crossing(&of_spans[other])));
            work.add(PAIRS_OF_CROSSING * (found.len() - before));
            work.check()?;
            own_number += usize::from(is_span);
        }
    }
    Ok(found)
}

/// The steepest grade with which roads of a way's kind are built, rise over run.
pub(crate) fn steepest_of(network: &Network, way: &NetworkWay) -> f64 {
    grade_limit(network.highway_of(way)).unwrap_or(OTHER_LIMIT_PCT) / 100.0
}

fn segments(
    network: &Network,
    chains: &Chains,
    chain: ChainNumber,
    distance_m: &Distance<'_>,
) -> Vec<Segment> {
    let mut segments = Vec::new();
    let mut along_m = 0.0;
    for &link in chains.get(chain).links {
        let way = network.way_of(link);
        let kind = SpanKind::of(way.structure);
        let layer = kind.map_or(0, |kind| kind.layer(way.layer));
        let steepest = steepest_of(network, way);
        let mut points = network.points_of_link(link);
        let Some(mut before) = points.next() else { continue };
        for point in points {
            let length_m = match kind {
                Some(_) => distance_m(before.in_steps(), point.in_steps()),
                None => 0.0,
            };
            let place = CrossingPlace { chain, way_id: way.way_id, along_m, kind, layer, steepest };
            segments.push(Segment { ends: [before, point], place, length_m });
            along_m += length_m;
            before = point;
        }
    }
    segments
}

impl Segment {
    fn crossing(&self, other: &Self) -> Option<Crossing> {
        let [a, b] = self.ends;
        let [c, d] = other.ends;
        if self.ends.iter().any(|end| other.ends.contains(end)) {
            return None;
        }
        // What lies on a line counts as left of it, so a line that passes through a point of another crosses once.
        let is_left = |from, to, point| side(from, to, point) != Side::Right;
        if is_left(a, b, c) == is_left(a, b, d) || is_left(c, d, a) == is_left(c, d, b) {
            return None;
        }
        let share = |from: LatticePoint, to: LatticePoint, [one, two]: [LatticePoint; 2]| {
            let [of_from, of_to] = [from, to].map(|end| cross(one, two, end) as f64);
            of_from / (of_from - of_to)
        };
        let [own, others] = [share(a, b, other.ends), share(c, d, self.ends)];
        let [from, to] = [a.in_steps(), b.in_steps()];
        let at = [0, 1].map(|axis| from[axis] + own * (to[axis] - from[axis]));
        let [one, two] = [(self, own), (other, others)].map(|(segment, share)| CrossingPlace {
            along_m: segment.place.along_m + share * segment.length_m,
            ..segment.place
        });
        let order = if one.layer == two.layer { Order::Tie } else { Order::Known };
        let [upper, lower] = if one.layer >= two.layer { [one, two] } else { [two, one] };
        Some(Crossing { at, upper, lower, order })
    }
}

#[cfg(test)]
#[path = "crossings_tests.rs"]
mod tests;
