//! Places where a mesh is too far from the ground, against closed forms.

use spade::{DelaunayTriangulation, Triangulation as _};

use super::*;
use crate::quantized_mesh::{
    facets::MeshVertex,
    tiling::{RasterNodes, TerrainTile, Tiling},
};

/// A tile of some 20 km at the equator.
const TILE: TerrainTile = TerrainTile { z: 10, x: 1024, y: 512 };
const SIDE: f64 = LAST_STEP as f64;

fn frame() -> PointFrame {
    let nodes = RasterNodes { tiling: Tiling::Geographic, level: TILE.z, per_tile: 16, parts: 4 };
    PointFrame::new(nodes.square_of(TILE))
}

fn place(uv: [f64; 2], height_m: f64) -> [f64; 3] {
    let [lon, lat] = frame().square.place_deg(uv);
    [lon, lat, height_m]
}

/// Two triangles at a height of 0 over the tile, with a diagonal from south-west to north-east.
fn flat() -> Facets {
    let mut triangles = DelaunayTriangulation::new();
    // The middle divides it into four triangles.
    for [u, v] in [[0, 0], [LAST_STEP, 0], [LAST_STEP, LAST_STEP], [0, LAST_STEP], [16_000; 2]] {
        let at = place([u, v].map(f64::from), 0.0);
        triangles.insert(MeshVertex::new([u, v], at, [0.0, 0.0, 1.0])).unwrap();
    }
    Facets::new(&triangles, frame().middle_m)
}

fn comparison(points: &[([f64; 2], f64)], edges: Vec<[u32; 2]>) -> Comparison {
    let points = points.iter().map(|(uv, height_m)| frame().point(place(*uv, *height_m))).collect();
    Comparison::with_facets(frame(), Bends { points, edges }, flat())
}

#[test]
fn a_peak_is_the_farthest_point_of_its_triangle() {
    let mut found =
        comparison(&[([9000.0, 2000.5], 80.0), ([10_000.0, 2000.0], 100.0)], Vec::new());
    let far = found.far_points(50.0);
    assert_eq!(far.len(), 1);
    assert_eq!(far[0].point, Some(1));
    // A tile of 20 km bulges by at most 8 m.
    assert!((100.0..108.0).contains(&far[0].off_m), "{far:?}");
    assert!(comparison(&[([9000.0, 2000.5], 80.0)], Vec::new()).far_points(90.0).is_empty());
}

/// A ridge between two points on the triangles is found where it crosses edges of triangles; each
/// place is reported once.
#[test]
fn edges_are_seen_where_they_cross() {
    let ends = [([16_000.0, 2000.0], 100.0), ([16_000.0, 30_000.0], 300.0)];
    let mut found = comparison(&ends, vec![[0, 1]]);
    let crossings = found.far_crossings(50.0);
    // The line passes through the vertex in the middle, where the ground is half as high as at both
    // ends.
    assert_eq!(crossings.len(), 1, "{crossings:?}");
    assert!((crossings[0].uv[1] - 16_000.0).abs() < 1.0);
    // An edge of 17 km is followed to within some centimetres.
    assert!((crossings[0].off_m - 200.0).abs() < 0.1, "{crossings:?}");
    assert!(found.far_crossings(50.0).is_empty());
}

/// A line from outside the tile is followed from the border onwards.
#[test]
fn lines_from_outside_are_followed_inside() {
    let ends = [([-1000.0, 3000.0], 100.0), ([SIDE + 1000.0, 3000.0], 100.0)];
    let found = comparison(&ends, vec![[0, 1]]);
    let mut places = Vec::new();
    found.for_each_crossing(|_, uv, _| places.push(uv));
    assert_eq!(places.len(), 3, "two edges and the eastern border: {places:?}");
    assert!(places.iter().all(|uv| (uv[1] - 3000.0).abs() < 0.1));
    let beside = [([-1000.0, -10.0], 100.0), ([SIDE + 1000.0, -10.0], 100.0)];
    comparison(&beside, vec![[0, 1]]).for_each_crossing(|_, uv, _| panic!("{uv:?}"));
}

/// The globe's bulge over a flat triangle is length² / (8 · radius) in the middle of a side.
#[test]
fn ground_at_sea_level_is_a_bulge_over_triangles() {
    let found = comparison(&[([SIDE / 2.0, 0.0], 0.0)], Vec::new());
    let told = found.deviation([].iter(), 50.0, true, |_| Ok::<_, ()>(Vec::new())).unwrap();
    let side_m = (180.0_f64 / 1024.0).to_radians() * SEMI_MAJOR_M;
    assert_eq!(told.places, 1);
    assert!((told.largest_m - side_m * side_m / (8.0 * SEMI_MAJOR_M)).abs() < 0.01, "{told:?}");
}
