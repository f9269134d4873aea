//! Prisms over areas are closed, and areas extend a little beyond their tile.

use std::collections::BTreeMap;

use corniche_geom::{Cell, NodeIndex};
use corniche_tileset::LayerSlot;

use super::*;
use crate::tiles::{GroundVertex, relative};

type Ring = Vec<LatticePoint>;

/// Classes of different layers.
fn water() -> LayerClass {
    LayerClass { layer: LayerSlot::new(0_u8).unwrap(), class: 5 }
}

fn rock() -> LayerClass {
    LayerClass { layer: LayerSlot::new(1_u8).unwrap(), class: 2 }
}

fn ring(points: &[[i64; 2]]) -> Ring {
    points.iter().map(|[u, v]| LatticePoint::new(*u, *v)).collect()
}

fn square([u, v]: [i64; 2], side: i64) -> Ring {
    ring(&[[u, v], [u + side, v], [u + side, v + side], [u, v + side]])
}

fn mesh(rings: &[Ring]) -> PlanMesh {
    PlanMesh::inside(rings, LatticePoint::new(0, 0)).expect("rings that do not cross")
}

/// Twice the area inside rings by the shoelace formula; holes have the opposite direction.
fn doubled_area(rings: &[Ring]) -> i64 {
    let pairs = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    pairs.map(|(a, b)| a.u * b.v - b.u * a.v).sum()
}

/// Checks that triangles and walls close a prism: every edge of a triangle meets one other triangle
/// or wall, and each point of the rings is a corner.
fn check(rings: &[Ring]) -> PlanMesh {
    let mesh = mesh(rings);
    let mut sum_of_edge: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    let mut add = |from: u32, to: u32| {
        *sum_of_edge.entry([from.min(to), from.max(to)]).or_default() +=
            if from < to { 1 } else { -1 };
    };
    for corners in &mesh.triangles {
        (0..3).for_each(|k| add(corners[k], corners[(k + 1) % 3]));
    }
    mesh.edges.iter().for_each(|[from, to]| add(*to, *from));
    assert!(sum_of_edge.values().all(|sum| *sum == 0), "{sum_of_edge:?}");
    let of_triangles: i64 = mesh
        .triangles
        .iter()
        .map(|corners| corners.map(|index| mesh.points[index as usize]).to_vec())
        .map(|triangle| doubled_area(&[triangle]))
        .inspect(|area| assert!(*area > 0, "counter-clockwise"))
        .sum();
    assert_eq!(of_triangles, doubled_area(rings));
    mesh
}

#[test]
fn prisms_over_concave_and_nested_rings_are_closed() {
    check(&[ring(&[[0, 0], [9, 0], [9, 9], [5, 2], [0, 9]])]);
    let hole = || ring(&[[2, 2], [2, 6], [6, 6], [6, 2]]);
    let island = square([3, 3], 2);
    assert_eq!(check(&[square([0, 0], 9), hole()]).edges.len(), 8);
    check(&[square([0, 0], 9), hole(), island]);
}

#[test]
fn points_on_a_straight_side_are_corners_too() {
    let mesh = check(&[ring(&[[0, 0], [3, 0], [7, 0], [9, 0], [9, 9], [0, 9]])]);
    assert_eq!((mesh.points.len(), mesh.edges.len(), mesh.triangles.len()), (6, 6, 4));
}

#[test]
fn rings_may_touch_and_what_is_there_twice_cancels_out() {
    // A hole that touches the outline at a point, and two squares that touch at a corner.
    check(&[square([0, 0], 9), ring(&[[0, 0], [2, 5], [5, 2]])]);
    check(&[square([0, 0], 4), square([4, 4], 4)]);
    // The common side of two squares has no wall.
    assert_eq!(check(&[square([0, 0], 4), square([4, 0], 4)]).edges.len(), 6);
}

#[test]
fn rings_that_cross_are_refused() {
    let bow_tie = ring(&[[0, 0], [9, 9], [9, 0], [0, 9]]);
    assert_eq!(PlanMesh::inside(&[bow_tie], LatticePoint::new(0, 0)), None);
}

const TILE: LatticeBounds =
    LatticeBounds { min: LatticePoint::new(0, 0), max: LatticePoint::new(100, 100) };

fn stripped(points: &[[i64; 2]]) -> Ring {
    with_strips(&ring(points), Strip { tile: TILE, wide: [5, 7] })
}

#[test]
fn sides_along_the_border_are_moved_outwards() {
    assert_eq!(
        stripped(&[[50, 20], [100, 30], [100, 40], [100, 60]]),
        ring(&[[50, 20], [100, 30], [105, 30], [105, 40], [105, 60], [100, 60]])
    );
    assert_eq!(
        stripped(&[[0, 0], [60, 0], [0, 40]]),
        ring(&[[-5, -7], [60, -7], [60, 0], [0, 40], [-5, 40]]),
        "a corner of the tile"
    );
    let touching = [[50, 20], [100, 30], [50, 40]];
    assert_eq!(stripped(&touching), ring(&touching), "a single point on the border is not a side");
    let whole = [[0, 0], [100, 0], [100, 100], [0, 100]];
    assert_eq!(stripped(&whole), ring(&[[-5, -7], [105, -7], [105, 107], [-5, 107]]));
}

