//! Overlapping parts of a way give the way again, each segment once.

use super::*;

fn points(places: &[[i64; 2]]) -> Vec<LatticePoint> {
    places.iter().map(|&[u, v]| LatticePoint::new(u, v)).collect()
}

fn whole(parts: &[Vec<LatticePoint>]) -> Vec<Vec<LatticePoint>> {
    whole_lines(&parts.iter().map(Vec::as_slice))
}

/// All cuts of a line into overlapping windows, in any order, give the line.
#[test]
fn windows_of_a_line_become_the_line() {
    let straight = points(&[[0, 0], [1, 0], [2, 1], [3, 1], [4, 2], [5, 5]]);
    // It meets itself in [2, 0], like an 8; the way goes straight on there.
    let eight = points(&[[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [2, 0], [2, -2], [0, -2]]);
    let ring = points(&[[0, 0], [3, 0], [3, 3], [0, 3], [0, 0]]);
    for line in [straight, eight, ring] {
        for length in 3..=line.len() {
            let mut windows: Vec<_> = line.windows(length).map(<[_]>::to_vec).collect();
            assert_eq!(whole(&windows), std::slice::from_ref(&line), "{length}");
            windows.reverse();
            assert_eq!(whole(&windows), std::slice::from_ref(&line), "{length}");
        }
    }
}

/// Parts without a common segment are joined where one begins at the other one's end, and stay
/// apart where there is a gap.
#[test]
fn ends_that_meet_are_joined_and_gaps_stay() {
    let [a, b, c] =
        [[[0, 0], [1, 0]], [[1, 0], [2, 0]], [[2, 0], [3, 0]]].map(|ends| points(&ends));
    let line = points(&[[0, 0], [1, 0], [2, 0], [3, 0]]);
    assert_eq!(whole(&[a.clone(), c.clone(), b.clone()]), std::slice::from_ref(&line));
    assert_eq!(whole(&[c.clone(), b, a.clone()]), [line]);
    assert_eq!(whole(&[a.clone(), c.clone()]), [a, c]);
}

/// The segments there and back are different; the same segment twice is one.
#[test]
fn back_is_another_direction_and_twice_is_once() {
    let there = points(&[[0, 0], [1, 0], [0, 0]]);
    assert_eq!(whole(std::slice::from_ref(&there)), [there]);
    let twice = points(&[[0, 0], [1, 0], [1, 1], [0, 0], [1, 0], [2, 2]]);
    let segments: usize = whole(&[twice]).iter().map(|line| line.len() - 1).sum();
    assert_eq!(segments, 4);
}
