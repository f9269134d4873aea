//! The roads of a package's extract as a network, for who measures along them.

use corniche_drape::OwnedBorders;
use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_network::{Network, NetworkBuilder};
use corniche_osm::{ExtractSummary, LayerSink, Layers, read_extract};
use corniche_roads::Road;
use corniche_tileset::FilePackage;

use super::{
    checks::Findings, error::VerifyError, georeference, osm, temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};
use crate::{
    BuildError, Observer, Stage,
    extract::placed_reading::PlacedReading,
    inputs::{Inputs, OtherInputs},
    layers::fixed_points::road_of_part,
};

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
    let others = OtherInputs { osm: &extract.paths, polygon: None, photo: &[] };
    let inputs = Inputs::find(&[], others)?;
    let read = read(package, extract, (&inputs, threads), observer);
    VerifyError::unless_changed(&inputs, read)
}

fn read(
    package: &FilePackage,
    extract: &VerifyOsm,
    (inputs, threads): (&Inputs, usize),
    observer: &dyn Observer,
) -> Result<Network, VerifyError> {
    let manifest = package.manifest();
    let mut findings = Findings::default();
    let paths = osm::check_inputs(manifest, extract, inputs, &mut findings, observer)?;
    let crs = georeference::recorded(manifest)?;
    let projection = crs.projection(manifest.area_deg())?;
    let work = TemporaryStore::new(observer)?;
    let scratch = work.scratch()?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| BuildError::Start { what: error.to_string() })?;
    let reading = PlacedReading {
        osm: &paths,
        table: &osm::chosen(&extract.table, manifest),
        frame: &manifest.frame,
        projection: &projection,
        node_ids: true,
        pool: &pool,
        memory_bytes: extract.memory_bytes,
    };
    let data = manifest.frame.lattice_bounds(manifest.data_nodes());
    let mut found = Found { data, roads: NetworkBuilder::default() };
    observer.begin(Stage::Extract, None);
    let on_progress = |done, total| observer.reached(Stage::Extract, done, total);
    let should_stop = || observer.is_cancelled();
    reading.read(&scratch, (observer, &on_progress), |request| {
        let layers = Layers { roads: Some(&mut found), ..Layers::default() };
        // What is wrong with the extract was told when the package was built.
        read_extract(request, layers, &mut |_| {}, &should_stop)
    })?;
    observer.end(Stage::Extract);
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
