//! The links of a network as a graph, and the shortest routes in it. In this module, an edge is a
//! link in the direction of its way, and a node is one of the network.

use std::{cmp::Reverse, collections::BinaryHeap};

use corniche_geom::{IndexLists, LatticePoint};
use corniche_network::{Breaks, Chains, Link, Network, NetworkWay};

use crate::{
    places::Places,
    plane::{along, nearest, nearest_point, vector},
};

/// A metre of another road counts as this many metres of the matching road: others only close its
/// gaps.
const OTHER_ROADS: f64 = 20.0;
/// Marks a node that no edge reaches.
pub(crate) const NONE: u32 = u32::MAX;

/// A link in the direction of its way.
#[derive(Clone, Copy)]
pub(crate) struct RouteEdge {
    pub(crate) link: Link,
    pub(crate) ends: [usize; 2],
    pub(crate) length_m: f64,
    /// Whether it belongs to the matching road.
    pub(crate) is_wanted: bool,
}

/// A place along a link of a graph.
#[derive(Clone, Copy)]
pub(crate) struct PlaceOnLink {
    pub(crate) edge: usize,
    /// Distance along the link, in the direction of its way, metres.
    pub(crate) along_m: f64,
    /// Its distance from the given place, metres.
    pub(crate) off_m: f64,
}

/// The links that a route may follow.
pub(crate) struct RoadGraph<'a> {
    pub(crate) network: &'a Network,
    pub(crate) places: &'a Places<'a>,
    pub(crate) edges: Vec<RouteEdge>,
    /// The edges at each node: twice the number of the edge, plus one for its second end.
    at: IndexLists,
}

/// The shortest routes from some places to all nodes.
pub(crate) struct ShortestWays {
    /// Weighted distances of nodes, metres; infinite for nodes that cannot be reached.
    pub(crate) far_m: Vec<f64>,
    /// The end of the edge by which each node is reached, twice its number plus one for its second
    /// end; [`NONE`] where a route begins.
    pub(crate) by: Vec<u32>,
    /// The number of the place at which each route begins.
    pub(crate) from: Vec<u32>,
}

impl RouteEdge {
    /// Returns the weight of a length along the edge, metres.
    pub(crate) fn weight_m(&self, length_m: f64) -> f64 {
        if self.is_wanted { length_m } else { OTHER_ROADS * length_m }
    }
}

impl<'a> RoadGraph<'a> {
    /// Returns the graph of the links that may be followed. `choose` returns whether a way belongs
    /// to the matching road, and `None` for a way that may not be followed.
    pub(crate) fn new(
        network: &'a Network,
        places: &'a Places<'a>,
        choose: impl Fn(&NetworkWay) -> Option<bool>,
    ) -> Self {
        let chains = Chains::from_network(network, Breaks::Junctions);
        let mut edges = Vec::new();
        // Nodes within chains have separate numbers.
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
                    edges.push(RouteEdge { link, ends, length_m, is_wanted });
                }
                from = to;
            }
        }
        let at = IndexLists::new(nodes, 2 * edges.len(), |end| {
            Some(edges[end / 2].ends[end % 2]).into_iter()
        });
        Self { network, places, edges, at }
    }

    /// The number of nodes.
    pub(crate) fn node_count(&self) -> usize {
        self.at.parts()[0].len() - 1
    }

    /// The ends of edges at a node.
    pub(crate) fn ends_at(&self, node: usize) -> &[u32] {
        self.at.list(node)
    }

    /// The points of an edge, in the direction of its way.
    pub(crate) fn points(&self, edge: &RouteEdge) -> Vec<LatticePoint> {
        self.network.points_of_link(edge.link).collect()
    }

    /// Returns the shortest routes to all nodes from some nodes with initial distances. Edges are
    /// followed if `is_open` allows it.
    pub(crate) fn shortest(
        &self,
        starts: &[(usize, f64)],
        is_open: impl Fn(&RouteEdge) -> bool,
    ) -> ShortestWays {
        let nodes = self.node_count();
        let mut ways = ShortestWays {
            far_m: vec![f64::INFINITY; nodes],
            by: vec![NONE; nodes],
            from: vec![NONE; nodes],
        };
        // The bits of non-negative numbers have the same order as the numbers.
        let mut heap = BinaryHeap::new();
        for (number, &(node, far_m)) in (0..).zip(starts) {
            if far_m < ways.far_m[node] {
                (ways.far_m[node], ways.from[node]) = (far_m, number);
                heap.push(Reverse((far_m.to_bits(), node)));
            }
        }
        while let Some(Reverse((far_m, node))) = heap.pop() {
            let far_m = f64::from_bits(far_m);
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
                    heap.push(Reverse((next_m.to_bits(), next)));
                }
            }
        }
        ways
    }

    /// Returns the places on matching roads that are nearest to a place, and those farther by at
    /// most `beside_m`; the nearest first.
    pub(crate) fn near(&self, place_deg: [f64; 2], beside_m: f64) -> Vec<PlaceOnLink> {
        let manifest = self.places.manifest;
        let Some(position_m) = manifest.coordinates.working_from_wgs84(place_deg) else {
            return Vec::new();
        };
        let here = manifest.frame.fraction_of_position(position_m);
        // Metres per lattice step, which depend on the direction in degrees.
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
            let to_here = points[..=segment].iter().copied().chain([nearest_point(at)]);
            let along_m = self.places.length_m(to_here);
            near.push(PlaceOnLink { edge: number, along_m: along_m.min(edge.length_m), off_m });
        }
        near.retain(|place| place.off_m <= least_m + beside_m);
        near.sort_by(|one, other| one.off_m.total_cmp(&other.off_m));
        near
    }
}
