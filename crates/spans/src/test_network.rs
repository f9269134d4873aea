//! Small networks drawn by hand, in metres, for tests of this crate.

use corniche_geom::{LatticePoint, Polyline};
use corniche_network::{Breaks, Chains, Network, NetworkBuilder};
use corniche_roads::{FunctionalRoadClass, Road, RoadAttributes, Structure};

/// A way through nodes, `(id, east, north)`.
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
        });
    }
    let network = builder.finish();
    let chains = Chains::of(&network, Breaks::JunctionsAndStructures);
    (network, chains)
}

/// Metres between two places.
pub(crate) fn distance_m(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[0] - from[0]).hypot(to[1] - from[1]) / 1000.0
}
