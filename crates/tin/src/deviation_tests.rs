//! Deviations of a TIN agree with a computation node by node.

use proptest::prelude::*;

use super::*;
use crate::{TinSpec, height_quantum_m, triangulate};

fn spec(max_error_m: f64) -> TinSpec {
    TinSpec { max_error_m, quantum_m: height_quantum_m(max_error_m) }
}

/// Heights of the nodes of a bumpy raster with some gaps.
fn bumpy_m(column: i64, row: i64) -> f32 {
    if (column / 5 + row / 7) % 11 == 3 {
        return f32::NAN;
    }
    200.0 * (column as f32 * 0.21).sin() * (row as f32 * 0.17).cos()
        + ((column * 7 + row * 13) % 5) as f32
}

/// The result of `measure`, computed node by node with barycentric coordinates.
fn by_hand(
    tin: &Tin,
    quantum_m: f64,
    window: &HeightGrid,
    placement: WindowPlacement,
) -> Deviation {
    let mut deviation = Deviation::default();
    for row in 0..window.rows() {
        for column in 0..window.columns() {
            let Some(height_m) = window.height(column, row) else { continue };
            let at = [
                (column as i64 + placement.column) as f64 / placement.stride as f64,
                (row as i64 + placement.row) as f64 / placement.stride as f64,
            ];
            let mut covered = false;
            for triangle in tin.triangles() {
                let corners = triangle.map(|vertex| tin.vertices()[vertex as usize]);
                let [a, b, c] = corners.map(|v| [f64::from(v.column), f64::from(v.row)]);
                let weights = corniche_geom::barycentric(at, a, b, c);
                if weights.iter().all(|&weight| weight >= -1e-12) {
                    let tin_m: f64 =
                        weights.iter().zip(corners).map(|(w, v)| w * f64::from(v.height_q)).sum();
                    deviation.max_abs_m =
                        deviation.max_abs_m.max((f64::from(height_m) - tin_m * quantum_m).abs());
                    covered = true;
                }
            }
            *if covered { &mut deviation.covered_nodes } else { &mut deviation.uncovered_nodes } +=
                1;
        }
    }
    deviation
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Windows anywhere, of any stride, even across the tile's edge, give the same result as node
    /// by node.
    #[test]
    fn equals_node_by_node(stride in 1_i64..9, column in -20_i64..150, row in -20_i64..150) {
        let spec = spec(3.0);
        let heights = HeightGrid::from_fn(37, 37, |c, r| bumpy_m((c as i64 - 1) * stride, (r as i64 - 1) * stride));
        let tin = triangulate(&heights, spec).unwrap();
        let placement = WindowPlacement { column, row, stride };
        let window = HeightGrid::from_fn(23, 19, |c, r| bumpy_m(c as i64 + column, r as i64 + row));
        let buckets = TriangleBuckets::new(&tin, spec.quantum_m);
        let mut uncovered = 0;
        let mut largest_m = 0.0_f64;
        let found = measure(&buckets, &window, placement, |c, r, distance_m| {
            assert!(window.has_height(c, r));
            uncovered += u64::from(distance_m.is_none());
            largest_m = largest_m.max(distance_m.unwrap_or(0.0));
        });
        prop_assert_eq!(largest_m.to_bits(), found.max_abs_m.to_bits());
        let wanted = by_hand(&tin, spec.quantum_m, &window, placement);
        prop_assert_eq!(uncovered, found.uncovered_nodes);
        prop_assert_eq!([found.covered_nodes, found.uncovered_nodes], [wanted.covered_nodes, wanted.uncovered_nodes]);
        prop_assert!((found.max_abs_m - wanted.max_abs_m).abs() < 1e-9, "{found:?} {wanted:?}");
    }

    /// A tile's own nodes are within its tolerance, to the last bit; counts are those of the
    /// ground.
    #[test]
    fn finest_tiles_keep_their_tolerance(max_error_m in 0.25_f64..40.0) {
        let spec = spec(max_error_m);
        let heights = HeightGrid::from_fn(67, 67, |c, r| bumpy_m(c as i64, r as i64));
        let tin = triangulate(&heights, spec).unwrap();
        let placement = WindowPlacement { column: 0, row: 0, stride: 1 };
        let window = heights.window(1, 1, 65, 65);
        let found = measure(&TriangleBuckets::new(&tin, spec.quantum_m), &window, placement, |_, _, _| ());
        prop_assert!(found.max_abs_m <= max_error_m, "{found:?}");
        prop_assert_eq!(found.covered_nodes + found.uncovered_nodes, window.count_heights() as u64);
    }
}

