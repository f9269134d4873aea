//! Samples are in the middles of equal parts of a line.

use super::*;

#[test]
fn samples_lie_in_the_middles_of_equal_parts() {
    let found = samples(&[[0.0, 0.0], [6.0, 0.0], [6.0, 6.0]]);
    let places: Vec<[f64; 2]> = found.iter().map(|sample| sample.at).collect();
    assert_eq!(places, [[2.0, 0.0], [6.0, 0.0], [6.0, 4.0]]);
    // A road to the east has north on its left.
    let normals = [found[0], found[2]].map(|sample| sample.normal.map(|part| part as i32));
    assert_eq!(normals, [[0, 1], [-1, 0]]);
}

#[test]
fn lines_without_length_have_none() {
    assert!(samples(&[]).is_empty());
    assert!(samples(&[[1.0, 1.0], [1.0, 1.0]]).is_empty());
    assert_eq!(samples(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]]).len(), 1);
}
