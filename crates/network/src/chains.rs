//! Chains of stretches through nodes at which two of them meet.

use std::ops::Range;

use corniche_geom::{IndexLists, LatticeBounds, LatticePoint};
use corniche_roads::Structure;

use crate::network::{Network, NetworkWay, NodeNumber};

/// Where chains end, beside dead ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breaks {
    /// At junctions.
    Junctions,
    /// At junctions, and where a bridge or a tunnel begins.
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
    /// Where it begins and where it ends. Of two different nodes the first has the smaller number; one that comes back to its node runs counterclockwise.
    pub ends: [NodeNumber; 2],
    /// Its stretches, in order; at least one.
    pub links: &'a [Link],
}

impl Chain<'_> {
    /// Whether it comes back to where it begins.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// All chains of a network: each stretch is in one of them.
#[derive(Debug)]
pub struct Chains {
    links: Vec<Link>,
    /// Where the links of each chain begin, and the end of all.
    starts: Vec<usize>,
    ends: Vec<[NodeNumber; 2]>,
    /// The place of each stretch among the links.
    places: Vec<u32>,
}

/// The place of a stretch that is in no chain yet, and of stops that begin no stretch.
const NO_PLACE: u32 = u32::MAX;

impl Chains {
    /// The chains of a network, ordered by the nodes at their ends, and those between the same two by their points. What they are and their order
    /// do not depend on the order, the direction or the splitting of ways.
    #[must_use]
    pub fn of(network: &Network, breaks: Breaks) -> Self {
        let mut chains = Self {
            links: Vec::new(),
            starts: vec![0],
            ends: Vec::new(),
            places: vec![NO_PLACE; network.stop_points.len()],
        };
        let goes_on = |node: u32| {
            network.ends_at.of(node as usize).len() == 2
                && (breaks == Breaks::Junctions || network.structure_at(node).is_some())
        };
        let nodes = || 0..network.nodes as u32;
        // Chains with two ends first; what is left are rings without a junction, which begin at the smallest of their nodes.
        for node in nodes().filter(|&node| !goes_on(node)).chain(nodes()) {
            for &end in network.ends_at.of(node as usize) {
                if chains.places[end as usize / 2] == NO_PLACE {
                    chains.walk(network, node, end, &goes_on);
                }
            }
        }
        chains.sorted(network)
    }

    /// The same chains in the order of their ends, then of their points.
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

    /// Adds the chain that leaves a node with an end of a stretch.
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
            let next = network.ends_at.of(node as usize).iter().find(|&&other| other != arrives);
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

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The numbers of all chains.
    pub fn numbers(&self) -> impl DoubleEndedIterator<Item = ChainNumber> + use<> {
        (0..self.len()).map(ChainNumber)
    }

    /// A chain.
    #[must_use]
    pub fn get(&self, number: ChainNumber) -> Chain<'_> {
        let ChainNumber(number) = number;
        let links = &self.links[self.starts[number]..self.starts[number + 1]];
        Chain { ends: self.ends[number], links }
    }

    /// The ends of chains that lie at each node: twice the number of the chain, plus one for its last end. `counts` says of which chains.
    #[must_use]
    pub fn ends_at(&self, network: &Network, counts: impl Fn(ChainNumber) -> bool) -> IndexLists {
        IndexLists::new(network.node_count(), 2 * self.len(), |end| {
            let number = ChainNumber(end / 2);
            let node = network.index_of(self.get(number).ends[end % 2]);
            counts(number).then_some(node).into_iter()
        })
    }

    /// The place of a link among the links of all chains.
    #[must_use]
    pub fn place_of(&self, ChainNumber(number): ChainNumber, index: usize) -> usize {
        self.starts[number] + index
    }

    /// How many links all chains have together.
    #[must_use]
    pub fn link_count(&self) -> usize {
        self.links.len()
    }

    /// The chain that a stretch of any other chains is in, and the number of its link there.
    #[must_use]
    pub fn of_link(&self, link: Link) -> (ChainNumber, usize) {
        self.of_stretch(link.stretch as usize)
    }

    fn of_stretch(&self, stretch: usize) -> (ChainNumber, usize) {
        let place = self.places[stretch] as usize;
        let chain = self.starts.partition_point(|&start| start <= place) - 1;
        (ChainNumber(chain), place - self.starts[chain])
    }

    /// The chains that the stretches of a road are in, in the road's order, each with the number of the link in its chain.
    pub fn of_road<'a>(
        &'a self,
        way: &NetworkWay,
    ) -> impl Iterator<Item = (ChainNumber, usize)> + 'a {
        let Range { start, end } = way.stops;
        (start..end.saturating_sub(1)).map(|stretch| self.of_stretch(stretch))
    }
}

/// How long chains are, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainLengths {
    /// The length of each chain.
    pub chains_m: Vec<f64>,
    /// Where each link begins and ends along its chain, by [`Chains::place_of`].
    pub links_m: Vec<[f64; 2]>,
}

impl Chains {
    /// Lengths by the distances between neighbouring points, in lattice steps. Sums run along whole chains: those of links would depend, in the last
    /// bit, on where ways are split.
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
    /// The road of a link.
    #[must_use]
    pub fn way_of(&self, link: Link) -> &NetworkWay {
        &self.ways[self.way_of_stretch(link.stretch)]
    }

    /// The nodes at both ends of a link, in the direction of the chain.
    #[must_use]
    pub fn nodes_of_link(&self, link: Link) -> [NodeNumber; 2] {
        let [first, last] = self.stretch_nodes(link.stretch).map(NodeNumber);
        if link.is_against { [last, first] } else { [first, last] }
    }

    /// What carries a chain of [`Breaks::JunctionsAndStructures`].
    #[must_use]
    pub fn structure_of(&self, chain: &Chain<'_>) -> Structure {
        chain.links.first().map_or(Structure::Ground, |&link| self.way_of(link).structure)
    }

    /// The points of a link, in the direction of the chain: two at least.
    #[must_use]
    pub fn points_of_link(&self, link: Link) -> impl DoubleEndedIterator<Item = LatticePoint> + '_ {
        let way = self.way_of(link);
        let [first, last] = [link.stretch, link.stretch + 1]
            .map(|stop| way.points.start + self.stop_points[stop as usize] as usize);
        let count = last + 1 - first;
        let at = move |k: usize| if link.is_against { last - k } else { first + k };
        (0..count).map(move |k| self.points[at(k)])
    }

    /// Whether a box around a chain has a place of some bounds.
    #[must_use]
    pub fn reaches(&self, chain: &Chain<'_>, bounds: &LatticeBounds) -> bool {
        let points = self.points_of_chain(chain);
        LatticeBounds::of(&points).is_some_and(|own| own.intersects(bounds))
    }

    /// The points of a chain, each once.
    #[must_use]
    pub fn points_of_chain(&self, chain: &Chain<'_>) -> Vec<LatticePoint> {
        let mut points: Vec<LatticePoint> = Vec::new();
        for &link in chain.links {
            points.extend(self.points_of_link(link).skip(usize::from(!points.is_empty())));
        }
        points
    }
}

/// Whether links that come back to where they begin run clockwise: the same whichever way roads were drawn. Of those with no area inside, whether the
/// other direction comes first in the order of points.
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
