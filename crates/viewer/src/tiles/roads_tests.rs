//! Pieces of roads are in order of class, and lines end at the border where they were cut.

#![expect(clippy::float_cmp, reason = "these numbers are exact")]

use corniche_geom::{Bounds, StepBudget};
use corniche_roads::FunctionalRoadClass;

use super::{
    super::PlanScale,
    ends::{TileSide, ground_ends, plan_ends},
    *,
};

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 100.0, max_y: 100.0 };

fn class(number: u8) -> FunctionalRoadClass {
    FunctionalRoadClass::new(number).expect("a class")
}

fn ground_line(number: u8, points_m: Vec<[f64; 3]>) -> GroundLine {
    GroundLine::of_source(1, class(number), points_m)
}

fn segments(lines: &[GroundLine]) -> RoadSegments {
    let work = StepBudget::unlimited();
    let none = TileLines::default();
    let decks = OffGroundRoads::new(&none, TILE, &work);
    let (lines, _) = InNet::all_of(lines, &decks, 0.0);
    RoadSegments::of_lines(&lines, &decks, [10.0, 20.0, 1.0], &PlanScale::default(), |_| {
        Bed::default()
    })
}

#[test]
fn segments_are_relative_and_sorted_by_class() {
    let lines = vec![
        ground_line(6, vec![[10.0, 20.0, 1.0], [11.0, 20.0, 1.5], [12.0, 20.0, 1.0]]),
        ground_line(0, vec![[0.0, 0.0, 0.0], [10.0, 20.0, 1.0]]),
    ];
    let roads = segments(&lines);
    assert_eq!(roads.range_of(class(0)), 0..1);
    assert_eq!(roads.range_of(class(6)), 1..3);
    assert!(roads.range_of(class(3)).is_empty());
    assert_eq!(roads.all()[0].end_in_tile, [0.0; 2]);
    assert_eq!(roads.all()[1].end_in_tile, [1.0, 0.0]);
    assert_eq!(roads.all()[2].height_in_tile, 0.5);
}

#[test]
fn pieces_of_a_segment_have_caps_at_its_ends_only() {
    let points_m = vec![[10.0, 20.0, 1.0], [11.0, 20.0, 1.5], [14.0, 20.0, 1.0], [14.0, 30.0, 1.0]];
    let segment = [[10.0, 20.0], [14.0, 20.0]];
    let sources_m = vec![segment, segment, [[14.0, 20.0], [14.0, 40.0]]];
    let line = GroundLine { sources_m, ..ground_line(2, points_m) };
    let roads = segments(&[line]);
    let found: Vec<_> = roads.all().iter().map(|piece| (piece.shares, piece.has_caps)).collect();
    // The last line ends halfway along its segment, at the tile's border or at a void.
    let expected =
        [([0.0, 0.25], [true, false]), ([0.25, 1.0], [false, true]), ([0.0, 0.5], [true, true])];
    assert_eq!(found, expected);
    assert_eq!(roads.all()[1].end_in_tile, [4.0, 0.0]);
}

#[test]
fn volumes_are_relative_sorted_by_class_and_never_lower_or_shallower_than_the_ground() {
    let line = |number, from: [f64; 2], range_m| PlanLine {
        way_id: 1,
        kind: RoadKind::plain(class(number)),
        points_m: vec![from, [30.0, 20.0]],
        ground_range_m: vec![range_m],
        dashes: None,
    };
    let lines = [line(5, [10.0, 20.0], [7.1, 9.3]), line(2, [20.0, 20.0], [1.0, 2.0])];
    let near = |[start, _]: [[f64; 2]; 2]| (start == [10.0, 20.0]).then_some(([8.1, 8.3], 0.7));
    let work = StepBudget::unlimited();
    let none = TileLines::default();
    let decks = OffGroundRoads::new(&none, TILE, &work);
    let (lines, _) = InNet::all_of(&lines, &decks, 8.0);
    let roads = RoadVolumes::new(&lines, &decks, [10.0, 20.0, 1.0], &PlanScale::default(), near);
    assert_eq!((roads.range_of(class(2)), roads.range_of(class(5))), (0..1, 1..2));
    assert_eq!(roads.all()[0].start_in_tile, [10.0, 0.0]);
    let [low, high] = roads.all()[1].height_range_in_tile.map(f64::from);
    assert!(low < 7.1 - 1.0 && high > 9.3 - 1.0);
    assert!((low - 6.1).abs() < 1e-5 && (high - 8.3).abs() < 1e-5);

    let near = roads.all()[1].near;
    let [low, high] = near.range_in_tile.map(f64::from);
    assert!(low < 8.1 - 1.0 && high > 8.3 - 1.0 && f64::from(near.rise) > 0.7);
    assert!((low - 7.1).abs() < 1e-5 && (high - 7.3).abs() < 1e-5 && near.rise < 0.701);
    let without = roads.all()[0].near;
    assert!((without.range_in_tile[0] - 0.5).abs() < 1e-5 && without.rise < 1e-6, "{without:?}");
}

#[test]
fn a_line_on_the_ground_ends_on_the_border_it_was_cut_at() {
    let check = |points_m: Vec<[f64; 3]>, expected: &[(TileSide, f64)]| {
        let ends = ground_ends([ground_line(4, points_m)].iter(), TILE, &PlanScale::default());
        let found: Vec<_> = ends.iter().map(|end| (end.side, end.height_range_m[0])).collect();
        assert_eq!(found, expected);
    };
    check(vec![[0.0, 50.0, 3.0], [40.0, 50.0, 4.0]], &[(TileSide::West, 3.0)]);
    check(
        vec![[10.0, 0.0, 3.0], [100.0, 50.0, 4.0]],
        &[(TileSide::South, 3.0), (TileSide::East, 4.0)],
    );
    check(vec![[10.0, 99.0, 3.0], [40.0, 100.0, 4.0]], &[(TileSide::North, 4.0)]);
    check(vec![[10.0, 10.0, 3.0], [0.0, 50.0, 3.5], [40.0, 50.0, 4.0]], &[]);
}

#[test]
fn a_line_in_plan_crosses_the_border_where_it_passes_to_the_other_side() {
    let check = |points_m: Vec<[f64; 2]>, expected: &[(TileSide, [f64; 2])]| {
        let ground_range_m = vec![[1.0, 2.0]; points_m.len() - 1];
        let line = PlanLine {
            dashes: None,
            way_id: 1,
            kind: RoadKind::plain(class(4)),
            points_m,
            ground_range_m,
        };
        let ends = plan_ends([line].iter(), TILE, &PlanScale::default());
        let found: Vec<_> = ends.iter().map(|end| (end.side, end.at_m)).collect();
        assert_eq!(found, expected);
    };
    check(vec![[-10.0, 40.0], [10.0, 60.0]], &[(TileSide::West, [0.0, 50.0])]);
    check(vec![[-10.0, 40.0], [0.0, 50.0], [10.0, 60.0]], &[(TileSide::West, [0.0, 50.0])]);
    check(
        vec![[50.0, 150.0], [50.0, -50.0]],
        &[(TileSide::South, [50.0, 0.0]), (TileSide::North, [50.0, 100.0])],
    );
    check(vec![[-10.0, 140.0], [10.0, 160.0]], &[]);
    check(vec![[20.0, 20.0], [60.0, 60.0]], &[]);
}
