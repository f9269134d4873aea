//! Whether hand-drawn lines that touch also cross depends neither on their directions nor on the
//! orientation of the map.

use corniche_roads::Structure::{Bridge, Ground};

use crate::{
    Crossing, crossings,
    network_tests::{Way, distance_m, network, way},
};

/// The positions along a line, metres; nodes of different lines are different nodes.
type Places<'a> = &'a [(i64, i64)];

/// Returns the crossings. A stretch that both lines share has several places, but is one crossing.
fn found(ways: &[Way<'_>]) -> Vec<Vec<Crossing>> {
    let (network, chains) = network(ways);
    let all = crossings(&network, &chains, &distance_m).all;
    all.chunk_by(|_, next| next.continues).map(<[Crossing]>::to_vec).collect()
}

/// A function that turns a position around the origin.
type Turn = fn((i64, i64)) -> (i64, i64);

/// Counts the crossings of a bridge with roads on the ground, in all directions, turned and
/// mirrored; the number is always the same.
fn count(bridge: Places<'_>, roads: &[Places<'_>]) -> usize {
    let turns: [Turn; 4] =
        [|at| at, |(u, v)| (-v, u), |(u, v)| (u, -v), |(u, v)| (u + 3 * v, v - u)];
    let mut counts = Vec::new();
    for turn in turns {
        for directions in 0..4 {
            let line = |id: i64, structure, places: Places<'_>, is_back: bool| {
                let mut nodes: Vec<(i64, i64, i64)> = (1000 * id..)
                    .zip(places)
                    .map(|(node, &at)| (node, turn(at).0, turn(at).1))
                    .collect();
                if is_back {
                    nodes.reverse();
                }
                way(id, structure, &nodes)
            };
            let mut ways = vec![line(1, Bridge, bridge, directions % 2 == 1)];
            ways.extend(
                (2..).zip(roads).map(|(id, &places)| line(id, Ground, places, directions / 2 == 1)),
            );
            counts.push(found(&ways).len());
        }
    }
    assert!(counts.iter().all(|count| *count == counts[0]), "{counts:?}");
    counts[0]
}

const BRIDGE: Places<'_> = &[(0, 0), (100, 0), (200, 0), (300, 0)];

#[test]
fn nodes_at_one_place_cross_where_the_sides_change() {
    assert_eq!(count(BRIDGE, &[&[(100, -50), (100, 0), (100, 50)]]), 1);
    assert_eq!(count(BRIDGE, &[&[(60, -50), (100, 0), (140, 50)]]), 1);
    assert_eq!(count(BRIDGE, &[&[(60, 50), (100, 0), (140, 50)]]), 0, "it touches");
    assert_eq!(count(BRIDGE, &[&[(100, -50), (100, 0)]]), 0, "it ends there");
    // The bridge has a bend: a road that passes outside it touches it, and a road that goes inside
    // crosses it.
    let bent: Places<'_> = &[(0, 0), (100, 0), (100, 100)];
    assert_eq!(count(bent, &[&[(150, -50), (100, 0), (50, 50)]]), 1);
    assert_eq!(count(bent, &[&[(50, -50), (100, 0), (150, 50)]]), 0);
}

#[test]
fn points_on_the_other_line_cross_where_the_sides_change() {
    assert_eq!(count(BRIDGE, &[&[(150, -50), (150, 0), (160, 50)]]), 1);
    assert_eq!(count(BRIDGE, &[&[(150, -50), (150, 0), (160, -50)]]), 0);
    assert_eq!(count(BRIDGE, &[&[(50, -50), (150, 50)]]), 1, "through a point of the bridge");
    let vee: Places<'_> = &[(0, 50), (100, 0), (200, 50)];
    assert_eq!(count(vee, &[&[(0, 0), (300, 0)]]), 0);
}

#[test]
fn stretches_in_common_cross_once_where_the_sides_change() {
    for inner in [&[][..], &[(150, 0)], &[(110, 0), (120, 0), (200, 0), (230, 0)]] {
        let with = |first: (i64, i64), last: (i64, i64), ends: [(i64, i64); 2]| {
            [&[first, ends[0]][..], inner, &[ends[1], last]].concat()
        };
        // Both begin and end at nodes of the bridge, or between nodes.
        for ends in [[(100, 0), (250, 0)], [(90, 0), (300 - 60, 0)]] {
            assert_eq!(count(BRIDGE, &[&with((50, -50), (280, 50), ends)]), 1, "{ends:?}");
            assert_eq!(count(BRIDGE, &[&with((50, -50), (280, -50), ends)]), 0, "{ends:?}");
        }
    }
    assert_eq!(count(BRIDGE, &[&[(50, -50), (100, 0), (200, 0)]]), 0, "it ends on the bridge");
    assert_eq!(count(BRIDGE, &[&[(20, 0), (80, 0)]]), 0, "it lies on the bridge");
    // The bridge goes around a corner.
    let bent: Places<'_> = &[(0, 0), (100, 0), (100, 100), (200, 100)];
    assert_eq!(count(bent, &[&[(20, -50), (60, 0), (100, 0), (100, 40), (50, 60)]]), 1);
    assert_eq!(count(bent, &[&[(20, -50), (60, 0), (100, 0), (100, 40), (150, 60)]]), 0);
}

