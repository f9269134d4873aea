//! The roads of a package's extract as a network, for who measures along them.

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_network::{Network, NetworkBuilder};
use corniche_osm::{ExtractSummary, LayerSink, Layers};
use corniche_roads::Road;
use corniche_tileset::FilePackage;

use super::{error::VerifyError, read_again::read_again, verify_settings::VerifyOsm};
use crate::{Observer, layers::fixed_points::road_of_part};

/// Reads the extracts that a package was made from again, and makes a network of their roads, with their points on the package's lattice. Roads are cut
/// at the rectangle of the package's data.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or they are not those of the build.
pub fn network(
    package: &FilePackage,
    extract: &VerifyOsm,
    threads: usize,
    observer: &dyn Observer,
) -> Result<Network, VerifyError> {
    let frame = &package.manifest().frame;
    let data = frame.lattice_bounds(package.manifest().data_nodes());
    let mut found = Found { data, roads: NetworkBuilder::default() };
    let layers = Layers { roads: Some(&mut found), ..Layers::default() };
    read_again(package, (extract, layers), threads, observer)?;
    Ok(found.roads.finish())
}

struct Found {
    /// The rectangle of the data. What lies outside costs nothing.
    data: LatticeBounds,
    roads: NetworkBuilder,
}

impl LayerSink<Road, ExtractSummary> for Found {
    fn take(&mut self, road: Road) {
        let is_inside = |point: &LatticePoint| self.data.contains(*point);
        if road.line.points().iter().all(is_inside) {
            self.roads.push(&road);
        } else {
            for part in corniche_drape::clip_parts(&road.line, &self.data, OwnedBorders::ALL) {
                self.roads.push(&road_of_part(&road, part));
            }
        }
    }

    fn end(&mut self, _: ExtractSummary) {}
}

#[cfg(test)]
#[path = "network_tests.rs"]
mod tests;
