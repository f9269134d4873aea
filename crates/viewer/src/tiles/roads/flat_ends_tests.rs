//! Where two roads continue each other, the more important one ends flat; all other ends are round.

use super::*;

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 100.0, max_y: 100.0 };

/// Returns a complete line by class, look and points.
fn line((class, look, points_m): &(u8, RoadLook, Vec<[f64; 2]>)) -> LineEnds {
    let end = |a: Option<&[f64; 2]>, b: Option<&[f64; 2]>| Some([*a?, *b?]);
    let first = end(points_m.get(1), points_m.first());
    let last = end(points_m.iter().rev().nth(1), points_m.last());
    let class = FunctionalRoadClass::new(*class).unwrap();
    LineEnds::of_road(RoadKind { look: *look, ..RoadKind::plain(class) }, [first, last])
}

fn check(lines: &[(u8, RoadLook, Vec<[f64; 2]>)], expected: &[[bool; 2]]) {
    let ends: Vec<LineEnds> = lines.iter().map(line).collect();
    assert_eq!(flat_ends(&ends, TILE), expected);
}

const PLAIN: RoadLook = RoadLook::Plain;

#[test]
fn the_more_important_of_two_roads_in_line_ends_flat() {
    let [a, b, c] = [[10.0, 50.0], [50.0, 50.0], [90.0, 60.0]];
    let neither = [false; 2];
    check(&[(2, PLAIN, vec![a, b]), (3, PLAIN, vec![b, c])], &[[false, true], neither]);
    check(&[(3, PLAIN, vec![c, b]), (2, PLAIN, vec![b, a])], &[neither, [true, false]]);
    check(&[(2, PLAIN, vec![a, b]), (2, PLAIN, vec![b, c])], &[neither, neither]);
    for lower in [RoadLook::Link, RoadLook::Service, RoadLook::Tunnel] {
        check(&[(2, PLAIN, vec![a, b]), (2, lower, vec![b, c])], &[[false, true], neither]);
    }
    check(&[(6, PLAIN, vec![a, b]), (0, RoadLook::Tunnel, vec![b, c])], &[[false, true], neither]);
}

#[test]
fn ends_stay_round_where_the_road_turns_forks_or_leaves_the_tile() {
    let [a, b] = [[10.0, 50.0], [50.0, 50.0]];
    let neither = [false; 2];
    check(&[(2, PLAIN, vec![a, b]), (3, PLAIN, vec![b, [60.0, 90.0]])], &[neither, neither]);
    let fork = [
        (2, PLAIN, vec![a, b]),
        (3, PLAIN, vec![b, [90.0, 50.0]]),
        (2, PLAIN, vec![b, [60.0, 90.0]]),
    ];
    check(&fork, &[neither, neither, neither]);
    let border = [100.0, 50.0];
    check(&[(2, PLAIN, vec![a, border]), (3, PLAIN, vec![border, [150.0, 50.0]])], &[neither; 2]);
    check(&[(2, PLAIN, vec![a, b]), (3, PLAIN, vec![b, b])], &[neither, neither]);
}

/// Each of a hundred thousand ends at one point is compared only with the most important one.
#[test]
fn many_ends_at_one_point_take_no_longer_than_elsewhere() {
    let middle = [50.0, 50.0];
    let mut lines = vec![(2, PLAIN, vec![[10.0, 50.0], middle])];
    lines.extend((0..100_000).map(|k| (3, PLAIN, vec![middle, [90.0, 45.0 + f64::from(k) / 1e4]])));
    let ends: Vec<LineEnds> = lines.iter().map(line).collect();
    let flat = flat_ends(&ends, TILE);
    assert_eq!(flat[0], [false, true]);
    assert!(flat[1..].iter().all(|flat| *flat == [false; 2]));
}
