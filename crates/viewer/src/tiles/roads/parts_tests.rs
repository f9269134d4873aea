//! Parts of the road network are found by class, and no crossing is missed.

use corniche_roads::FunctionalRoadClass;

use super::*;

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1000.0, max_y: 1000.0 };
const KNOWN: KnownNet = KnownNet { tile: TILE, margin_m: 100.0, near_m: 4.0 };

/// Returns the lengths of the parts of lines by class and points; `None` if a part is open.
fn lengths(lines: &[(u8, &[[f64; 2]])]) -> Vec<Option<f32>> {
    let lines: Vec<NetLine> = lines
        .iter()
        .map(|(class, points)| NetLine {
            kind: RoadKind::plain(FunctionalRoadClass::new(*class).unwrap()),
            vertices_m: points.to_vec(),
        })
        .collect();
    let lengths_m = part_lengths_m(&lines, KNOWN);
    lengths_m.into_iter().map(|length_m| (length_m < OPEN_M).then_some(length_m)).collect()
}

#[test]
fn only_lines_of_the_class_and_above_count() {
    let a = &[[100.0, 500.0], [200.0, 500.0]];
    let b = &[[200.0, 500.0], [500.0, 500.0]];
    let c = &[[500.0, 500.0], [1000.0, 500.0]];
    assert_eq!(lengths(&[(5, a)]), [Some(100.0)]);
    assert_eq!(lengths(&[(5, a), (5, b)]), [Some(400.0); 2]);
    assert_eq!(lengths(&[(5, a), (6, b)]), [Some(100.0), Some(400.0)]);
    assert_eq!(lengths(&[(6, b), (5, a), (7, c)]), [Some(400.0), Some(100.0), None]);
    assert_eq!(lengths(&[(5, c), (7, a), (6, b)]), [None; 3]);
}

#[test]
fn lines_that_cross_or_nearly_meet_belong_together() {
    let across: &[_] = &[[300.0, 300.0], [300.0, 700.0]];
    let along: &[_] = &[[100.0, 501.0], [503.0, 504.0]];
    let sum = Some(400.0 + 403.0_f32.hypot(3.0));
    assert_eq!(lengths(&[(2, across), (2, along)]), [sum; 2]);
    // The end of a simplified line is next to the other line.
    let end: &[_] = &[[303.0, 400.0], [400.0, 400.0]];
    assert_eq!(lengths(&[(2, across), (2, end)]), [Some(497.0); 2]);
    let apart: &[_] = &[[309.0, 400.0], [400.0, 400.0]];
    assert_eq!(lengths(&[(2, across), (2, apart)]), [Some(400.0), Some(91.0)]);
}

/// Crossing lines at many angles and positions are found to cross.
#[test]
fn no_crossing_is_missed() {
    for k in 0..500 {
        let (angle, turn) = (f64::from(k) * 0.37, 0.02 + f64::from(k % 60) * 0.05);
        let middle = [500.0 + f64::from(k % 17) * 0.31, 500.0 - f64::from(k % 23) * 0.47];
        let line = |angle: f64, share: f64| {
            let (dy, dx) = angle.sin_cos();
            let from = [middle[0] - 90.0 * share * dx, middle[1] - 90.0 * share * dy];
            vec![from, [from[0] + 90.0 * dx, from[1] + 90.0 * dy]]
        };
        let lines = [line(angle, 0.3), line(angle + turn, 0.8)];
        let lengths = lengths(&[(1, &lines[0]), (1, &lines[1])]);
        assert!(lengths.iter().all(|length| length.is_some_and(|m| (m - 180.0).abs() < 0.01)));
    }
}

#[test]
fn parts_that_meet_the_border_are_open() {
    for border in [
        [[100.0, 100.0], [100.0, 0.0]],
        [[900.0, 100.0], [1000.0, 100.0]],
        [[-50.0, 100.0], [50.0, 100.0]],
        [[-50.0, 50.0], [50.0, -50.0]],
        [[-90.0, 500.0], [-99.0, 500.0]],
        [[-20.0, 500.0], [-120.0, 500.0]],
    ] {
        assert_eq!(lengths(&[(3, &border)]), [None], "{border:?}");
    }
    // Everything is known between the tile and the end of its margin.
    assert_eq!(lengths(&[(3, &[[-20.0, 500.0], [-80.0, 500.0]])]), [Some(60.0)]);
    assert_eq!(lengths(&[(3, &[[1020.0, 500.0], [1020.0, 1050.0]])]), [Some(550.0)]);
}

#[test]
fn service_roads_come_after_the_rest_of_their_class() {
    let class = FunctionalRoadClass::new(6).unwrap();
    let line = |look, from: f64, to: f64| NetLine {
        kind: RoadKind { look, ..RoadKind::plain(class) },
        vertices_m: vec![[from, 500.0], [to, 500.0]],
    };
    let lines = [line(RoadLook::Service, 100.0, 200.0), line(RoadLook::Plain, 200.0, 250.0)];
    assert_eq!(part_lengths_m(&lines, KNOWN), [150.0, 50.0]);
}

/// A line may run all around the earth and much farther: only its part near the tile is visited,
/// and connects to the lines there.
#[test]
fn a_line_from_beyond_the_stars_is_walked_near_the_tile_alone() {
    let far: &[_] = &[[-1e15, 500.0], [1e15, 500.0]];
    let mut squares = 0;
    KNOWN.squares(far, |_| {
        squares += 1;
        true
    });
    let across = (1000.0 + 2.0 * (100.0 + 3.0 * 4.0)) / 4.0;
    assert!((0.0..6.0).contains(&(f64::from(squares) - across)), "{squares} squares");
    let meets: &[_] = &[[300.0, 400.0], [300.0, 501.0]];
    let apart: &[_] = &[[700.0, 400.0], [700.0, 450.0]];
    assert_eq!(lengths(&[(2, far), (2, meets), (2, apart)]), [None, None, Some(50.0)]);
}

/// Lines that pass through more squares than all roads of a city count as open, and are not visited
/// to their ends.
#[test]
fn too_many_lines_are_not_walked() {
    let back: Vec<[f64; 2]> =
        (0..20_000).map(|k| [f64::from(k % 2) * 1000.0, f64::from(k) / 20.0]).collect();
    assert_eq!(lengths(&[(2, &[[100.0, 100.0], [150.0, 100.0]]), (3, &back)]), [None, None]);
}
