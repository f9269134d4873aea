//! Chains of stretches that continue through nodes at which exactly two stretches meet.

use std::ops::Range;

use corniche_geom::{IndexLists, LatticeBounds, LatticePoint};
use corniche_roads::Structure;

use crate::network::{Network, NetworkWay, NodeNumber};

/// The places where chains end, besides dead ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breaks {
    /// Chains end at junctions.
    Junctions,
    /// Chains end at junctions, and where a bridge or a tunnel begins.
    JunctionsAndStructures,
}

/// The number of a chain among [`Chains`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChainNumber(pub usize);

/// A stretch within a chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link {
    stretch: u32,
    /// Whether the chain runs against the way.
    pub is_against: bool,
}

/// A sequence of stretches, from node to node.
#[derive(Debug, Clone, Copy)]
pub struct Chain<'a> {
    /// The nodes at the chain's beginning and end. Of two different nodes, the first has the
    /// smaller number. A chain that returns to its first node runs counterclockwise.
    pub ends: [NodeNumber; 2],
    /// The stretches of the chain in order, at least one.
    pub links: &'a [Link],
}

impl Chain<'_> {
    /// Whether the chain returns to the node where it begins.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// All chains of a network: each stretch is in exactly one of them.
#[derive(Debug)]
pub struct Chains {
    links: Vec<Link>,
    /// The index of each chain's first link, and the end of all links.
    starts: Vec<usize>,
    ends: Vec<[NodeNumber; 2]>,
    /// The index of each stretch among the links.
    places: Vec<u32>,
}

/// The index of a stretch that is in no chain yet, and of stops at which no stretch begins.
const NO_PLACE: u32 = u32::MAX;

impl Chains {
    /// Returns the chains of a network, ordered by the nodes at their ends; chains between the same
    /// two nodes are ordered by their points. The chains and their order do not depend on the
    /// order, the direction or the splitting of ways.
    #[must_use]
    pub fn from_network(network: &Network, breaks: Breaks) -> Self {
        let mut chains = Self {
            links: Vec::new(),
            starts: vec![0],
            ends: Vec::new(),
            places: vec![NO_PLACE; network.stop_points.len()],
        };
        let goes_on = |node: u32| {
            network.ends_at.list(node as usize).len() == 2
                && (breaks == Breaks::Junctions || network.structure_at(node).is_some())
        };
        let nodes = || 0..network.nodes as u32;
        // Chains with two ends come first. The rest are rings without a junction, which begin at
        // the smallest of their nodes.
        for node in nodes().filter(|&node| !goes_on(node)).chain(nodes()) {
            for &end in network.ends_at.list(node as usize) {
                if chains.places[end as usize / 2] == NO_PLACE {
                    chains.walk(network, node, end, &goes_on);
                }
            }
        }
        chains.sorted(network)
    }

    /// Returns the same chains in the order of their ends, then of their points.
    fn sorted(self, network: &Network) -> Self {
        let mut order: Vec<ChainNumber> = self.numbers().collect();
        let points =
            |number| self.get(number).links.iter().flat_map(|&link| network.points_of_link(link));
        order.sort_by(|&one, &other| {
            let ends = self.get(one).ends.cmp(&self.get(other).ends);
            ends.then_with(|| points(one).cmp(points(other)))
        });
        let mut sorted = Self {
            links: Vec::with_capacity(self.links.len()),
            starts: Vec::with_capacity(self.starts.len()),
            ends: Vec::with_capacity(self.ends.len()),
            places: self.places.clone(),
        };
        sorted.starts.push(0);
        for number in order {
            let Chain { ends, links } = self.get(number);
            for (place, link) in (sorted.links.len()..).zip(links) {
                sorted.places[link.stretch as usize] = place as u32;
            }
            sorted.links.extend(links);
            sorted.starts.push(sorted.links.len());
            sorted.ends.push(ends);
        }
        sorted
    }

