//! The links of a network as a graph, and the shortest ways in it.

use std::{
    cmp::{Ordering, Reverse},
    collections::BinaryHeap,
};

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{Breaks, Chains, Link, Network, NetworkWay};

use crate::{
    places::Places,
    plane::{along, nearest, vector},
};

/// A metre of another road counts as so many of the road that is meant: others only close its gaps.
const OTHER_ROADS: f64 = 20.0;
/// No edge leads to a node.
pub(crate) const NONE: u32 = u32::MAX;

/// A link in the direction of its way.
#[derive(Clone, Copy)]
pub(crate) struct Edge {
    pub(crate) link: Link,
    pub(crate) ends: [usize; 2],
    pub(crate) length_m: f64,
    /// Whether it belongs to the road that is meant.
    pub(crate) is_wanted: bool,
}

/// A place along a link of a graph.
#[derive(Clone, Copy)]
pub(crate) struct PlaceOnLink {
    pub(crate) edge: usize,
    /// Distance along the link, in the direction of its way, metres.
    pub(crate) along_m: f64,
    /// How far it is from the place that was given, metres.
    pub(crate) off_m: f64,
}

/// The links that may be followed.
pub(crate) struct RoadGraph<'a> {
    pub(crate) network: &'a Network,
    pub(crate) places: &'a Places<'a>,
    pub(crate) edges: Vec<Edge>,
    /// The edges at each node: twice the number of the edge, plus one for its second end.
    at: IndexLists,
}

/// The shortest ways from some places to all nodes.
pub(crate) struct ShortestWays {
    /// How far nodes are, metres that count; infinite where nothing leads.
    pub(crate) far_m: Vec<f64>,
    /// The end of the edge by which each node is reached, twice its number plus one for its second end; [`NONE`] where a way begins.
    pub(crate) by: Vec<u32>,
    /// Which of the places each way begins at.
    pub(crate) from: Vec<u32>,
}

/// A node to look at, the nearest first; of equal ones the one with the smaller number.
#[derive(PartialEq)]
struct Reached(f64, usize);

impl Eq for Reached {}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

impl Edge {
    /// What a length along it counts, metres.
    pub(crate) fn weight_m(&self, length_m: f64) -> f64 {
        if self.is_wanted { length_m } else { OTHER_ROADS * length_m }
    }
}

impl<'a> RoadGraph<'a> {
    /// The links of ways that may be followed; `choose` tells whether a way belongs to the road that is meant, and is `None` for one that is not followed.
    pub(crate) fn new(
        network: &'a Network,
        places: &'a Places<'a>,
        choose: impl Fn(&NetworkWay) -> Option<bool>,
    ) -> Self {
        let chains = Chains::of(network, Breaks::Junctions);
        let mut edges = Vec::new();
        // Nodes within chains have numbers of their own.
        let mut nodes = network.node_count();
        for number in chains.numbers() {
            let chain = chains.get(number);
            let mut from = network.index_of(chain.ends[0]);
            for (index, &link) in chain.links.iter().enumerate() {
                let to = if index + 1 == chain.links.len() {
                    network.index_of(chain.ends[1])
                } else {
                    nodes += 1;
                    nodes - 1
                };
                if let Some(is_wanted) = choose(network.way_of(link)) {
                    let ends = if link.is_against { [to, from] } else { [from, to] };
                    let mut link = link;
                    link.is_against = false;
                    let length_m = places.length_m(network.points_of_link(link));
                    edges.push(Edge { link, ends, length_m, is_wanted });
                }
                from = to;
            }
        }
        let at = IndexLists::new(nodes, 2 * edges.len(), |end| {
            Some(edges[end / 2].ends[end % 2]).into_iter()
        });
        Self { network, places, edges, at }
    }

    /// How many nodes there are.
    pub(crate) fn node_count(&self) -> usize {
        self.at.parts()[0].len() - 1
    }

    /// The ends of edges at a node.
    pub(crate) fn ends_at(&self, node: usize) -> &[u32] {
        self.at.of(node)
    }

