//! Slabs are closed, face outwards, and have the area and the volume of their parts.

use std::collections::HashMap;

use corniche_geom::LatticePoint;
use proptest::prelude::*;

use super::{Slab, SlabLabels};
use crate::surfaces::{ground::LabelledMesh, ribbon::CenterLine};

const STEPS_PER_M: f64 = 1000.0;
const LABELS: SlabLabels = SlabLabels { road: 1, others: 2 };

/// The slab of a line in whole metres with the heights of its deck.
fn slab(points: &[[i64; 2]], deck_m: &[f64], width_m: f64, thickness_m: f64) -> LabelledMesh {
    let steps = STEPS_PER_M as i64;
    let center = CenterLine {
        points: points.iter().map(|[x, y]| LatticePoint::new(x * steps, y * steps)).collect(),
        beyond: [None; 2],
        is_met: [false; 2],
        half_width: width_m / 2.0 * STEPS_PER_M,
    };
    let mut mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    let slab = Slab { center: &center, deck_m, thickness_m, steps_per_m: STEPS_PER_M };
    slab.add_to(&mut mesh, LABELS);
    mesh
}

fn places_m(mesh: &LabelledMesh, triangle: [u32; 3]) -> [[f64; 3]; 3] {
    triangle.map(|corner| {
        let vertex = &mesh.vertices[corner as usize];
        let [x, y] = vertex.at.map(|steps| steps / STEPS_PER_M);
        [x, y, vertex.height_m]
    })
}

