//! Runs of a bridge of 400 m over ground of any shape.

use std::sync::Arc;

use corniche_geom::{GridFrame, NodeIndex, Polyline, TileId};
use corniche_roads::{FunctionalRoadClass, MetNodes, Road, RoadAttributes, Structure};
use corniche_store::MemoryStore;
use corniche_testing::{FlatProjection, MemoryScratch};
use corniche_tileset::RunOwner;
use corniche_work::Silent;

use super::*;
use crate::{
    layers::span_pieces::CarriedLine,
    roads::near_spans::{NearRoad, NearRoadsWriter},
    spans::span_network::SpanInputs,
};

const QUANTUM_M: f64 = 0.125;

/// A bridge of 400 m between two roads, on a lattice of a millimetre or less, with its supports at
/// 100 m and 140 m height.
struct World {
    network: SpanNetwork,
    decks: Decks,
    /// Lattice steps per metre.
    metre: i64,
}

impl World {
    fn new() -> Self {
        let frame = GridFrame::new([0.0, 0.0], 8.0, NodeIndex { i: 0, j: 256 }, 0).unwrap();
        let metre = (1.0 / frame.lattice_step_m()).round() as i64;
        let point = |metres: i64| LatticePoint::new(metres * metre, 1000 * metre);
        let store = MemoryStore::default();
        let scratch = MemoryScratch::default();
        let mut near = NearRoadsWriter::new(&scratch, 1 << 20);
        for (ordinal, (way_id, structure, ends)) in (0..).zip([
            (1, Structure::Ground, [(500, 1), (600, 2)]),
            (2, Structure::Bridge, [(600, 2), (1000, 3)]),
            (3, Structure::Ground, [(1000, 3), (1100, 4)]),
        ]) {
            let road = Road {
                way_id,
                class: FunctionalRoadClass::new(3).unwrap(),
                attributes: RoadAttributes { structure, ..RoadAttributes::default() },
                line: Polyline::new(ends.map(|(metres, _)| point(metres)).to_vec()).unwrap(),
                fixed: vec![0, 1],
                node_ids: ends.map(|(_, id)| Some(id)).to_vec(),
                same_places: Vec::new(),
                met: MetNodes::default(),
            };
            let length_um = (ends[1].0 - ends[0].0) as u64 * 1_000_000;
            near.push(NearRoad::from_road(&road, Some(ordinal), &[length_um], true)).unwrap();
        }
        near.finish((&store, &Silent), 100.0).unwrap();
        let projection = FlatProjection::new([1e5; 2]);
        let inputs = SpanInputs {
            store: &store,
            frame: &frame,
            projection: &projection,
            whole: frame.tile_lattice_bounds(TileId::ROOT),
        };
        let network = SpanNetwork::load(&inputs).unwrap();
        let places: Vec<LatticePoint> = network.places().iter().map(|place| place.at).collect();
        assert_eq!(places, [point(600), point(1000)]);
        let grounds_m = [Some(100.0), Some(140.0)];
        let decks = Decks::solve(Arc::clone(&network.spans), &network.crossings, &grounds_m);
        Self { network, decks, metre }
    }

    /// The runs over ground with these heights at distances along the bridge, metres.
    fn runs(&self, ground: &[(i64, f64)]) -> Vec<SpanRun> {
        self.found(ground).runs
    }

    /// The result for the bridge over this ground.
    fn found(&self, ground: &[(i64, f64)]) -> LineRuns {
        let vertex = |&(metres, height_m): &(i64, f64)| SpanGroundPoint {
            at: LatticePoint::new((600 + metres) * self.metre, 1000 * self.metre),
            triangle: metres as u32,
            next_triangle: metres as u32 + 1,
            height_m,
            along_um: metres as u64 * 1_000_000,
            is_source: metres == 0 || metres == 400,
        };
        let line = SpanGroundLine {
            of: SpanLineOf {
                line: CarriedLine::Road(1),
                way_id: 2,
                owner: RunOwner::Road(FunctionalRoadClass::new(3).unwrap()),
                structure: Structure::Bridge,
            },
            vertices: ground.iter().map(vertex).collect(),
        };
        runs_of(&line, (&self.network, &self.decks), QUANTUM_M)
    }
}

/// Over a valley the deck is straight from support to support: vertices of the ground between them
/// are omitted.
#[test]
fn a_deck_over_a_valley_is_one_run() {
    let world = World::new();
    let runs = world.runs(&[(0, 100.0), (100, 60.0), (200, 20.0), (300, 60.0), (400, 140.0)]);
    let points: Vec<(i64, SpanHeight)> =
        runs[0].points.iter().map(|point| (point.at.u / world.metre - 600, point.height)).collect();
    let ground = |metres| (metres, SpanHeight::Ground { triangle: metres as u32 });
    assert_eq!(runs.len(), 1);
    assert_eq!(points, [ground(0), ground(400)]);
}

/// If a hill blocks its way, a bridge follows the ground between the two points where they meet: at
/// 80 m and 312.5 m.
#[test]
fn a_hill_parts_a_deck() {
    let world = World::new();
    let ground = [(0, 100.0), (50, 90.0), (150, 150.0), (250, 150.0), (350, 120.0), (400, 140.0)];
    let runs = world.runs(&ground);
    let ends: Vec<[i64; 2]> = runs
        .iter()
        .map(|run| [0, run.points.len() - 1].map(|at| run.points[at].at.u / world.metre - 600))
        .collect();
    assert_eq!(ends, [[0, 80], [312, 400]]);
    let last = runs[0].points.last().unwrap();
    assert_eq!(last.height, SpanHeight::Ground { triangle: 51 }, "that of the edge from 50 m");
    assert!(
        (world.found(&ground).within_m - 35.0).abs() < 1e-9,
        "150 m at 150 m, where the deck has 115"
    );
    // If the bridge is on the ground everywhere, there is no run.
    assert_eq!(world.runs(&[(0, 100.0), (200, 160.0), (400, 140.0)]), []);
}

/// A tile that contains only the middle of a bridge has a run that ends in the air on both sides.
#[test]
fn a_tile_within_a_bridge_has_a_run_without_ground() {
    let world = World::new();
    let runs = world.runs(&[(130, 60.0), (270, 60.0)]);
    let heights: Vec<SpanHeight> = runs[0].points.iter().map(|point| point.height).collect();
    assert_eq!(heights, [113.0, 127.0].map(|m| SpanHeight::Steps((m / QUANTUM_M) as i64)));
}