    /// Adds the chain that leaves a node along one end of a stretch.
    fn walk(&mut self, network: &Network, from: u32, first: u32, goes_on: &dyn Fn(u32) -> bool) {
        let mut end = first;
        let to = loop {
            let (stretch, is_against) = (end / 2, end % 2 == 1);
            self.places[stretch as usize] = self.links.len() as u32;
            self.links.push(Link { stretch, is_against });
            let arrives = end ^ 1;
            let node = network.stretch_nodes(stretch)[arrives as usize % 2];
            if !goes_on(node) || node == from {
                break node;
            }
            let next = network.ends_at.list(node as usize).iter().find(|&&other| other != arrives);
            match next {
                Some(&next) if self.places[next as usize / 2] == NO_PLACE => end = next,
                _ => break node,
            }
        };
        let start = self.starts.last().copied().unwrap_or_default();
        if from == to && is_clockwise(network, &self.links[start..]) {
            self.links[start..].reverse();
            for (place, link) in (start..).zip(&mut self.links[start..]) {
                link.is_against = !link.is_against;
                self.places[link.stretch as usize] = place as u32;
            }
        }
        self.starts.push(self.links.len());
        self.ends.push([NodeNumber(from), NodeNumber(to)]);
    }

    /// Returns the number of chains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no chains.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Returns the numbers of all chains.
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = ChainNumber> + use<> {
        (0..self.len()).map(ChainNumber)
    }

    /// Returns the chain with this number.
    #[must_use]
    pub fn get(&self, number: ChainNumber) -> Chain<'_> {
        let ChainNumber(number) = number;
        let links = &self.links[self.starts[number]..self.starts[number + 1]];
        Chain { ends: self.ends[number], links }
    }

    /// Returns the ends of chains at each node: twice the number of the chain, plus one for its
    /// last end. Only the chains that `counts` accepts are included.
    #[must_use]
    pub fn ends_at(&self, network: &Network, counts: impl Fn(ChainNumber) -> bool) -> IndexLists {
        IndexLists::new(network.node_count(), 2 * self.len(), |end| {
            let number = ChainNumber(end / 2);
            let node = network.index_of(self.get(number).ends[end % 2]);
            counts(number).then_some(node).into_iter()
        })
    }

    /// Returns the index of a link among the links of all chains.
    #[must_use]
    pub fn place_of(&self, ChainNumber(number): ChainNumber, index: usize) -> usize {
        self.starts[number] + index
    }

    /// Returns the total number of links in all chains.
    #[must_use]
    pub fn link_count(&self) -> usize {
        self.links.len()
    }

    /// Returns the chain that contains a stretch, which may come from other chains, and the number
    /// of its link there.
    #[must_use]
    pub fn of_link(&self, link: Link) -> (ChainNumber, usize) {
        self.of_stretch(link.stretch as usize)
    }

    fn of_stretch(&self, stretch: usize) -> (ChainNumber, usize) {
        let place = self.places[stretch] as usize;
        let chain = self.starts.partition_point(|&start| start <= place) - 1;
        (ChainNumber(chain), place - self.starts[chain])
    }

    /// Returns the chains that contain the stretches of a road, in the road's order, each with the
    /// number of the link in its chain.
    pub fn of_road<'a>(
        &'a self,
        way: &NetworkWay,
    ) -> impl Iterator<Item = (ChainNumber, usize)> + 'a {
        let Range { start, end } = way.stops;
        (start..end.saturating_sub(1)).map(|stretch| self.of_stretch(stretch))
    }
}

/// The lengths of chains, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainLengths {
    /// The length of each chain.
    pub chains_m: Vec<f64>,
    /// The distances along its chain at which each link begins and ends, by [`Chains::place_of`].
    pub links_m: Vec<[f64; 2]>,
}

