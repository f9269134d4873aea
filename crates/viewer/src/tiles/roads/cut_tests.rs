//! Parts on decks are removed from lines, and nothing else.

use corniche_roads::FunctionalRoadClass;
use proptest::prelude::*;

use super::*;
use crate::tiles::RoadKind;

const TILE: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 100.0, max_y: 100.0 };

fn class() -> FunctionalRoadClass {
    FunctionalRoadClass::new(3).unwrap()
}

fn deck(way_id: i64, points: &[[f64; 2]]) -> DeckLine {
    DeckLine {
        way_id,
        kind: RoadKind::plain(class()),
        is_road: true,
        points_m: points.iter().map(|[x, y]| [*x, *y, 9.0]).collect(),
        on_ground: [false; 2],
    }
}

/// Returns a tile with these decks; ways with id 1 belong to a bridge.
fn tile_lines_with(decks: Vec<DeckLine>) -> TileLines {
    TileLines { decks, bridges: vec![1], ..TileLines::default() }
}

fn on_ground(points: &[[f64; 2]]) -> GroundLine {
    GroundLine::of_source(1, class(), points.iter().map(|[x, y]| [*x, *y, *x]).collect())
}

fn in_plan(points: &[[f64; 2]]) -> PlanLine {
    PlanLine {
        way_id: 1,
        kind: RoadKind::plain(class()),
        points_m: points.to_vec(),
        ground_range_m: vec![[0.0, 1.0]; points.len() - 1],
        dashes: None,
    }
}

/// Returns the remaining points of a line, by both methods.
fn left(line: &[[f64; 2]], decks: &[DeckLine]) -> Vec<Vec<[f64; 2]>> {
    let of_decks = tile_lines_with(decks.to_vec());
    let work = StepBudget::unlimited();
    let cut = OffGroundRoads::new(&of_decks, TILE, &work);
    let ground: Vec<Vec<[f64; 2]>> = cut
        .without_ground(&on_ground(line))
        .iter()
        .map(|line| {
            assert_eq!(line.sources_m.len() + 1, line.points_m.len());
            for ([x, _, z], _) in line.points_m.iter().zip(0..) {
                // An end of a deck is searched within this distance of its line, and may be found
                // at a vertex.
                assert!((x - z).abs() <= NEAR_M, "the heights are those of the line");
            }
            line.points_m.iter().map(|[x, y, _]| [*x, *y]).collect()
        })
        .collect();
    let plan: Vec<Vec<[f64; 2]>> =
        cut.without_plan(&in_plan(line)).iter().map(|line| line.points_m.clone()).collect();
    assert_eq!(ground, plan, "both methods");
    ground
}

const LINE: [[f64; 2]; 4] = [[10.0, 10.0], [40.0, 10.0], [40.0, 50.0], [90.0, 50.0]];

#[test]
fn a_deck_is_taken_out_of_its_way() {
    let runs = [deck(1, &[[30.0, 10.0], [40.0, 10.0], [40.0, 20.0]])];
    let [a, b, c, d] = LINE;
    assert_eq!(left(&LINE, &runs), [vec![a, [30.0, 10.0]], vec![[40.0, 20.0], c, d]]);
    let two = [deck(1, &[a, [20.0, 10.0]]), deck(1, &[[40.0, 45.0], c, [45.0, 50.0]])];
    assert_eq!(left(&LINE, &two), [vec![[20.0, 10.0], b, [40.0, 45.0]], vec![[45.0, 50.0], d]]);
    assert!(left(&LINE, &[deck(1, &LINE)]).is_empty());
    assert_eq!(left(&LINE, &[deck(2, &LINE)]), [LINE.to_vec()], "another way");
}

#[test]
fn what_is_not_on_the_way_takes_nothing() {
    assert_eq!(left(&LINE, &[deck(1, &[[30.0, 11.0], [40.0, 11.0]])]), [LINE.to_vec()]);
    // Its ends are on the way, but the way between them is longer.
    assert_eq!(left(&LINE, &[deck(1, &[[30.0, 10.0], [45.0, 50.0]])]), [LINE.to_vec()]);
    assert_eq!(left(&LINE, &[deck(1, &[[30.0, 10.0]])]), [LINE.to_vec()]);
}

/// A way that passes through a point twice is cut where the deck runs along it.
#[test]
fn a_loop_is_cut_at_the_right_time() {
    let around =
        [[10.0, 50.0], [50.0, 50.0], [90.0, 50.0], [90.0, 90.0], [50.0, 90.0], [50.0, 10.0]];
    let run = deck(1, &[[50.0, 60.0], [50.0, 40.0]]);
    let [a, b, c, d, e, f] = around;
    assert_eq!(left(&around, &[run]), [vec![a, b, c, d, e, [50.0, 60.0]], vec![[50.0, 40.0], f]]);
    let from_crossing = deck(1, &[[50.0, 50.0], [50.0, 30.0]]);
    assert_eq!(
        left(&around, &[from_crossing]),
        [vec![a, b, c, d, e, [50.0, 50.0]], vec![[50.0, 30.0], f]]
    );
}

