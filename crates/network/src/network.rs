//! The ways of a network, with the nodes at which they meet.

use std::ops::Range;

use corniche_geom::{IndexLists, LatticePoint};
use corniche_roads::{FunctionalRoadClass, Oneway, Railway, Structure};

/// A road of a network. A way that is cut, at missing nodes or at the seam of the map, becomes
/// several roads with the same id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NetworkWay {
    /// OSM's id of the way.
    pub way_id: i64,
    /// Functional road class.
    pub class: FunctionalRoadClass,
    /// The kind of railway, if the way is one: it joins roads, and is none.
    pub railway: Option<Railway>,
    /// The structure that carries the road.
    pub structure: Structure,
    /// OSM's `layer`, which says which of two crossing roads is above.
    pub layer: i8,
    /// Permitted direction.
    pub oneway: Oneway,
    /// The range of the road's points among the points of the network.
    pub(crate) points: Range<usize>,
    /// The range of the road's stops among the stops of the network; at least two.
    pub(crate) stops: Range<usize>,
    /// The index of the road's `highway` among the texts of the network.
    pub(crate) highway: u32,
}

/// The number of a node at which roads may meet. Numbers ascend with OSM's ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeNumber(pub(crate) u32);

/// Roads, and the nodes in which they meet.
#[derive(Debug)]
pub struct Network {
    pub(crate) ways: Vec<NetworkWay>,
    /// The points of all ways, on the lattice of a package.
    pub(crate) points: Vec<LatticePoint>,
    /// The index of each stop among the points of its way.
    pub(crate) stop_points: Vec<u32>,
    /// The number of the node of each stop.
    pub(crate) stop_nodes: Vec<u32>,
    /// The id of each node. Places that are not nodes come last, without an id.
    pub(crate) node_ids: Vec<i64>,
    /// The number of nodes, including places that are not nodes.
    pub(crate) nodes: usize,
    /// The ends of stretches at each node: twice the number of the stretch, plus one for its second
    /// end. A stretch has the number of the stop at which it begins.
    pub(crate) ends_at: IndexLists,
    pub(crate) highways: Vec<String>,
    /// The network that carries the bridges and tunnels, if it is larger than this one.
    pub(crate) of_spans: Option<Box<Network>>,
}

impl Network {
    /// Returns the same network, with another network for its bridges and tunnels. That one has
    /// additional ways that carry or cross them.
    #[must_use]
    pub fn with_spans(self, of_spans: Self) -> Self {
        Self { of_spans: Some(Box::new(of_spans)), ..self }
    }

    /// Returns the network in which bridges and tunnels are solved: this one, or the one of
    /// [`Network::with_spans`]. The latter has roads of the same ways with the same points, as far
    /// as they are near bridges and tunnels.
    #[must_use]
    pub fn of_spans(&self) -> &Self {
        self.of_spans.as_deref().unwrap_or(self)
    }

    /// Returns the ways, ascending by id.
    #[must_use]
    pub fn ways(&self) -> &[NetworkWay] {
        &self.ways
    }

    /// Returns the roads of a way: several if the way is cut, none if the network does not contain
    /// it.
    #[must_use]
    pub fn roads_of(&self, way_id: i64) -> Range<usize> {
        let first = self.ways.partition_point(|way| way.way_id < way_id);
        let end = self.ways.partition_point(|way| way.way_id <= way_id);
        first..end
    }

    /// Returns the points of a road.
    #[must_use]
    pub fn points_of(&self, way: &NetworkWay) -> &[LatticePoint] {
        &self.points[way.points.clone()]
    }

    /// Returns OSM's `highway` value of a road.
    #[must_use]
    pub fn highway_of(&self, way: &NetworkWay) -> &str {
        self.highways.get(way.highway as usize).map_or("", String::as_str)
    }

    /// Returns the number of nodes at which roads begin, end or meet.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.nodes
    }

    /// Returns OSM's id of a node; `None` for an end that is not a node, where a road is cut.
    #[must_use]
    pub fn node_id(&self, node: NodeNumber) -> Option<i64> {
        self.node_ids.get(node.0 as usize).copied()
    }

    /// Returns the index of a node in a list of all nodes, from 0.
    #[must_use]
    pub fn index_of(&self, node: NodeNumber) -> usize {
        node.0 as usize
    }

    /// Returns the [`Network::degree`] of the node at an index.
    #[must_use]
    pub fn degree_at(&self, index: usize) -> usize {
        self.ends_at.list(index).len()
    }

    /// Returns the number of stretch ends at a node: 1 at a dead end, 2 where one road continues, 3
    /// and more at a junction.
    #[must_use]
    pub fn degree(&self, node: NodeNumber) -> usize {
        self.degree_at(self.index_of(node))
    }

    /// Returns the road of a stretch.
    pub(crate) fn way_of_stretch(&self, stretch: u32) -> usize {
        self.ways.partition_point(|way| way.stops.end <= stretch as usize)
    }

    /// Returns the nodes at both ends of a stretch, in the direction of its way.
    pub(crate) fn stretch_nodes(&self, stretch: u32) -> [u32; 2] {
        let first = stretch as usize;
        [self.stop_nodes[first], self.stop_nodes[first + 1]]
    }

    /// Returns the structure that carries the stretches at a node, if it is the same for all.
    pub(crate) fn structure_at(&self, node: u32) -> Option<Structure> {
        let structure = |end: &u32| self.ways[self.way_of_stretch(end / 2)].structure;
        let mut all = self.ends_at.list(node as usize).iter().map(structure);
        let first = all.next()?;
        all.all(|other| other == first).then_some(first)
    }
}
