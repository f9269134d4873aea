//! Roads by their numbers or names, and ways through the network from place to place.
//!
//! ```text
//!   attributes of tiles ──► ways that are meant ──┐
//!   lines of tiles, or an extract ──► network ────┴──► graph of links ──► shortest way ──► a course for a profile
//! ```

mod find_route;
mod graph;
mod package_network;

use corniche_network::Network;
use corniche_roads::FunctionalRoadClass;
use corniche_tileset::FilePackage;
use corniche_work::Observer;

pub use self::find_route::{Route, RouteRequest};
use self::{find_route::Finder, graph::RoadGraph, package_network::package_network};
use crate::{
    error::{RouteError, SelectionError},
    places::{Coordinates, Places},
    read,
    road_query::named_ways,
};

/// The shortest way from place to place, or along a whole road. Roads join as they do in the network, or else where lines of the package have a point
/// in common.
///
/// # Errors
/// When no road is meant, or several are; when a place is far from roads, nothing joins both, or the package is damaged.
pub fn route(
    package: &FilePackage,
    request: &RouteRequest,
    network: Option<&Network>,
    observer: &dyn Observer,
) -> Result<Route, RouteError> {
    let manifest = package.manifest();
    SelectionError::check_roads(package)?;
    let level = read::level(package, request.level)?;
    let places = Places::new(manifest, Coordinates::Package)?;
    let roads = named_ways(package, level, request.road.as_ref(), observer)?;
    let own;
    let network = if let Some(network) = network {
        network
    } else {
        let classes: Vec<FunctionalRoadClass> = FunctionalRoadClass::all().collect();
        own = package_network(package, level, &classes, observer)?;
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
