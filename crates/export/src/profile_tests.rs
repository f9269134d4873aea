//! Ways of a profile are turned to continue each other, and grades are measured over twenty metres.

use super::*;

fn line(points: &[[f64; 2]]) -> JoinedLine {
    let vertices = points.iter().map(|&at| Vertex { at, z_m: 0.0, is_source: true }).collect();
    JoinedLine { vertices, joins: Vec::new() }
}

fn places(parts: &[ProfileLine]) -> Vec<Vec<f64>> {
    parts.iter().map(|part| part.iter().map(|(_, vertex)| vertex.at[0]).collect()).collect()
}

#[test]
fn ways_are_turned_so_that_they_go_on() {
    let at = |x: f64| [x, 0.0];
    let first = vec![line(&[at(3.0), at(2.0), at(1.0)])];
    let second = vec![line(&[at(3.0), at(4.0)])];
    let third = vec![line(&[at(9.0), at(6.0), at(4.0)])];
    let (legs, parts) = in_a_row(&[11, 12, 13], vec![first.clone(), second, third]);
    assert_eq!(places(&parts), [[1.0, 2.0, 3.0, 4.0, 6.0, 9.0]]);
    let numbers: Vec<usize> = parts[0].iter().map(|(leg, _)| *leg).collect();
    assert_eq!(numbers, [0, 0, 0, 1, 2, 2]);
    let legs: Vec<_> = legs.iter().map(|leg| (leg.way_id, leg.is_turned)).collect();
    assert_eq!(legs, [(11, true), (12, false), (13, true)]);
    // A single way keeps its direction; ways that do not meet are separate parts.
    assert_eq!(places(&in_a_row(&[1], vec![first.clone()]).1), [[3.0, 2.0, 1.0]]);
    let (_, apart) = in_a_row(&[1, 2], vec![first.clone(), vec![line(&[at(7.0), at(8.0)])]]);
    assert_eq!(places(&apart), [vec![3.0, 2.0, 1.0], vec![7.0, 8.0]]);
    // There and back: two legs of one way.
    let (legs, back) = in_a_row(&[1, 1], vec![first.clone(), first]);
    assert_eq!(places(&back), [[3.0, 2.0, 1.0, 2.0, 3.0]]);
    assert_eq!(back[0].iter().map(|(leg, _)| *leg).collect::<Vec<_>>(), [0, 0, 0, 1, 1]);
    assert_eq!([legs[0].is_turned, legs[1].is_turned], [false, true]);
    // A way with a gap is turned as a whole.
    let gap = vec![line(&[at(5.0), at(4.0)]), line(&[at(2.0), at(1.0)])];
    let (_, parts) = in_a_row(&[1, 2], vec![vec![line(&[at(0.0), at(1.0)])], gap]);
    assert_eq!(places(&parts), [vec![0.0, 1.0, 2.0], vec![4.0, 5.0]]);
}

#[test]
fn grades_are_those_of_twenty_metres() {
    // Level, then one in ten, then level again.
    let profile = [[0.0, 5.0], [100.0, 5.0], [150.0, 10.0], [250.0, 10.0]];
    let found = grades(&profile);
    for (found, expected) in found.iter().zip([0.0, 0.05, 0.05, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    // At an end, the twenty metres are inside the line.
    let ends = grades(&[[0.0, 0.0], [10.0, 4.0], [20.0, 4.0], [40.0, 4.0]]);
    assert!((ends[0] - 0.2).abs() < 1e-12, "{ends:?}");
    // A short line has one grade.
    for grade in grades(&[[0.0, 0.0], [4.0, 1.0]]) {
        assert!((grade - 0.25).abs() < 1e-12, "{grade}");
    }
    assert_eq!(grades(&[[0.0, 0.0], [0.0, 0.0]]).len(), 2);
}
