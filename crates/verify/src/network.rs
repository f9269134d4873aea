//! The roads of a package's extract as a network, for measurements along roads.

use std::collections::HashSet;

use corniche_drape::OwnedBorders;
use corniche_geom::LatticeBounds;
use corniche_network::{Breaks, Chains, Network, NetworkBuilder};
use corniche_osm::{ExtractSummary, LayerSink, Layers};
use corniche_pieces::{
    ExtractError,
    layers::fixed_points::road_of_part,
    roads::{
        layer::NEAR_M,
        near_spans::{self, NearRoad, NearRoadsWriter},
    },
    spans::outer_ground::whole_rectangle,
};
use corniche_roads::{Railway, Road};
use corniche_spec::{BuildObserver, levels::most_scale};
use corniche_store::MemoryStore;
use corniche_tileset::FilePackage;

use super::{
    error::VerifyError, read_again::read_again, temporary_store::TemporaryStore,
    verify_settings::VerifyOsm,
};

/// Roads are read as far as this around the data, in true metres: roads farther away have no
/// influence on how a road is smoothed.
const AROUND_M: f64 = 10_000.0;

/// Reads the extracts from which a package was built again, and builds a network of their roads,
/// with points on the package's lattice, and of the ways of all classes near bridges and tunnels.
/// Roads continue beyond the bounds of a package, to the rectangle of all elevation data, at which
/// they are cut.
///
/// # Errors
/// When a file cannot be read, changes meanwhile, or the files are not those of the build.
pub fn network(
    package: &FilePackage,
    extract: &VerifyOsm,
    threads: usize,
    observer: &dyn BuildObserver,
) -> Result<Network, VerifyError> {
    let manifest = package.manifest();
    let frame = &manifest.frame;
    let steps = |true_m: f64| true_m * most_scale(manifest.scale.largest) / frame.lattice_step_m();
    let data = frame.lattice_bounds(manifest.data_nodes());
    let work = TemporaryStore::new(observer)?;
    let scratch = work.scratch()?;
    let mut found = RelevantRoads {
        data,
        around: data.expanded(steps(AROUND_M) as i64),
        whole: whole_rectangle(frame, &manifest.whole_data_bounds()),
        roads: NetworkBuilder::default(),
        near_spans: NearRoadsWriter::new(&scratch, extract.memory_bytes / 4),
        failed: None,
    };
    let layers = Layers { roads: Some(&mut found), ..Layers::default() };
    read_again(package, (extract, layers), threads, observer)?;
    let RelevantRoads { whole, roads, mut near_spans, failed, .. } = found;
    failed.map_or(Ok(()), Err)?;
    let roads = roads.finish();
    let of_edges = ways_of_edges(&roads, &data);
    near_spans.reach(|way_id| of_edges.contains(&way_id));
    let store = MemoryStore::default();
    near_spans.finish((&store, observer), steps(NEAR_M))?;
    let mut of_spans = NetworkBuilder::default();
    near_spans::for_each(&store, |near| {
        if let Some(road) = near.road() {
            push(&mut of_spans, (&road, near.railway), &whole);
        }
    })?;
    Ok(roads.with_spans(of_spans.finish()))
}

/// The ways of the edges that reach the data: an edge is exported whole, with its bridges outside
/// the data.
fn ways_of_edges(network: &Network, data: &LatticeBounds) -> HashSet<i64> {
    let edges = Chains::from_network(network, Breaks::Junctions);
    let all = edges.numbers().map(|number| edges.get(number));
    all.filter(|edge| network.reaches(edge, data))
        .flat_map(|edge| edge.links.iter().map(|&link| network.way_of(link).way_id))
        .collect()
}

/// Adds the parts of a road or a railway inside the data to a network.
fn push(
    network: &mut NetworkBuilder,
    (road, railway): (&Road, Option<Railway>),
    whole: &LatticeBounds,
) {
    if road.line.points().iter().all(|point| whole.contains(*point)) {
        network.push_way(road, railway);
        return;
    }
    for part in corniche_drape::clip_parts(&road.line, whole, OwnedBorders::ALL) {
        network.push_way(&road_of_part(road, part), railway);
    }
}

struct RelevantRoads<'a> {
    /// The rectangle of the package's data.
    data: LatticeBounds,
    /// The rectangle around the data from which roads are read; roads outside take no memory.
    around: LatticeBounds,
    /// The rectangle of all elevation data.
    whole: LatticeBounds,
    roads: NetworkBuilder,
    near_spans: NearRoadsWriter<'a>,
    failed: Option<ExtractError>,
}

impl RelevantRoads<'_> {
    /// Whether the rectangle around a road reaches the data.
    fn reaches(&self, road: &Road) -> bool {
        let bounds = LatticeBounds::around(road.line.points());
        bounds.is_some_and(|bounds| bounds.intersects(&self.data))
    }

    fn take_near(&mut self, near: NearRoad) {
        if self.failed.is_none()
            && let Err(error) = self.near_spans.push(near)
        {
            self.failed = Some(error);
        }
    }
}

impl LayerSink<Road, ExtractSummary> for RelevantRoads<'_> {
    fn take(&mut self, road: Road) {
        self.take_near(NearRoad::from_road(&road, Some(0), &[], self.reaches(&road)));
        let bounds = LatticeBounds::around(road.line.points());
        if bounds.is_some_and(|bounds| bounds.intersects(&self.around)) {
            push(&mut self.roads, (&road, None), &self.whole);
        }
    }

    fn take_carrier(&mut self, road: Road, railway: Option<Railway>) {
        self.take_near(NearRoad::of_carrier(&road, railway, &[], self.reaches(&road)));
    }

    fn end(&mut self, _: ExtractSummary) {}
}

#[cfg(test)]
#[path = "network_tests.rs"]
mod tests;
