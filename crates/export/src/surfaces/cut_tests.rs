//! Roads cut into the ground have their area, and the ground keeps its own.

use std::collections::HashMap;

use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_tin::{Placement, Surface, Tin, TinVertex};
use proptest::prelude::*;

use super::{
    super::ribbon::{CenterLine, Ribbon},
    UncutGround, cut,
};
use crate::surfaces::ground::LabelledMesh;

/// Cells along each side of the ground.
const CELLS: u16 = 4;
const CELL_STEPS: i64 = 64_000;
const SIDE: i64 = CELLS as i64 * CELL_STEPS;

/// A raster of hills as triangles; with a hole in the middle if requested.
fn surface(is_holed: bool) -> Surface {
    let side = CELLS + 1;
    let vertices = (0..side * side)
        .map(|k| {
            let (column, row) = (k % side, k / side);
            TinVertex { column, row, height_q: i32::from((column * 7 + row * 13) % 11) * 40 }
        })
        .collect();
    let mut triangles = Vec::new();
    for row in 0..CELLS {
        for column in 0..CELLS {
            if is_holed && (row, column) == (1, 1) {
                continue;
            }
            let north_west = u32::from(row * side + column);
            let south_west = north_west + u32::from(side);
            triangles.push([north_west, south_west, south_west + 1]);
            triangles.push([north_west, south_west + 1, north_west + 1]);
        }
    }
    let tin = Tin::new(vertices, &triangles).unwrap();
    Surface::new(
        &tin,
        Placement {
            corner: LatticePoint::new(0, SIDE),
            node_steps: [CELL_STEPS; 2],
            quantum_m: 0.25,
        },
    )
}

fn cut_along(surface: &Surface, lines: &[(Vec<LatticePoint>, f64)]) -> LabelledMesh {
    let normals = vec![[0, 0]; surface.points().len()];
    let tile = LatticeBounds { min: LatticePoint::new(0, 0), max: LatticePoint::new(SIDE, SIDE) };
    let ribbons: Vec<Ribbon> = lines
        .iter()
        .map(|(points, half_width)| {
            Ribbon::around(&CenterLine {
                points: points.clone(),
                beyond: [None; 2],
                is_met: [true, false],
                half_width: *half_width,
            })
        })
        .collect();
    cut(&UncutGround { surface, normals: &normals, tile }, &ribbons).unwrap()
}

/// The area of triangles with a label, square steps.
fn area(mesh: &LabelledMesh, label: Option<u32>) -> f64 {
    let of = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|k| mesh.vertices[k as usize].at);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
    };
    let all = mesh.triangles.iter().zip(&mesh.labels);
    all.filter(|(_, own)| label.is_none_or(|label| label == **own)).map(|(k, _)| of(k)).sum()
}

/// Edges that only one triangle has.
fn open_edges(mesh: &LabelledMesh) -> Vec<[u32; 2]> {
    let mut counts: HashMap<[u32; 2], i32> = HashMap::new();
    for corners in &mesh.triangles {
        for k in 0..3 {
            let (one, other) = (corners[k], corners[(k + 1) % 3]);
            *counts.entry([one.min(other), one.max(other)]).or_default() +=
                if one < other { 1 } else { -1 };
        }
    }
    counts.into_iter().filter(|(_, sum)| *sum != 0).map(|(edge, _)| edge).collect()
}