/// If a part of a segment remains, the segment ends there: no quad and no box paints the part on
/// the deck.
#[test]
fn segments_end_where_the_deck_begins() {
    let work = StepBudget::unlimited();
    let decks = tile_lines_with(vec![deck(1, &[[20.0, 10.0], [30.0, 10.0]])]);
    let cut = OffGroundRoads::new(&decks, TILE, &work);
    // Three pieces of one segment.
    let source = [[10.0, 10.0], [40.0, 10.0]];
    let line = on_ground(&[[10.0, 10.0], [15.0, 10.0], [25.0, 10.0], [40.0, 10.0]]);
    let line = GroundLine { sources_m: vec![source; 3], ..line };
    let left = cut.without_ground(&line);
    let sources: Vec<_> = left.iter().map(|line| line.sources_m.clone()).collect();
    let [first, second] = [[[10.0, 10.0], [20.0, 10.0]], [[30.0, 10.0], [40.0, 10.0]]];
    assert_eq!(sources, [vec![first; 2], vec![second]]);
}

/// Volumes extend beyond the tile. There the deck is assumed to continue, because this tile knows
/// nothing about it.
#[test]
fn nothing_is_left_beyond_the_border_where_a_deck_leaves_the_tile() {
    let work = StepBudget::unlimited();
    let decks = tile_lines_with(vec![deck(1, &[[80.0, 50.0], [100.0, 50.0]])]);
    let cut = OffGroundRoads::new(&decks, TILE, &work);
    let line = in_plan(&[[70.0, 50.0], [105.0, 50.0], [108.0, 55.0]]);
    let left = cut.without_plan(&line);
    assert_eq!(left.len(), 1);
    assert_eq!(left[0].points_m, [[70.0, 50.0], [80.0, 50.0]]);
    let back = in_plan(&[[108.0, 55.0], [105.0, 50.0], [70.0, 50.0]]);
    let decks = tile_lines_with(vec![deck(1, &[[100.0, 50.0], [80.0, 50.0]])]);
    let cut = OffGroundRoads::new(&decks, TILE, &work);
    assert_eq!(cut.without_plan(&back)[0].points_m, [[80.0, 50.0], [70.0, 50.0]]);
}

/// The bridge leaves the tile and comes back with two points outside, and continues next to the
/// border.
#[test]
fn of_a_bridge_nothing_is_left_outside_the_tile() {
    let work = StepBudget::unlimited();
    let line = in_plan(&[[90.0, 20.0], [104.0, 20.0], [104.0, 40.0], [90.0, 40.0], [90.0, 101.0]]);
    let points = |lines: &TileLines| -> Vec<Vec<[f64; 2]>> {
        let cut = OffGroundRoads::new(lines, TILE, &work);
        cut.without_plan(&line).iter().map(|line| line.points_m.clone()).collect()
    };
    let [first, second] =
        [vec![[90.0, 20.0], [100.0, 20.0]], vec![[100.0, 40.0], [90.0, 40.0], [90.0, 100.0]]];
    assert_eq!(points(&tile_lines_with(Vec::new())), [first.clone(), second.clone()]);
    let runs =
        vec![deck(1, &[[95.0, 20.0], [100.0, 20.0]]), deck(1, &[[100.0, 40.0], [95.0, 40.0]])];
    let parts = points(&tile_lines_with(runs));
    assert_eq!(
        parts,
        [vec![[90.0, 20.0], [95.0, 20.0]], vec![[95.0, 40.0], [90.0, 40.0], [90.0, 100.0]]]
    );
    assert_eq!(points(&TileLines::default()), std::slice::from_ref(&line.points_m), "a road");
    let beside = in_plan(&[[103.0, 10.0], [103.0, 90.0]]);
    let lines = tile_lines_with(Vec::new());
    assert!(OffGroundRoads::new(&lines, TILE, &work).without_plan(&beside).is_empty());
}

#[test]
fn too_much_work_is_told() {
    let work = StepBudget::new(1000);
    let line: Vec<[f64; 2]> = (0..600).map(|k| [f64::from(k % 2), 0.0]).collect();
    let decks = tile_lines_with((0..600).map(|_| deck(1, &[[0.5, 0.0], [7.0, 0.0]])).collect());
    let cut = OffGroundRoads::new(&decks, TILE, &work);
    let _ = cut.without_plan(&in_plan(&line));
    assert!(work.check().is_err());
}

proptest! {
    /// The removed and the remaining parts together are as long as the line.
    #[test]
    fn nothing_is_lost(
        xs in prop::collection::vec(1.0_f64..99.0, 2..12),
        shares in prop::array::uniform2(0.0_f64..1.0),
    ) {
        let line: Vec<[f64; 2]> =
            xs.iter().zip(1..).map(|(x, k)| [*x, 8.0 * f64::from(k)]).collect();
        let length = |points: &[[f64; 2]]| -> f64 {
            points.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
        };
        let all_m = length(&line);
        let [from_m, to_m] = [shares[0].min(shares[1]) * all_m, shares[0].max(shares[1]) * all_m];
        prop_assume!(to_m - from_m > 0.1);
        let at = |along_m: f64| {
            let mut left_m = along_m;
            for pair in line.windows(2) {
                let own_m = distance(pair[0], pair[1]);
                if left_m <= own_m {
                    return along(pair[0], pair[1], left_m / own_m);
                }
                left_m -= own_m;
            }
            line[line.len() - 1]
        };
        let mut run = vec![at(from_m)];
        let mut passed_m = 0.0;
        for pair in line.windows(2) {
            passed_m += distance(pair[0], pair[1]);
            if from_m < passed_m && passed_m < to_m {
                run.push(pair[1]);
            }
        }
        run.push(at(to_m));
        let rest: f64 = left(&line, &[deck(1, &run)]).iter().map(|part| length(part)).sum();
        prop_assert!((rest + to_m - from_m - all_m).abs() < 0.05, "{} {}", rest, all_m);
    }
}
