//! Dashes continue at bends and tile borders, identically in both methods.

use super::*;

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 100.0, max_y: 100.0 };

fn starts_m(vertices_m: &[[f64; 2]]) -> Vec<f32> {
    dash_starts(vertices_m, TILE).iter().map(|place| place.0[0]).collect()
}

fn check(vertices_m: &[[f64; 2]], expected_m: &[f64]) {
    let found: Vec<f32> = starts_m(vertices_m);
    assert_eq!(found.len(), expected_m.len());
    for (found, expected) in found.iter().zip(expected_m) {
        let off = (f64::from(*found) - expected).rem_euclid(WRAP_M);
        assert!(off.min(WRAP_M - off) < 1e-2, "{found} for {expected} of {vertices_m:?}");
    }
}

#[test]
fn dashes_go_on_at_bends() {
    check(&[[10.0, 10.0], [40.0, 50.0], [40.0, 60.0], [30.0, 60.0]], &[0.0, 50.0, 60.0]);
}

/// A line that is cut at the border, as in GEO with the whole first segment, and a line that is cut
/// at a margin, as in SV.
#[test]
fn both_methods_count_from_the_first_vertex_inside() {
    let inside = [[20.0, 50.0], [20.0, 80.0], [60.0, 80.0]];
    let with = |before: &[[f64; 2]]| [before, inside.as_slice()].concat();
    check(&with(&[[-40.0, 50.0]]), &[-60.0, 0.0, 30.0]);
    check(&with(&[[-10.0, 50.0]]), &[-30.0, 0.0, 30.0]);
    check(&with(&[[-10.0, 10.0], [-10.0, 50.0]])[1..], &[-30.0, 0.0, 30.0]);
    let longer = starts_m(&with(&[[-10.0, 10.0], [-10.0, 50.0]]));
    assert!((f64::from(longer[1]) - (WRAP_M - 30.0)).abs() < 1e-2);
}

#[test]
fn a_line_that_comes_back_is_counted_anew() {
    check(
        &[[50.0, 50.0], [50.0, -20.0], [80.0, -20.0], [80.0, 10.0], [80.0, 40.0]],
        &[0.0, 50.0, -30.0, 0.0],
    );
}

/// A straight line without a vertex inside has its dashes at the same positions wherever it is cut.
#[test]
fn a_segment_alone_is_counted_from_a_fixed_place() {
    let [start, cut, end] =
        [[530_003.0, 5_210_004.0], [530_006.0, 5_210_008.0], [530_012.0, 5_210_016.0]];
    let [whole, first, second] = [[start, end], [start, cut], [cut, end]].map(dash_of_segment_m);
    assert!((first - whole).abs() < 1e-2);
    assert!((second - first - 5.0).abs() < 2e-2, "{first} {second}");
    assert!((0.0..WRAP_M).contains(&dash_of_segment_m([[-5.0, 0.0], [-4.0, 0.0]])));
    assert!(dash_of_segment_m([start, start]).abs() < 1e-9);
    check(&[start, end], &[whole]);
}
