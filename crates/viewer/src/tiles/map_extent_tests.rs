//! The extent of a map covers its roads, and one distant road does not widen it.

use super::*;

const DATA: Bounds = Bounds { min_x: 0.0, min_y: 0.0, max_x: 100_000.0, max_y: 50_000.0 };

/// Returns a piece with its middle at this point, along the first axis.
fn piece([x, y]: [f64; 2], length_m: f64) -> RoadStretch {
    let ends = [-0.5, 0.5].map(|share| [x + share * length_m, y]);
    RoadStretch { ends, class: FunctionalRoadClass::new(4).unwrap() }
}

#[test]
fn one_far_road_does_not_widen_the_map() {
    let mut pieces: Vec<_> = (0..100).map(|k| piece([f64::from(k), 0.0], 10.0)).collect();
    pieces.push(piece([9000.0, 0.0], 5.0));
    let [west, east] = without_tails(&pieces, 0).unwrap();
    assert!((west - 1.0).abs() < 1.5 && (east - 98.0).abs() < 1.5, "{west} {east}");
    pieces.push(piece([9000.0, 0.0], 500.0));
    assert_eq!(without_tails(&pieces, 0).unwrap()[1], 9000.0, "a long road is not a tail");
}

#[test]
fn without_length_there_is_no_extent() {
    assert_eq!(without_tails(&[], 0), None);
    assert_eq!(without_tails(&[piece([1.0, 2.0], 0.0)], 0), None);
}

#[test]
fn the_margin_stays_within_the_data() {
    let roads = Bounds { min_x: 100.0, min_y: 10_000.0, max_x: 10_100.0, max_y: 12_000.0 };
    let map = with_margin(roads, DATA);
    assert_eq!(map, Bounds { min_x: 0.0, min_y: 9200.0, max_x: 10_900.0, max_y: 12_800.0 });
    // A single point still gives a map, as large as a hundredth of the data.
    let point = Bounds { min_x: 5e4, min_y: 2e4, max_x: 5e4, max_y: 2e4 };
    assert_eq!(with_margin(point, DATA).width(), 1000.0);
    let outside = Bounds { min_x: -9e4, min_y: 2e4, max_x: -8e4, max_y: 2e4 };
    assert_eq!(with_margin(outside, DATA), DATA);
}

#[test]
fn parts_of_segments_have_their_middle_and_length() {
    assert_eq!(part_of([10.0, 0.0], [10.0, 100.0], [0.5, 1.0]), [[10.0, 50.0], [10.0, 100.0]]);
}

/// A town, and scattered roads of other towns around it, which are less than half of all. Important
/// roads have a larger weight.
#[test]
fn most_roads_in_one_place_are_the_map() {
    let town = (0..40).map(|k| piece([f64::from(k % 8) * 50.0, f64::from(k / 8) * 50.0], 50.0));
    let town: Vec<RoadStretch> = town.collect();
    let stray: Vec<RoadStretch> =
        (0..10).map(|k| piece([f64::from(k) * 3000.0 + 5000.0, 9000.0], 150.0)).collect();
    let all = |stray: &[RoadStretch]| densest_cluster(town.iter().chain(stray).copied().collect());
    assert_eq!(all(&stray), town);
    let longer: Vec<RoadStretch> = stray
        .iter()
        .map(|piece| RoadStretch {
            ends: [piece.ends[0], [piece.ends[1][0] + 100.0, 9000.0]],
            ..*piece
        })
        .collect();
    assert_eq!(all(&longer).len(), 50, "no cluster has more than half of the weight");
    let motorway =
        |piece: &RoadStretch| RoadStretch { class: FunctionalRoadClass::new(0).unwrap(), ..*piece };
    assert_eq!(all(&stray.iter().map(motorway).collect::<Vec<_>>()).len(), 50);
    // Pieces that cut a corner of a cell count, too.
    let slant = |k: i32| {
        let x = f64::from(k) * 37.0;
        RoadStretch { ends: [[x, x + 11.0], [x + 37.0, x + 61.0]], ..town[0] }
    };
    let slants: Vec<RoadStretch> = (0..200).map(slant).collect();
    assert_eq!(densest_cluster(slants.clone()), slants);
    assert_eq!(densest_cluster(Vec::new()), []);
    assert_eq!(densest_cluster(vec![piece([3.0, 4.0], 0.0)]).len(), 1);
}