fn frame() -> GridFrame {
    let cell = Cell { east_m: 10.0, north_m: 10.0 }.fitted();
    GridFrame::new([0.0, 0.0], cell, NodeIndex { i: 0, j: 256 }, 0).expect("a frame")
}

/// Ground over the whole tile: level in the west, and rising from the middle to 300 m in the east.
fn ground(reference_m: [f64; 3]) -> GroundMesh {
    let vertices = [0.0, 1280.0, 2560.0].into_iter().flat_map(|x| {
        [0.0, 2560.0].map(|y| GroundVertex {
            position_in_tile: relative([x, y, (x - 1280.0_f64).max(0.0) / 4.267], reference_m),
            normal_skirt: [0, 0, 127, 0],
        })
    });
    let indices = [0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5];
    GroundMesh::of_surface(vertices.collect(), indices.into_iter())
}

fn area(class: LayerClass, frame: &GridFrame, corners_m: &[[f64; 2]]) -> TileArea {
    let ring = corners_m.iter().map(|at| frame.snap(*at).expect("on the lattice")).collect();
    TileArea { class, object: OsmObject::Way(7), polygons: vec![AreaPolygon { rings: vec![ring] }] }
}

fn at(west: f64, south: f64, side: f64) -> [[f64; 2]; 4] {
    [[west, south], [west + side, south], [west + side, south + side], [west, south + side]]
}

#[test]
fn volumes_reach_just_beyond_the_ground_near_them_and_are_sorted_by_class() {
    let (frame, reference_m) = (frame(), [1280.0, 1280.0, 100.0]);
    let areas = [
        area(rock(), &frame, &at(2000.0, 500.0, 100.0)),
        area(water(), &frame, &at(200.0, 300.0, 100.0)),
        area(rock(), &frame, &at(2200.0, 500.0, 100.0)),
    ];
    let volumes =
        AreaVolumes::new(&areas, TileId::ROOT, &frame, &ground(reference_m), reference_m).unwrap();
    let found: Vec<_> = volumes
        .classes
        .iter()
        .map(|class| (class.class, class.polygons, class.walls.clone(), class.triangles.clone()))
        .collect();
    let expected = [(water(), 1, 0..4, 0..6), (rock(), 2, 4..12, 6..18)];
    assert_eq!(found, expected);
    // An eighth of a cell.
    assert_eq!(volumes.walls[0].heights_in_tile, [-101.25, -98.75]);
    let [bottom, top] = volumes.walls[4].heights_in_tile;
    assert!(bottom <= -1.25 - 100.0 && (199.0..203.0).contains(&top), "{bottom} {top}");
    assert_eq!(
        volumes.classes[0].box_in_tile,
        [[-1080.0, -980.0, -101.25], [-980.0, -880.0, -98.75]]
    );
}

#[test]
fn an_outline_that_crosses_itself_is_named() {
    let (frame, reference_m) = (frame(), [1280.0, 1280.0, 100.0]);
    let bow_tie = [[100.0, 100.0], [900.0, 900.0], [900.0, 100.0], [100.0, 900.0]];
    let areas = [area(rock(), &frame, &bow_tie)];
    let ground = ground(reference_m);
    let error = AreaVolumes::new(&areas, TileId::ROOT, &frame, &ground, reference_m).unwrap_err();
    assert_eq!(error.to_string(), "the outline of way 7 crosses itself");
    let nowhere = AreaVolumes::new(&areas[..0], TileId::ROOT, &frame, &ground, reference_m);
    assert_eq!(nowhere, Ok(AreaVolumes::default()));
}

/// Forty thousand areas as large as the tile over a hundred thousand triangles: few bytes, but many
/// pairs.
#[test]
#[ignore = "slow: a thousand million triangles are checked before the limit is reached"]
fn too_many_areas_over_too_many_triangles_are_refused() {
    let (frame, reference_m) = (frame(), [1280.0, 1280.0, 100.0]);
    let square = [[0.0, 0.0], [2560.0, 0.0], [2560.0, 2560.0], [0.0, 2560.0]];
    let areas = vec![area(rock(), &frame, &square); 40_000];
    let tin = corniche_testing::package::full_tin();
    let normals = vec![[0, 0]; tin.vertices().len()];
    let full = GroundMesh::new(TileId::ROOT, &tin, &normals, &frame, 1.0, reference_m);
    let laid =
        |count: usize| AreaVolumes::new(&areas[..count], TileId::ROOT, &frame, &full, reference_m);
    assert!(laid(20).is_ok());
    assert_eq!(laid(40_000), Err(BadAreas::TooMuch(TooMuchWork { limit: MOST_TILE_STEPS })));
}
