//! Runs of a bridge of 400 m over ground of any shape.

use std::{collections::BTreeSet, sync::Arc};

use corniche_geom::{
    Bounds, CoordinateTable, GridFrame, LatticeBounds, NodeIndex, Polyline, TileId,
};
use corniche_roads::{FunctionalRoadClass, RoadAttributes, Structure};
use corniche_store::{Artifacts, MemoryStore};
use corniche_testing::FlatProjection;

use super::*;
use crate::{
    artifacts::Kind,
    roads::{
        near_spans,
        pieces::{RoadPiece, Run, TilePiecesWriter},
    },
    spans::span_network::SpanInputs,
};

const QUANTUM_M: f64 = 0.125;

/// A bridge of 400 m between two roads, on a lattice of a millimetre or less, with its supports at 100 m and 140 m.
struct World {
    network: SpanNetwork,
    decks: Decks,
    /// Lattice steps to a metre.
    metre: i64,
}

impl World {
    fn new() -> Self {
        let frame = GridFrame::new([0.0, 0.0], 8.0, NodeIndex { i: 0, j: 256 }, 0).unwrap();
        let metre = (1.0 / frame.lattice_step_m()).round() as i64;
        let point = |metres: i64| LatticePoint::new(metres * metre, 1000 * metre);
        let piece = |way_id, structure, ends: [(i64, i64); 2]| RoadPiece {
            way_id,
            class: FunctionalRoadClass::new(3).unwrap(),
            attributes: Arc::new(RoadAttributes { structure, ..RoadAttributes::default() }),
            source_points: 0,
            simplified_points: 0,
            runs: vec![Run {
                line: Polyline::new(ends.map(|(metres, _)| point(metres)).to_vec()).unwrap(),
                segments_um: vec![(ends[1].0 - ends[0].0) as u64 * 1_000_000],
                from_um: 0,
                nodes: vec![(0, ends[0].1), (1, ends[1].1)],
            }],
        };
        let roads = [
            piece(1, Structure::Ground, [(500, 1), (600, 2)]),
            piece(2, Structure::Bridge, [(600, 2), (1000, 3)]),
            piece(3, Structure::Ground, [(1000, 3), (1100, 4)]),
        ];
        let store = MemoryStore::default();
        let mut writer = TilePiecesWriter::default();
        for (ordinal, road) in (0..).zip(&roads) {
            writer.push(ordinal, &road.to_bytes());
        }
        let key = Kind::RoadPieces.of_tile(TileId::ROOT);
        store.put(key, &writer.into_bytes()).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        near_spans::keep((&BTreeSet::from([key.item]), &[]), &store, 100.0, (&pool, u64::MAX))
            .unwrap();
        let projection = FlatProjection::new([1e5; 2]);
        let bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 2048.0, max_y: 2048.0 };
        let coordinates = CoordinateTable::sample(&projection, bounds, 0.01).unwrap();
        let within: LatticeBounds = frame.tile_lattice_bounds(TileId::ROOT);
        let inputs = SpanInputs {
            osm: &[],
            store: &store,
            frame: &frame,
            coordinates: &coordinates,
            within,
        };
        let network = SpanNetwork::load(&inputs).unwrap();
        let places = network.places();
        let along: Vec<(u32, u64)> =
            places.iter().map(|place| place.map(|at| (at.ordinal, at.along_um)).unwrap()).collect();
        assert_eq!(along, [(1, 0), (1, 400_000_000)]);
        let grounds_m = [Some(100.0), Some(140.0)];
        let decks = Decks::solve(Arc::clone(&network.spans), &network.crossings, &grounds_m);
        Self { network, decks, metre }
    }

    /// The runs over ground with these heights at distances along the bridge, metres.
    fn runs(&self, ground: &[(i64, f64)]) -> Vec<SpanRun> {
        self.found(ground).runs
    }

    /// What the bridge has over such ground.
    fn found(&self, ground: &[(i64, f64)]) -> LineRuns {
        let vertex = |&(metres, height_m): &(i64, f64)| GroundVertex {
            at: LatticePoint::new((600 + metres) * self.metre, 1000 * self.metre),
            triangle: metres as u32,
            next_triangle: metres as u32 + 1,
            height_m,
            along_um: metres as u64 * 1_000_000,
            is_source: metres == 0 || metres == 400,
        };
        let line = GroundLine {
            ordinal: 1,
            way_id: 2,
            class: FunctionalRoadClass::new(3).unwrap(),
            is_tunnel: false,
            vertices: ground.iter().map(vertex).collect(),
        };
        runs_of(&line, (&self.network, &self.decks), QUANTUM_M)
    }
}

/// Over a valley the deck is straight from support to support: vertices of the ground between them are left out.
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

/// Where a hill comes in its way, a bridge lies on the ground, from where the two meet: at 80 m and 312.5 m.
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
    // Where all is ground, there is no run.
    assert_eq!(world.runs(&[(0, 100.0), (200, 160.0), (400, 140.0)]), []);
}

/// A tile that holds the middle alone has a run that ends in the air on both sides.
#[test]
fn a_tile_within_a_bridge_has_a_run_without_ground() {
    let world = World::new();
    let runs = world.runs(&[(130, 60.0), (270, 60.0)]);
    let heights: Vec<SpanHeight> = runs[0].points.iter().map(|point| point.height).collect();
    assert_eq!(heights, [113.0, 127.0].map(|m| SpanHeight::Steps((m / QUANTUM_M) as i64)));
}