/// Checks that the ground is the same: every vertex at its height, no area lost, open only where
/// the ground ends.
fn check(mesh: &LabelledMesh, surface: &Surface, cells: i64) {
    let whole = (cells * CELL_STEPS * CELL_STEPS) as f64;
    assert!((area(mesh, None) - whole).abs() < whole * 1e-12, "{}", area(mesh, None) / whole);
    for vertex in &mesh.vertices {
        let [u, v] = mesh.on_lattice(vertex);
        let near = LatticePoint::new(u.round() as i64, v.round() as i64);
        let triangle = surface.locate(near).unwrap();
        let height_m = surface.height_in_triangle_m(triangle, [u, v]);
        assert!((height_m - vertex.height_m).abs() < 0.001, "{height_m} {}", vertex.height_m);
    }
    let length: f64 = open_edges(mesh)
        .into_iter()
        .map(|ends| {
            let [a, b] = ends.map(|k| mesh.vertices[k as usize].at);
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
        .sum();
    let holes = i64::from(CELLS) * i64::from(CELLS) - cells;
    let expected = (4 * SIDE + 4 * holes * CELL_STEPS) as f64;
    assert!((length - expected).abs() < 1.0, "{length} {expected}");
}

#[test]
fn without_roads_nothing_changes() {
    let surface = surface(false);
    let mesh = cut_along(&surface, &[]);
    check(&mesh, &surface, 16);
    assert_eq!(mesh.triangles.len(), surface.triangles().len());
    assert!(mesh.labels.iter().all(|label| *label == 0));
}

/// The area of a straight road is its length times its width; where roads cross, the first is
/// visible.
#[test]
fn roads_have_their_area() {
    let surface = surface(false);
    let along = |v: i64| vec![LatticePoint::new(-9000, v), LatticePoint::new(SIDE + 9000, v)];
    let down = vec![LatticePoint::new(70_001, SIDE + 9000), LatticePoint::new(70_001, -9000)];
    let mesh = cut_along(&surface, &[(along(100_003), 3500.0), (down, 2000.0)]);
    check(&mesh, &surface, 16);
    let side = SIDE as f64;
    assert!((area(&mesh, Some(1)) - 7000.0 * side).abs() < 1.0);
    assert!((area(&mesh, Some(2)) - 4000.0 * (side - 7000.0)).abs() < 1.0);
}

/// A road may end in a hole, run along an edge of the ground or of the tile, and cover whole
/// triangles.
#[test]
fn odd_places_are_cut() {
    for is_holed in [false, true] {
        let surface = surface(is_holed);
        let cells = if is_holed { 15 } else { 16 };
        let at = |u: i64, v: i64| LatticePoint::new(u, v);
        let lines = [
            (vec![at(0, 0), at(SIDE, SIDE)], 4000.0),
            (vec![at(CELL_STEPS, 0), at(CELL_STEPS, SIDE)], 4000.0),
            (vec![at(0, 4000), at(SIDE, 4000)], 4000.0),
            (vec![at(96_000, 160_000), at(3000, 250_000)], 5000.0),
            (vec![at(0, SIDE), at(SIDE, SIDE)], 90_000.0),
            (vec![at(9, 9), at(9, 50_009), at(50_009, 50_009), at(9, 9)], 77.0),
        ];
        for count in 1..=lines.len() {
            check(&cut_along(&surface, &lines[..count]), &surface, cells);
        }
    }
}

fn any_line() -> impl Strategy<Value = (Vec<LatticePoint>, f64)> {
    let any_point = || {
        // Nodes and places next to them are the difficult cases.
        let axis = || {
            prop_oneof![
                -20_000..SIDE + 20_000,
                (0..=4_i64, -1..=1_i64).prop_map(|(k, off)| k * CELL_STEPS + off),
            ]
        };
        (axis(), axis()).prop_map(|(u, v)| LatticePoint::new(u, v))
    };
    (prop::collection::vec(any_point(), 2..7), 1.0..40_000.0_f64).prop_filter_map(
        "a line of one point",
        |(mut points, width)| {
            points.dedup();
            (points.len() > 1).then_some((points, width))
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// The ground stays complete, whatever roads there are.
    #[test]
    fn the_ground_stays_whole(lines in prop::collection::vec(any_line(), 1..6), is_holed in any::<bool>()) {
        let surface = surface(is_holed);
        check(&cut_along(&surface, &lines), &surface, if is_holed { 15 } else { 16 });
    }
}