/// Twice the area, along the normal.
fn area_vector([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    super::normal([a, b, c])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn volume_m3(mesh: &LabelledMesh) -> f64 {
    let all = mesh.triangles.iter().map(|triangle| places_m(mesh, *triangle));
    all.map(|places| dot(places[0], area_vector(places)) / 6.0).sum()
}

fn area_m2(mesh: &LabelledMesh, label: u32) -> f64 {
    let all = mesh.triangles.iter().zip(&mesh.labels).filter(|(_, own)| **own == label);
    all.map(|(triangle, _)| {
        let vector = area_vector(places_m(mesh, *triangle));
        dot(vector, vector).sqrt() / 2.0
    })
    .sum()
}

/// Each edge, given by the places of its ends, occurs as often in one direction as in the other.
fn is_closed(mesh: &LabelledMesh) -> bool {
    let mut sums: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
    for triangle in &mesh.triangles {
        let places = places_m(mesh, *triangle).map(|place| place.map(f64::to_bits));
        for k in 0..3 {
            let (from, to) = (places[k], places[(k + 1) % 3]);
            let sign = if from < to { 1 } else { -1 };
            *sums.entry([from.min(to), from.max(to)]).or_default() += sign;
        }
    }
    sums.values().all(|sum| *sum == 0)
}

/// Normals of vertices have length one, and no triangle faces away from the normals of its corners.
fn looks_outwards(mesh: &LabelledMesh) -> bool {
    mesh.triangles.iter().all(|triangle| {
        let around = area_vector(places_m(mesh, *triangle));
        triangle.iter().all(|corner| {
            let normal = mesh.vertices[*corner as usize].normal.map(f64::from);
            (dot(normal, normal) - 1.0).abs() < 1e-5 && dot(normal, around) > 0.0
        })
    })
}

#[test]
fn a_straight_bridge_is_a_box() {
    let mesh = slab(&[[0, 0], [30, 40]], &[110.0, 110.0], 8.0, 1.0);
    assert_eq!(mesh.triangles.len(), 12);
    assert_eq!(mesh.labels.iter().filter(|label| **label == LABELS.road).count(), 2);
    assert!(is_closed(&mesh) && looks_outwards(&mesh));
    assert!((area_m2(&mesh, LABELS.road) - 50.0 * 8.0).abs() < 1e-6);
    let others = area_m2(&mesh, LABELS.others);
    assert!((others - (50.0 * 8.0 + 2.0 * 50.0 + 2.0 * 8.0)).abs() < 1e-6, "{others}");
    assert!((volume_m3(&mesh) - 50.0 * 8.0).abs() < 1e-6, "{}", volume_m3(&mesh));
    assert!(mesh.vertices.iter().all(|vertex| vertex.on_slab));
}

/// Where another slab continues a bridge, no grey is visible between both.
#[test]
fn the_end_towards_another_slab_has_the_colour_of_the_road() {
    let steps = STEPS_PER_M as i64;
    let center = CenterLine {
        points: vec![LatticePoint::new(0, 0), LatticePoint::new(50 * steps, 0)],
        beyond: [None, Some(LatticePoint::new(60 * steps, 0))],
        is_met: [false; 2],
        half_width: 4.0 * STEPS_PER_M,
    };
    let mut mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    let slab =
        Slab { center: &center, deck_m: &[9.0; 2], thickness_m: 1.5, steps_per_m: STEPS_PER_M };
    slab.add_to(&mut mesh, LABELS);
    assert!((area_m2(&mesh, LABELS.road) - (50.0 * 8.0 + 8.0 * 1.5)).abs() < 1e-6);
    assert!(is_closed(&mesh));
}

/// A ramp of 3 in 4: longer on top, but with the volume of a level one, because its sides are
/// vertical.
#[test]
fn a_ramp_is_a_sheared_box() {
    let mesh = slab(&[[0, 0], [40, 0]], &[110.0, 140.0], 10.0, 1.5);
    assert!(is_closed(&mesh) && looks_outwards(&mesh));
    assert!((area_m2(&mesh, LABELS.road) - 50.0 * 10.0).abs() < 1e-6);
    assert!((volume_m3(&mesh) - 40.0 * 10.0 * 1.5).abs() < 1e-6);
}

/// At a right angle the tip outside is as large as the overlap of both arms inside.
#[test]
fn a_mitred_bridge_keeps_its_area() {
    let mesh = slab(&[[0, 0], [100, 0], [100, 100]], &[110.0; 3], 10.0, 1.0);
    assert_eq!(mesh.triangles.len(), 2 * 8 + 4);
    assert!(is_closed(&mesh) && looks_outwards(&mesh));
    assert!((area_m2(&mesh, LABELS.road) - 200.0 * 10.0).abs() < 1e-6);
    assert!((volume_m3(&mesh) - 200.0 * 10.0).abs() < 1e-6);
}

/// A turn of 143° is bevelled outside and ends at one corner inside; no triangle is flipped.
#[test]
fn a_sharp_turn_is_closed() {
    let mesh = slab(&[[0, 0], [100, 0], [20, 60]], &[110.0; 3], 8.0, 1.0);
    assert!(is_closed(&mesh) && looks_outwards(&mesh));
    let furthest = mesh.vertices.iter().map(|vertex| vertex.at[0]).fold(0.0, f64::max);
    assert!(furthest <= 104.0 * STEPS_PER_M, "{furthest}");
}

/// A way that turns back on itself, a step of a millimetre, and a road without width.
#[test]
fn degenerate_bridges_are_closed() {
    let back = slab(&[[0, 0], [100, 0], [0, 0]], &[110.0; 3], 8.0, 1.0);
    assert!(is_closed(&back) && !back.triangles.is_empty());
    assert!(is_closed(&slab(&[[0, 0], [10, 0]], &[110.0; 2], 0.0, 1.0)));
    let mut mesh = LabelledMesh::new(LatticePoint::new(0, 0));
    let points = [[0, 0], [1, 0], [1, 1], [-3000, 1]];
    let center = CenterLine {
        points: points.map(|[u, v]| LatticePoint::new(u, v)).to_vec(),
        beyond: [Some(LatticePoint::new(1, 0)), Some(LatticePoint::new(-3000, 1))],
        is_met: [true; 2],
        half_width: 4000.0,
    };
    let deck_m = &[1.0, 2.0, 3.0, 4.0];
    Slab { center: &center, deck_m, thickness_m: 0.5, steps_per_m: STEPS_PER_M }
        .add_to(&mut mesh, LABELS);
    assert!(is_closed(&mesh));
}

/// Edges that are too long are divided, and slabs stay closed.
#[test]
fn divided_slabs_are_closed() {
    let mut mesh = slab(&[[0, 0], [700, 0], [1400, 300]], &[110.0, 120.0, 90.0], 8.0, 1.5);
    let before = volume_m3(&mesh);
    mesh.split_long_edges(|[east, north]| east.hypot(north) > 500.0 * STEPS_PER_M);
    assert!(is_closed(&mesh) && looks_outwards(&mesh));
    assert!(mesh.triangles.len() > 20 && (volume_m3(&mesh) - before).abs() < 1e-6);
    assert!(mesh.vertices.iter().all(|vertex| vertex.on_slab));
}

proptest! {
    /// The slab of a bridge is closed, whatever its line.
    #[test]
    fn all_slabs_are_closed(
        places in prop::collection::vec((-60_i64..60, -60_i64..60, 0.0..9.0_f64), 2..9),
        width_m in 0.5..30.0_f64,
    ) {
        let mut places = places;
        places.dedup_by_key(|(x, y, _)| (*x, *y));
        prop_assume!(places.len() > 1);
        let points: Vec<[i64; 2]> = places.iter().map(|&(x, y, _)| [x, y]).collect();
        let deck_m: Vec<f64> = places.iter().map(|place| place.2).collect();
        let mesh = slab(&points, &deck_m, width_m, 1.0);
        prop_assert!(is_closed(&mesh));
        let is_finite = mesh.vertices.iter().all(|vertex| {
            vertex.height_m.is_finite() && vertex.normal.iter().all(|axis| axis.is_finite())
        });
        prop_assert!(is_finite);
    }
}
