//! Small hand-drawn networks, in metres, for the tests of this crate.

use corniche_geom::{LatticePoint, Polyline};
use corniche_network::{Breaks, Chains, Network, NetworkBuilder};
use corniche_roads::{FunctionalRoadClass, MetNodes, Road, RoadAttributes, Structure};

use crate::{Decks, Spans, crossings};

/// A way through nodes, `(id, east, north)`.
#[derive(Clone)]
pub(crate) struct Way<'a> {
    pub(crate) id: i64,
    pub(crate) structure: Structure,
    pub(crate) layer: i8,
    pub(crate) highway: &'a str,
    pub(crate) nodes: Vec<(i64, i64, i64)>,
}

pub(crate) fn way(id: i64, structure: Structure, nodes: &[(i64, i64, i64)]) -> Way<'static> {
    Way { id, structure, layer: 0, highway: "secondary", nodes: nodes.to_vec() }
}

pub(crate) fn network(ways: &[Way<'_>]) -> (Network, Chains) {
    let mut builder = NetworkBuilder::default();
    for way in ways {
        let point =
            |&(_, east, north): &(i64, i64, i64)| LatticePoint::new(1000 * east, 1000 * north);
        let highway = way.highway.to_owned();
        builder.push(&Road {
            way_id: way.id,
            class: FunctionalRoadClass::new(5).unwrap(),
            attributes: RoadAttributes {
                structure: way.structure,
                layer: way.layer,
                highway,
                ..RoadAttributes::default()
            },
            line: Polyline::new(way.nodes.iter().map(point).collect()).unwrap(),
            fixed: (0..way.nodes.len() as u32).collect(),
            node_ids: way.nodes.iter().map(|&(id, ..)| Some(id)).collect(),
            same_places: Vec::new(),
            met: MetNodes::default(),
        });
    }
    let network = builder.finish();
    let chains = Chains::from_network(&network, Breaks::JunctionsAndStructures);
    (network, chains)
}

/// Returns the distance between two positions, metres.
pub(crate) fn distance_m(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1]) / 1000.0
}

/// Solves the spans of ways over the ground, and passes them to a test.
pub(crate) fn solved<T>(
    ways: &[Way<'_>],
    ground_m: impl Fn([f64; 2]) -> Option<f64>,
    test: impl FnOnce(&Decks, &Network, &Chains) -> T,
) -> T {
    let (network, chains) = network(ways);
    let spans = Spans::find(&network, &chains, &distance_m);
    let crossings = crossings(&network, &chains, &distance_m);
    let places = Decks::places(&spans, &crossings);
    let grounds_m: Vec<Option<f64>> =
        places.map(|at| ground_m(at.map(|part| part / 1000.0))).collect();
    let decks = Decks::solve(spans.into(), &crossings, &grounds_m);
    test(&decks, &network, &chains)
}

/// Returns the height of a way of one chain at a distance from its first node.
pub(crate) fn at(
    decks: &Decks,
    network: &Network,
    chains: &Chains,
    way_id: i64,
    along_m: f64,
) -> f64 {
    let way = &network.ways()[network.roads_of(way_id).start];
    let (chain, index) = chains.of_road(way).next().unwrap();
    let chain_found = chains.get(chain);
    let length_m = decks.spans().edges[decks.spans().edge_of(chain).unwrap()].length_m;
    let is_against = chain_found.links[index].is_against;
    decks.height_m(chain, if is_against { length_m - along_m } else { along_m }).unwrap()
}
