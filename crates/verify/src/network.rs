//! The roads of a package's extract as a network, for who measures along them.

use std::collections::HashSet;

use corniche_drape::OwnedBorders;
use corniche_geom::LatticeBounds;
use corniche_network::{Breaks, Chains, Network, NetworkBuilder};
use corniche_osm::{ExtractSummary, LayerSink, Layers};
use corniche_pieces::ExtractError;
use corniche_pieces::{
    layers::fixed_points::road_of_part,
    roads::{
        layer::NEAR_M,
        near_spans::{self, NearRoad, NearRoadsWriter},
    },
    spans::outer_ground::whole_rectangle,
};
use corniche_roads::Road;
use corniche_spec::{Observer, levels::most_scale};
use corniche_store::MemoryStore;
use corniche_tileset::FilePackage;

use super::{
    error::VerifyError, read_again::read_again, temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};

/// Roads are read as far as this around the data, true metres: what lies farther away has no part in how a road is smoothed.
const AROUND_M: f64 = 10_000.0;

/// Reads the extracts that a package was made from again, and makes a network of their roads, with their points on the package's lattice, and of the
/// ways of all classes near bridges and tunnels. Roads go on beyond the bounds of a package, as far as there are elevation data; they are cut
/// at the rectangle of these.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or they are not those of the build.
pub fn network(
    package: &FilePackage,
    extract: &VerifyOsm,
    threads: usize,
    observer: &dyn Observer,
) -> Result<Network, VerifyError> {
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let steps = |true_m: f64| true_m * most_scale(manifest.scale.largest) / frame.lattice_step_m();
    let data = frame.lattice_bounds(manifest.data_nodes());
    let work = TemporaryStore::new(observer)?;
    let scratch = work.scratch()?;
    let mut found = Found {
        data,
        around: data.expanded(steps(AROUND_M) as i64),
        whole: whole_rectangle(frame, &manifest.whole_data_bounds()),
        roads: NetworkBuilder::default(),
        near_spans: NearRoadsWriter::new(&scratch, extract.memory_bytes / 4),
        failed: None,
    };
    let layers = Layers { roads: Some(&mut found), ..Layers::default() };
    read_again(package, (extract, layers), threads, observer)?;
    let Found { whole, roads, mut near_spans, failed, .. } = found;
    failed.map_or(Ok(()), Err)?;
    let roads = roads.finish();
    let of_edges = ways_of_edges(&roads, &data);
    near_spans.reach(|way_id| of_edges.contains(&way_id));
    let store = MemoryStore::default();
    near_spans.finish((&store, observer), steps(NEAR_M))?;
    let mut of_spans = NetworkBuilder::default();
    near_spans::for_each(&store, |near| {
        if let Some(road) = near.road() {
            push(&mut of_spans, &road, &whole);
        }
    })?;
    Ok(roads.with_spans(of_spans.finish()))
}

/// The ways of the edges that reach the data: an edge is exported whole, with bridges that lie beyond.
fn ways_of_edges(network: &Network, data: &LatticeBounds) -> HashSet<i64> {
    let edges = Chains::of(network, Breaks::Junctions);
    let all = edges.numbers().map(|number| edges.get(number));
    all.filter(|edge| network.reaches(edge, data))
        .flat_map(|edge| edge.links.iter().map(|&link| network.way_of(link).way_id))
        .collect()
}

/// Adds a road to a network, as far as it lies within the data.
fn push(roads: &mut NetworkBuilder, road: &Road, whole: &LatticeBounds) {
    if road.line.points().iter().all(|point| whole.contains(*point)) {
        roads.push(road);
        return;
    }
    for part in corniche_drape::clip_parts(&road.line, whole, OwnedBorders::ALL) {
        roads.push(&road_of_part(road, part));
    }
}

struct Found<'a> {
    /// The rectangle of the package's data.
    data: LatticeBounds,
    /// What lies outside costs nothing.
    around: LatticeBounds,
    /// The rectangle of all elevation data.
    whole: LatticeBounds,
    roads: NetworkBuilder,
    near_spans: NearRoadsWriter<'a>,
    failed: Option<ExtractError>,
}

impl Found<'_> {
    fn take_near(&mut self, road: &Road, ordinal: Option<u32>) {
        let bounds = LatticeBounds::of(road.line.points());
        let is_reached = bounds.is_some_and(|bounds| bounds.intersects(&self.data));
        let near = NearRoad::of(road, ordinal, &[], is_reached);
        if self.failed.is_none()
            && let Err(error) = self.near_spans.push(near)
        {
            self.failed = Some(error);
        }
    }
}

impl LayerSink<Road, ExtractSummary> for Found<'_> {
    fn take(&mut self, road: Road) {
        self.take_near(&road, Some(0));
        let bounds = LatticeBounds::of(road.line.points());
        if bounds.is_some_and(|bounds| bounds.intersects(&self.around)) {
            push(&mut self.roads, &road, &self.whole);
        }
    }

    fn take_carrier(&mut self, road: Road) {
        self.take_near(&road, None);
    }

    fn end(&mut self, _: ExtractSummary) {}
}

#[cfg(test)]
#[path = "network_tests.rs"]
mod tests;
