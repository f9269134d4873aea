//! Barycentric coordinates of corners, the centroid and points outside match their definition.

use super::*;

const A: [f64; 2] = [0.0, 0.0];
const B: [f64; 2] = [4.0, 0.0];
const C: [f64; 2] = [0.0, 2.0];

#[test]
fn corners_are_unit_weights() {
    assert_eq!(barycentric(A, A, B, C), [1.0, 0.0, 0.0]);
    assert_eq!(barycentric(B, A, B, C), [0.0, 1.0, 0.0]);
    assert_eq!(barycentric(C, A, B, C), [0.0, 0.0, 1.0]);
}

#[test]
fn centroid_has_equal_weights() {
    let weights = barycentric([4.0 / 3.0, 2.0 / 3.0], A, B, C);
    for weight in weights {
        assert!((weight - 1.0 / 3.0).abs() < 1e-15);
    }
}

#[test]
fn beyond_an_edge_its_weight_is_negative() {
    assert!(barycentric([1.0, -1.0], A, B, C)[2] < 0.0);
}