#[test]
fn a_node_where_triangles_meet_counts_once() {
    let heights =
        HeightGrid::from_fn(35, 35, |c, r| bumpy_m(c as i64, r as i64 * 2).abs().max(0.0));
    let heights = HeightGrid::from_fn(35, 35, |c, r| heights.height(c, r).unwrap_or(7.0));
    let tin = triangulate(&heights, spec(1.0)).unwrap();
    let buckets = TriangleBuckets::new(&tin, spec(1.0).quantum_m);
    let placement = WindowPlacement { column: 0, row: 0, stride: 1 };
    let found = measure(&buckets, &heights.window(1, 1, 33, 33), placement, |c, r, distance_m| {
        assert!(distance_m.is_some(), "{c} {r} not covered");
    });
    assert_eq!((found.covered_nodes, found.uncovered_nodes), (33 * 33, 0));
}

#[test]
fn an_empty_tin_covers_nothing() {
    let buckets = TriangleBuckets::new(&Tin::default(), 0.5);
    let window = HeightGrid::from_fn(3, 2, |c, _| if c == 0 { f32::NAN } else { 1.0 });
    let mut seen = Vec::new();
    let found =
        measure(&buckets, &window, WindowPlacement { column: 5, row: 5, stride: 4 }, |c, r, _| {
            seen.push((c, r));
        });
    assert_eq!(found, Deviation { max_abs_m: 0.0, covered_nodes: 0, uncovered_nodes: 4 });
    assert_eq!(seen, [(1, 0), (2, 0), (1, 1), (2, 1)]);
}

#[test]
fn merging_takes_the_worst_and_adds_the_counts() {
    let mut all = Deviation { max_abs_m: 1.0, covered_nodes: 2, uncovered_nodes: 3 };
    all.merge(Deviation { max_abs_m: 4.0, covered_nodes: 5, uncovered_nodes: 6 });
    assert_eq!(all, Deviation { max_abs_m: 4.0, covered_nodes: 7, uncovered_nodes: 9 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Heights of a TIN at any window's nodes have the measured distances from other heights, and
    /// are missing without a triangle.
    #[test]
    fn heights_are_those_that_are_measured(
        stride in 1_i64..9,
        column in -20_i64..150,
        row in -20_i64..150,
    ) {
        let spec = spec(3.0);
        let raster = HeightGrid::from_fn(35, 35, |column, row| bumpy_m(column as i64, row as i64));
        let tin = triangulate(&raster, spec).unwrap();
        let buckets = TriangleBuckets::new(&tin, spec.quantum_m);
        let placement = WindowPlacement { column, row, stride };
        let size = [23, 17];
        let heights_m = heights_m(&buckets, size, placement);
        let level = HeightGrid::from_fn(size[0], size[1], |_, _| 0.0);
        let mut seen = 0;
        measure(&buckets, &level, placement, |column, row, distance_m| {
            let height_m = heights_m[row * size[0] + column];
            let is_same = match distance_m {
                Some(distance_m) => (height_m.abs() - distance_m).abs() < 1e-9,
                None => height_m.is_nan(),
            };
            assert!(is_same, "{height_m} {distance_m:?}");
            seen += 1;
        });
        prop_assert_eq!(seen, size[0] * size[1]);
    }
}