/// A street with side streets shares a stretch beneath a bridge. It has junctions there, and
/// crosses in each part between them or in none.
#[test]
fn stretches_in_common_go_on_over_junctions() {
    let bridge = [(1, 0, 0), (2, 100, 0), (3, 200, 0), (4, 300, 0)];
    let back: Vec<_> = bridge.iter().rev().copied().collect();
    for bridge in [&bridge[..], &back] {
        let beneath = |last: i64| {
            found(&[
                way(1, Bridge, bridge),
                way(2, Ground, &[(11, 50, -50), (12, 90, 0), (13, 150, 0)]),
                way(3, Ground, &[(15, 210, 0), (14, 180, 0), (13, 150, 0)]),
                way(4, Ground, &[(15, 210, 0), (16, 240, 0), (17, 260, last)]),
                way(5, Ground, &[(13, 150, 0), (18, 150, -80)]),
                way(6, Ground, &[(15, 210, 0), (19, 210, 80)]),
            ])
        };
        assert!(beneath(-50).is_empty());
        let parts = beneath(50);
        let length_m = |part: &Vec<Crossing>| part.iter().map(|at| 2.0 * at.half_m).sum::<f64>();
        let mut lengths_m: Vec<f64> = parts.iter().map(length_m).collect();
        lengths_m.sort_by(f64::total_cmp);
        assert_eq!(lengths_m.len(), 3, "{parts:?}");
        assert!(lengths_m.iter().zip([30.0, 60.0, 60.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}

/// Both lines have the same node; the meaning of that is not decided here.
#[test]
fn with_a_node_in_common_lines_do_not_cross() {
    let bridge = || way(1, Bridge, &[(1, 0, 0), (2, 100, 0), (3, 200, 0), (4, 300, 0)]);
    let at_a_node = way(2, Ground, &[(5, 100, -50), (2, 100, 0), (6, 100, 50)]);
    assert!(found(&[bridge(), at_a_node]).is_empty());
    let within =
        way(2, Ground, &[(5, 50, -50), (6, 90, 0), (3, 200, 0), (7, 250, 0), (8, 260, 50)]);
    assert!(found(&[bridge(), within]).is_empty(), "within a stretch that both share");
}

/// If several chains meet at one node, the road beneath has one crossing.
#[test]
fn a_junction_on_a_bridge_is_crossed_once() {
    let fork = || {
        [
            way(1, Bridge, &[(1, 0, 0), (2, 100, 0)]),
            way(2, Bridge, &[(2, 100, 0), (3, 200, 30)]),
            way(3, Bridge, &[(2, 100, 0), (4, 200, -30)]),
        ]
    };
    let beneath = |nodes: &[(i64, i64, i64)]| {
        let mut ways = fork().to_vec();
        ways.push(way(4, Ground, nodes));
        found(&ways).len()
    };
    assert_eq!(beneath(&[(5, 100, -50), (6, 100, 0), (7, 100, 50)]), 1);
    assert_eq!(beneath(&[(5, 100, -50), (7, 100, 50)]), 1, "without a node of its own");
    assert_eq!(beneath(&[(5, 50, 50), (6, 100, 0), (7, 90, 60)]), 0);
    // A fork on the ground is beneath a node of a bridge, and then both forks are above each other.
    let mut ways = vec![way(1, Bridge, &[(1, 0, 0), (2, 100, 0), (3, 200, 0)])];
    let arms = [(8, 100, -50), (9, 70, 50), (10, 130, 50)];
    ways.extend((2..).zip(arms).map(|(id, arm)| way(id, Ground, &[(7, 100, 0), arm])));
    assert_eq!(found(&ways).len(), 1);
    let mut ways = fork().to_vec();
    ways.extend((4..).zip(arms).map(|(id, arm)| way(id, Ground, &[(7, 100, 0), arm])));
    assert_eq!(found(&ways).len(), 1);
}

/// A shared stretch of 100 m is listed as ten places that cover it, along the bridge and along the
/// road.
#[test]
fn a_stretch_is_covered_by_its_places() {
    let nodes = [(11, 50, -50), (12, 100, 0), (13, 200, 0), (14, 250, 50)];
    let ways = [way(1, Bridge, &[(1, 0, 0), (2, 100, 0), (3, 300, 0)]), way(2, Bridge, &nodes)];
    let all = found(&ways);
    let [stretch] = &all[..] else { panic!("{all:?}") };
    assert_eq!(stretch.len(), 10);
    for (k, crossing) in stretch.iter().enumerate() {
        let from_m = 10.0 * k as f64;
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
        let own = [crossing.upper, crossing.lower];
        let along_m = [1, 2].map(|id| own.iter().find(|place| place.way_id == id).unwrap().along_m);
        let before_m = 5000_f64.sqrt();
        let at_m = [from_m + 5.0, 95.0 - from_m].map(|at_m| [100.0 + at_m, before_m + at_m]);
        assert!(at_m.iter().any(|at_m| is(along_m[0], at_m[0]) && is(along_m[1], at_m[1])));
        assert!(is(crossing.half_m, 5.0) && crossing.continues == (k > 0));
    }
}
