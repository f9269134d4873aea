//! Tiles of real ground are small. Prints figures; run with `--nocapture`.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and this one prints figures"
)]

use corniche_drape::{DrapedVertex, drape};
use corniche_geom::{GridFrame, LatticePoint, NodeIndex, Polyline, TileId};
use corniche_roads::FunctionalRoadClass;
use corniche_testing::srtm_heights;
use corniche_tileset::{
    GeoRoad, PayloadContext, Sections, TilePayload, TileTerrain, decode, encode,
};
use corniche_tin::{Placement, Surface, TinSpec, height_quantum_m, normals, triangulate};

const CELL_M: f64 = 90.0;

/// A winding line within the tile, like a road: 30 m segments that turn a little each time.
fn road(seed: u64, min: LatticePoint, side: i64, step: f64) -> Polyline {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut x, mut y, mut heading) =
        (random() * side as f64, random() * side as f64, random() * 6.3);
    let points = (0..20).map(|_| {
        heading += random() - 0.5;
        x = (x + step * heading.cos()).clamp(0.0, side as f64);
        y = (y + step * heading.sin()).clamp(0.0, side as f64);
        LatticePoint::new(min.u + x as i64, min.v + y as i64)
    });
    Polyline::new(points.collect()).unwrap()
}

#[test]
fn real_ground_and_roads_come_out_small_and_whole() {
    for max_error_m in [22.5, 5.0] {
        let Some(grid) = srtm_heights("liechtenstein/N47E009.hgt", 300, 500) else { return };
        let quantum_m = height_quantum_m(max_error_m);
        let tin = triangulate(&grid, TinSpec { max_error_m, quantum_m }).unwrap();
        let frame = GridFrame::new([0.0; 2], CELL_M, NodeIndex { i: 0, j: 256 }, 0).unwrap();
        let id = TileId::ROOT;
        let corner = frame.lattice_of_node(frame.tile_corner(id));
        let node_steps = frame.node_steps(0);
        let surface = Surface::new(&tin, Placement { corner, node_steps, quantum_m });
        let bounds = frame.tile_lattice_bounds(id);
        let mut roads = Vec::new();
        for way_id in 0..400 {
            let step = 30.0 / frame.lattice_step_m();
            let line = road(way_id, bounds.min, bounds.max.u - bounds.min.u, step);
            for (part, line) in drape(&line, &surface).lines.into_iter().enumerate() {
                let class = FunctionalRoadClass::new((way_id % 9) as u8).unwrap();
                roads.push(GeoRoad { way_id: way_id as i64, part: part as u32, class, line });
            }
        }
        roads.sort_by_key(|road| (road.class, road.way_id, road.part));
        let crossings = roads.iter().flat_map(|road| &road.line.vertices);
        let crossings =
            crossings.filter(|vertex| matches!(vertex, DrapedVertex::Crossing { .. })).count();
        let normals = normals(&grid, &tin, CELL_M.into(), 0);
        let (vertices, triangles) = (tin.vertices().len() as f64, tin.triangles().len() as f64);
        let terrain = TileTerrain {
            tin,
            normals,
            geometric_error_m: 22.0,
            height_range_m: [400.0, 2900.0],
            uncovered_nodes: 3,
        };
        let payload = TilePayload {
            id,
            terrain: Some(terrain),
            relief: None,
            roads_geo: roads,
            roads_sv: vec![],
            attributes: vec![],
        };
        let context = PayloadContext { frame, quantum_m, metres_per_unit: [1.0; 2] };
        let start = std::time::Instant::now();
        let encoded = encode(&payload, &context).unwrap();
        let encode_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = std::time::Instant::now();
        let decoded = decode(&encoded.bytes, id, &frame, quantum_m, Sections::ALL).unwrap();
        let decode_ms = start.elapsed().as_secs_f64() * 1e3;
        assert_eq!(decoded, payload);
        let terrain_ms = (0..10).map(|_| {
            let start = std::time::Instant::now();
            decode(&encoded.bytes, id, &frame, quantum_m, Sections::TERRAIN).unwrap();
            start.elapsed().as_secs_f64() * 1e3
        });
        println!(
            "terrain alone: {:.2} ms to decode at best",
            terrain_ms.fold(f64::INFINITY, f64::min)
        );

        // The same roads reduced to their source points: the difference is the size of crossings.
        let points = payload.roads_geo.iter().flat_map(|road| &road.line.vertices);
        let points = points.filter(|vertex| matches!(vertex, DrapedVertex::Source { .. })).count();
        println!(
            "max error {max_error_m} m: {vertices} vertices, {triangles} triangles: terrain {} bytes ({} raw), \
             {:.2} bytes/vertex, {:.2} bytes/triangle; {crossings} crossings, {points} points: GEO {} bytes, \
             {:.2} bytes/point; encode {encode_ms:.1} ms, decode {decode_ms:.1} ms",
            encoded.sizes.terrain.stored,
            encoded.sizes.terrain.raw,
            encoded.sizes.terrain.stored as f64 / vertices,
            encoded.sizes.terrain.stored as f64 / triangles,
            encoded.sizes.roads_geo.stored,
            encoded.sizes.roads_geo.stored as f64 / points as f64,
        );
        assert!(
            (encoded.sizes.terrain.stored as f64) < 3.0 * triangles,
            "terrain is no longer compact"
        );
        // A lattice point alone takes about five bytes; crossings must add almost nothing.
        assert!(
            (encoded.sizes.roads_geo.stored as f64) < 6.5 * points as f64,
            "roads are no longer compact"
        );
    }
}
