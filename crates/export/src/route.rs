//! Finds roads by their numbers or names, and routes through the network from place to place.
//!
//! ```text
//!   attributes of tiles ──► ways that match ──────┐
//!   lines of tiles, or an extract ──► network ────┴──► graph of links ──► shortest route ──► a course for a profile
//! ```

mod find_route;
mod graph;
mod package_network;

use corniche_network::Network;
use corniche_tileset::FilePackage;
use corniche_work::Observer;

pub use self::find_route::{NetworkRoute, RouteRequest};
use self::{find_route::Finder, graph::RoadGraph, package_network::package_network};
use crate::{
    error::{RouteError, SelectionError},
    places::{FeatureCoordinates, Places},
    read,
    road_query::named_ways,
};

/// Returns the shortest route from place to place, or along a whole road. Roads join as they do in
/// the network; without a network, they join where lines of the package share a point.
///
/// # Errors
/// When no road matches, or several do; when a place is far from roads, nothing connects both
/// places, or the package is corrupt.
pub fn route(
    package: &FilePackage,
    request: &RouteRequest,
    network: Option<&Network>,
    observer: &dyn Observer,
) -> Result<NetworkRoute, RouteError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let level = read::level(package, request.level)?;
    let places = Places::new(manifest, FeatureCoordinates::Package)?;
    let roads = named_ways(package, level, request.road.as_ref(), observer)?;
    let own;
    let network = if let Some(network) = network {
        network
    } else {
        own = package_network(package, level, observer)?;
        &own
    };
    let graph = RoadGraph::new(network, &places, |way| {
        let is_taken =
            roads.known.contains_key(&way.way_id) && request.classes.contains(&way.class);
        is_taken.then(|| request.road.is_none() || roads.meant.contains(&way.way_id))
    });
    let finder = Finder { graph: &graph, roads: &roads, road: request.road.as_ref() };
    match request.ends_deg {
        Some(ends_deg) => finder.between(ends_deg),
        None => finder.whole(),
    }
}
