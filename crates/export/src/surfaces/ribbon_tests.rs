//! The outline of a road has its width, also at turns, short segments and borders.

use corniche_geom::LatticePoint;

use super::{CenterLine, Ribbon};

fn point(u: i64, v: i64) -> LatticePoint {
    LatticePoint::new(u, v)
}

fn line(points: &[(i64, i64)], half_width: f64) -> CenterLine {
    CenterLine {
        points: points.iter().map(|&(u, v)| point(u, v)).collect(),
        beyond: [None; 2],
        is_met: [false; 2],
        half_width,
    }
}

/// Twice the area of a polygon.
fn twice_area(part: &[LatticePoint]) -> i64 {
    let next = part.iter().cycle().skip(1);
    part.iter().zip(next).map(|(a, b)| a.u * b.v - a.v * b.u).sum::<i64>().abs()
}

#[test]
fn a_straight_road_is_a_rectangle() {
    let ribbon = Ribbon::around(&line(&[(0, 0), (1000, 0)], 50.0));
    assert_eq!(
        ribbon.parts,
        [vec![point(0, 50), point(1000, 50), point(1000, -50), point(0, -50)]]
    );
    let mut outline = ribbon.outline;
    for segment in &mut outline {
        segment.sort_unstable();
    }
    outline.sort_unstable();
    let expected = [
        [point(0, -50), point(0, 50)],
        [point(0, -50), point(1000, -50)],
        [point(0, 50), point(1000, 50)],
        [point(1000, -50), point(1000, 50)],
    ];
    assert_eq!(outline, expected);
}

/// At a right angle the sides meet on the diagonal: tip outside, crossing inside.
#[test]
fn sides_meet_at_a_turn() {
    let ribbon = Ribbon::around(&line(&[(0, 0), (1000, 0), (1000, 1000)], 50.0));
    assert_eq!(ribbon.parts.len(), 2);
    let corners: Vec<_> = ribbon.outline.as_flattened().to_vec();
    assert!(corners.contains(&point(950, 50)) && corners.contains(&point(1050, -50)));
    let area: i64 = ribbon.parts.iter().map(|part| twice_area(part)).sum();
    // Two arms and the square of the corner, without their common part.
    assert_eq!(area, 2 * (950 * 100 + 950 * 100 + 100 * 100));
}

/// A hairpin is bevelled: nothing extends farther than half the width from the line.
#[test]
fn sharp_turns_are_bevelled() {
    let ribbon = Ribbon::around(&line(&[(0, 0), (1000, 0), (0, 100)], 50.0));
    let furthest = ribbon.outline.as_flattened().iter().map(|at| at.u).max();
    assert!(furthest.is_some_and(|u| u <= 1050), "{furthest:?}");
    assert!(ribbon.parts.iter().any(|part| part.len() == 3), "a wedge");
}

/// Where a segment is too short for its inner sides to cross, they keep their length.
#[test]
fn short_segments_keep_their_sides() {
    let ribbon = Ribbon::around(&line(&[(0, 0), (1000, 0), (1000, 20), (2000, 20)], 50.0));
    let on_side = |at: &LatticePoint| at.v == 50 && at.u == 1000;
    assert!(ribbon.outline.as_flattened().iter().any(on_side));
}

/// A tile's half of a line joins its neighbour's half.
#[test]
fn halves_of_a_line_join() {
    let border = point(1000, 0);
    let whole = Ribbon::around(&line(&[(0, 0), (1000, 0), (2000, 300)], 50.0));
    let west = CenterLine {
        beyond: [None, Some(point(2000, 300))],
        ..line(&[(0, 0), (border.u, border.v)], 50.0)
    };
    let east = CenterLine {
        beyond: [Some(point(0, 0)), None],
        ..line(&[(border.u, border.v), (2000, 300)], 50.0)
    };
    let parts = [west, east].map(|half| Ribbon::around(&half).parts).concat();
    assert_eq!(parts, whole.parts);
}

/// An end that meets another road is half an octagon, within half a width of the end.
#[test]
fn ends_at_other_roads_are_round() {
    let met = CenterLine { is_met: [false, true], ..line(&[(0, 0), (1000, 0)], 50.0) };
    let ribbon = Ribbon::around(&met);
    let beyond: Vec<_> =
        ribbon.outline.as_flattened().iter().filter(|at| at.u > 1000).copied().collect();
    assert!(beyond.contains(&point(1050, 0)) && beyond.contains(&point(1035, 35)));
    assert!(beyond.iter().all(|at| at.distance_steps(point(1000, 0)) <= 51.0));
}

/// Lines across a road have the corners of its ribbon, one pair at a turn and two at a bevel.
#[test]
fn cross_sections_are_the_sides_of_the_ribbon() {
    let turn = line(&[(0, 0), (1000, 0), (1000, 1000)], 50.0);
    let sections = turn.cross_sections();
    let sides: Vec<_> = sections.iter().map(|section| section.sides).collect();
    let expected = [
        [point(0, 50), point(0, -50)],
        [point(950, 50), point(1050, -50)],
        [point(950, 1000), point(1050, 1000)],
    ];
    assert_eq!(sides, expected);
    assert_eq!(sections.iter().map(|section| section.point).collect::<Vec<_>>(), [0, 1, 2]);
    // Outside a sharp turn there are two corners, inside there is one.
    let sharp = line(&[(0, 0), (1000, 0), (0, 100)], 50.0).cross_sections();
    assert_eq!(sharp.len(), 4);
    assert_eq!(sharp[1].sides[0], sharp[2].sides[0]);
    assert_eq!(sharp[1].sides[1], point(1000, -50));
    assert_ne!(sharp[1].sides[1], sharp[2].sides[1]);
    // Both halves have the same cross-section at their border.
    let west =
        CenterLine { beyond: [None, Some(point(2000, 300))], ..line(&[(0, 0), (1000, 0)], 50.0) };
    let east =
        CenterLine { beyond: [Some(point(0, 0)), None], ..line(&[(1000, 0), (2000, 300)], 50.0) };
    let [west, east] = [west, east].map(|half| half.cross_sections());
    assert_eq!(west.last().map(|section| section.sides), east.first().map(|section| section.sides));
}
