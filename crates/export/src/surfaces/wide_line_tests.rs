//! Points that obstruct wide lines are removed, and no others.

use corniche_geom::LatticePoint;

use super::wide_points;

fn kept(points: &[(i64, i64)], half_width: f64) -> Vec<usize> {
    let points: Vec<LatticePoint> = points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
    wide_points(&points, half_width)
}

#[test]
fn turns_with_room_stay() {
    assert_eq!(kept(&[(0, 0), (1000, 0), (1000, 1000), (3000, 1000)], 400.0), [0, 1, 2, 3]);
    assert_eq!(kept(&[(0, 0), (1000, 0)], 5000.0), [0, 1]);
    assert_eq!(kept(&[(0, 0), (10, 0), (1000, 0)], 400.0), [0, 1, 2], "straight");
}

/// Two points 30 apart, with a turn of 20° at each: their backs are 70.
#[test]
fn of_two_turns_in_one_place_one_stays() {
    let found = kept(&[(0, 0), (1000, 0), (1028, 10), (1900, 700)], 400.0);
    assert_eq!(found.len(), 3, "{found:?}");
    assert_eq!([found[0], found[2]], [0, 3]);
}

/// Backs of 28 and 36 do not fit on a segment of 49; on a segment of 141 they do.
#[test]
fn both_ends_of_a_segment_need_room() {
    let turned =
        |length: i64| kept(&[(0, 0), (1000, 0), (1000 + length, length / 7), (1900, 290)], 400.0);
    assert_eq!(turned(49).len(), 3);
    assert_eq!(turned(140).len(), 4);
}

/// A hairpin cannot be removed, nor a corner that the line would be far from.
#[test]
fn corners_far_from_the_rest_stay() {
    assert_eq!(kept(&[(0, 0), (1000, 0), (0, 10)], 400.0), [0, 1, 2]);
    assert_eq!(kept(&[(0, 0), (300, 0), (300, 300)], 400.0), [0, 1, 2]);
    assert_eq!(kept(&[(0, 0), (1000, 0), (0, 0)], 400.0), [0, 1, 2], "there and back");
}