    /// The points of an edge, in the direction of its way.
    pub(crate) fn points(&self, edge: &Edge) -> Vec<LatticePoint> {
        self.network.points_of_link(edge.link).collect()
    }

    /// The shortest ways to all nodes from some of them, which are so far already. Edges are followed where `is_open` says so.
    pub(crate) fn shortest(
        &self,
        starts: &[(usize, f64)],
        is_open: impl Fn(&Edge) -> bool,
    ) -> ShortestWays {
        let nodes = self.node_count();
        let mut ways = ShortestWays {
            far_m: vec![f64::INFINITY; nodes],
            by: vec![NONE; nodes],
            from: vec![NONE; nodes],
        };
        let mut heap = BinaryHeap::new();
        for (number, &(node, far_m)) in (0..).zip(starts) {
            if far_m < ways.far_m[node] {
                (ways.far_m[node], ways.from[node]) = (far_m, number);
                heap.push(Reverse(Reached(far_m, node)));
            }
        }
        while let Some(Reverse(Reached(far_m, node))) = heap.pop() {
            if far_m > ways.far_m[node] {
                continue;
            }
            for &end in self.ends_at(node) {
                let edge = &self.edges[end as usize / 2];
                let next = edge.ends[1 - end as usize % 2];
                let next_m = far_m + edge.weight_m(edge.length_m);
                if is_open(edge) && next_m < ways.far_m[next] {
                    (ways.far_m[next], ways.by[next]) = (next_m, end ^ 1);
                    ways.from[next] = ways.from[node];
                    heap.push(Reverse(Reached(next_m, next)));
                }
            }
        }
        ways
    }

    /// See [`corniche_tileset::Manifest::covered_text`].
    pub(crate) fn covered_text(&self, place_deg: [f64; 2]) -> String {
        self.places.manifest.covered_text(place_deg)
    }

    /// The places on roads that are meant nearest to a place, and those that are at most so much farther; the nearest first.
    pub(crate) fn near(&self, place_deg: [f64; 2], beside_m: f64) -> Vec<PlaceOnLink> {
        let manifest = self.places.manifest;
        let Some(position_m) = manifest.coordinates.working_from_wgs84(place_deg) else {
            return Vec::new();
        };
        let here = manifest.frame.fraction_of_position(position_m);
        // Metres to a step, which differ by direction in degrees.
        let metres = [[1000.0, 0.0], [0.0, 1000.0]].map(|[u, v]| {
            let there = [here[0] + u, here[1] + v];
            self.places.distance_m(here, there) / 1000.0
        });
        let mut near: Vec<PlaceOnLink> = Vec::new();
        let mut least_m = f64::INFINITY;
        for (number, edge) in self.edges.iter().enumerate().filter(|(_, edge)| edge.is_wanted) {
            let points = self.points(edge);
            let mut best: Option<(f64, usize, [f64; 2])> = None;
            for (segment, pair) in points.array_windows::<2>().enumerate() {
                let [from, to] = pair.map(LatticePoint::in_steps);
                let scaled = |[u, v]: [f64; 2]| [u * metres[0], v * metres[1]];
                let [share, off_m] = nearest(scaled(vector(from, to)), scaled(vector(from, here)));
                if best.is_none_or(|(least_m, ..)| off_m < least_m) {
                    best = Some((off_m, segment, along(from, to, share)));
                }
            }
            let Some((off_m, segment, at)) =
                best.filter(|(off_m, ..)| *off_m <= least_m + beside_m)
            else {
                continue;
            };
            least_m = least_m.min(off_m);
            let [u, v] = at.map(|steps| steps.round() as i64);
            let point = LatticePoint::new(u, v);
            let to_here = points[..=segment].iter().copied().chain([point]);
            let along_m = self.places.length_m(to_here);
            near.push(PlaceOnLink { edge: number, along_m: along_m.min(edge.length_m), off_m });
        }
        near.retain(|place| place.off_m <= least_m + beside_m);
        near.sort_by(|one, other| one.off_m.total_cmp(&other.off_m));
        near
    }
}