impl Chains {
    /// Returns the lengths, from the distances between neighbouring points in lattice steps. Sums
    /// run along whole chains, because sums of links would depend, in the last bit, on where ways
    /// are split.
    #[must_use]
    pub fn lengths(
        &self,
        network: &Network,
        distance_m: &dyn Fn([f64; 2], [f64; 2]) -> f64,
    ) -> ChainLengths {
        let mut lengths = ChainLengths {
            chains_m: Vec::with_capacity(self.len()),
            links_m: Vec::with_capacity(self.link_count()),
        };
        for number in self.numbers() {
            let mut along_m = 0.0;
            for &link in self.get(number).links {
                let from_m = along_m;
                let points: Vec<LatticePoint> = network.points_of_link(link).collect();
                for [from, to] in points.array_windows() {
                    along_m += distance_m(from.in_steps(), to.in_steps());
                }
                lengths.links_m.push([from_m, along_m]);
            }
            lengths.chains_m.push(along_m);
        }
        lengths
    }
}

impl Network {
    /// Returns the road of a link.
    #[must_use]
    pub fn way_of(&self, link: Link) -> &NetworkWay {
        &self.ways[self.way_of_stretch(link.stretch)]
    }

    /// Returns the nodes at both ends of a link, in the direction of the chain.
    #[must_use]
    pub fn nodes_of_link(&self, link: Link) -> [NodeNumber; 2] {
        let [first, last] = self.stretch_nodes(link.stretch).map(NodeNumber);
        if link.is_against { [last, first] } else { [first, last] }
    }

    /// Returns the structure that carries a chain of [`Breaks::JunctionsAndStructures`].
    #[must_use]
    pub fn structure_of(&self, chain: &Chain<'_>) -> Structure {
        chain.links.first().map_or(Structure::Ground, |&link| self.way_of(link).structure)
    }

    /// Returns the points of a link, in the direction of the chain; at least two.
    #[must_use]
    pub fn points_of_link(&self, link: Link) -> impl DoubleEndedIterator<Item = LatticePoint> + '_ {
        let way = self.way_of(link);
        let [first, last] = [link.stretch, link.stretch + 1]
            .map(|stop| way.points.start + self.stop_points[stop as usize] as usize);
        let count = last + 1 - first;
        let at = move |k: usize| if link.is_against { last - k } else { first + k };
        (0..count).map(move |k| self.points[at(k)])
    }

    /// Whether the bounding box of a chain overlaps some bounds.
    #[must_use]
    pub fn reaches(&self, chain: &Chain<'_>, bounds: &LatticeBounds) -> bool {
        let points = self.points_of_chain(chain);
        LatticeBounds::around(&points).is_some_and(|own| own.intersects(bounds))
    }

    /// Returns the points of a chain, each once.
    #[must_use]
    pub fn points_of_chain(&self, chain: &Chain<'_>) -> Vec<LatticePoint> {
        let mut points: Vec<LatticePoint> = Vec::new();
        for &link in chain.links {
            points.extend(self.points_of_link(link).skip(usize::from(!points.is_empty())));
        }
        points
    }
}

/// Whether links that return to their first node run clockwise. The answer does not depend on the
/// direction in which roads were drawn. For links that enclose no area: whether the other direction
/// comes first in the order of points.
fn is_clockwise(network: &Network, links: &[Link]) -> bool {
    let points = || links.iter().flat_map(|&link| network.points_of_link(link));
    let Some(from) = points().next() else { return false };
    let off = |point: LatticePoint| [point.u - from.u, point.v - from.v].map(i128::from);
    let mut twice_area = 0;
    let mut before = [0; 2];
    for here in points().map(off) {
        twice_area += before[0] * here[1] - here[0] * before[1];
        before = here;
    }
    match twice_area.signum() {
        0 => links.iter().rev().flat_map(|&link| network.points_of_link(link).rev()).lt(points()),
        sign => sign < 0,
    }
}

#[cfg(test)]
#[path = "chains_tests.rs"]
mod tests;
