//! Undraped roads are straight between the points of their source.

use corniche_roads::FunctionalRoadClass;
use proptest::prelude::*;

use super::*;

fn class() -> FunctionalRoadClass {
    FunctionalRoadClass::new(3).unwrap()
}

/// Returns a road with these points and their heights, and with crossings of triangle edges between
/// two points, which have the heights of the ground.
fn laid(points_m: &[[f64; 3]], crossings: &[Vec<(f64, f64)>]) -> GroundLine {
    let mut line = GroundLine::of_source(7, class(), Vec::new());
    for (pair, crossings) in points_m.windows(2).zip(crossings) {
        let [a, b] = [pair[0], pair[1]];
        line.points_m.push(a);
        for &(share, height_m) in crossings {
            let [x, y] = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
            line.points_m.push([x, y, height_m]);
        }
        let source_m = [a, b].map(|[x, y, _]| [x, y]);
        line.sources_m.extend(vec![source_m; crossings.len() + 1]);
    }
    line.points_m.extend(points_m.last());
    line
}

#[test]
fn a_road_over_a_hill_is_one_straight_line() {
    let ends = [[0.0, 0.0, 100.0], [80.0, 60.0, 130.0]];
    let hill = laid(&ends, &[vec![(0.25, 180.0), (0.5, 240.0), (0.75, 150.0)]]);
    assert_eq!(hill.points_m.len(), 5);
    let line = DeckLine::unmapped(&hill);
    assert_eq!(line.points_m, ends);
    assert_eq!((line.way_id, line.kind.class, line.on_ground), (7, class(), [false; 2]));
}

/// A road that turns back runs along the same positions in plan twice.
#[test]
fn a_road_that_turns_back_keeps_the_point_where_it_does() {
    let points = [[0.0, 0.0, 10.0], [50.0, 0.0, 20.0], [0.0, 0.0, 10.0], [50.0, 0.0, 20.0]];
    let there_and_back = laid(&points, &[vec![(0.5, 40.0)], vec![], vec![(0.1, 0.0)]]);
    assert_eq!(DeckLine::unmapped(&there_and_back).points_m, points);
}

#[test]
fn a_line_without_points_stays_one() {
    let nothing = GroundLine::of_source(1, class(), Vec::new());
    assert!(DeckLine::unmapped(&nothing).points_m.is_empty());
}

proptest! {
    /// With any ground between the points of a road, only the original points remain.
    #[test]
    fn the_points_of_the_source_are_left(
        points in prop::collection::vec(prop::array::uniform2(-500.0_f64..500.0), 2..9),
        ground in prop::collection::vec(prop::collection::vec((0.01_f64..0.99, 0.0_f64..900.0), 0..5), 8),
    ) {
        let points: Vec<[f64; 3]> = points.iter().map(|[x, y]| [*x, *y, x + y]).collect();
        let mut ground = ground;
        for of in &mut ground {
            of.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        prop_assert_eq!(DeckLine::unmapped(&laid(&points, &ground)).points_m, points);
    }
}
