//! Decks are cut into pieces that fit together.

#![expect(clippy::float_cmp, reason = "these numbers are exact")]

use corniche_roads::FunctionalRoadClass;

use super::*;

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 1000.0, max_y: 1000.0 };

fn deck(way_id: i64, number: u8, points_m: &[[f64; 3]]) -> DeckLine {
    DeckLine {
        way_id,
        kind: RoadKind::plain(FunctionalRoadClass::new(number).unwrap()),
        is_road: true,
        points_m: points_m.to_vec(),
        on_ground: [false; 2],
    }
}

fn pieces(decks: &[DeckLine], ground: &GroundNet) -> DeckPieces {
    DeckPieces::of_decks(
        decks,
        ground,
        (TILE, [500.0, 500.0, 10.0]),
        &PlanScale::default(),
        &StepBudget::unlimited(),
    )
}

#[test]
fn long_segments_are_divided_evenly() {
    let all =
        pieces(&[deck(1, 4, &[[100.0, 100.0, 10.0], [100.0, 600.0, 40.0]])], &GroundNet::default());
    let heights: Vec<f32> = all.all().iter().map(|piece| piece.start_in_tile[2]).collect();
    assert_eq!(heights, [0.0, 10.0, 20.0]);
    assert_eq!(all.all()[2].end_in_tile, [-400.0, 100.0, 30.0]);
    let mitres: Vec<_> = all.all().iter().map(|piece| piece.mitres).collect();
    let [none, back, ahead] = [[0.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
    assert_eq!(mitres, [[none, ahead], [back, ahead], [back, none]], "round at both ends");
    assert!(all.all().iter().all(|piece| piece.slab_m == 1.0));
}

#[test]
fn pieces_meet_half_way_at_bends() {
    let bend = deck(1, 0, &[[100.0, 100.0, 20.0], [200.0, 100.0, 20.0], [200.0, 200.0, 20.0]]);
    let all = pieces(&[bend], &GroundNet::default());
    let half = 0.5_f32.sqrt();
    let [first, second] = [0, 1].map(|k| all.all()[k].mitres);
    assert!((first[1][0] - half).abs() < 1e-6 && (first[1][1] - half).abs() < 1e-6);
    assert_eq!(second[0], first[1].map(|part| -part));
    let back = deck(1, 0, &[[100.0, 100.0, 20.0], [200.0, 100.0, 20.0], [110.0, 101.0, 20.0]]);
    let all = pieces(&[back], &GroundNet::default());
    assert_eq!(all.all()[0].mitres[1], [0.0; 2], "it turns back: both have round caps");
}

#[test]
fn decks_end_flat_at_the_border_and_where_a_road_goes_on() {
    let points = [[0.0, 100.0, 20.0], [150.0, 100.0, 20.0]];
    let road = LineEnds::of_road(
        RoadKind::plain(FunctionalRoadClass::new(3).unwrap()),
        [Some([[200.0, 100.0], [150.0, 100.0]]), None],
    );
    let net = |ends: Vec<LineEnds>| GroundNet { ends, parts_m: BTreeMap::from([(1, 77.0)]) };
    let all = pieces(&[deck(1, 3, &points)], &net(vec![road]));
    assert_eq!(all.all()[0].mitres, [[-1.0, 0.0], [1.0, 0.0]]);
    assert_eq!(all.all()[0].part_m, 77.0);
    assert_eq!(all.ends().len(), 1);
    assert_eq!((all.ends()[0].side, all.ends()[0].height_range_m), (TileSide::West, [20.0; 2]));
    let fork = pieces(&[deck(1, 3, &points)], &net(vec![road, road]));
    assert_eq!(fork.all()[0].mitres[1], [0.0; 2], "two roads continue");
}

#[test]
fn points_at_one_place_in_plan_make_no_piece() {
    let points = [[100.0, 100.0, 20.0], [100.0, 100.0, 25.0], [150.0, 100.0, 25.0]];
    assert_eq!(pieces(&[deck(1, 3, &points)], &GroundNet::default()).all().len(), 1);
    assert!(pieces(&[deck(1, 3, &points[..2])], &GroundNet::default()).all().is_empty());
    assert!(pieces(&[deck(1, 3, &[])], &GroundNet::default()).all().is_empty());
}
