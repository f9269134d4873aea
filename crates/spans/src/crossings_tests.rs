//! Crossings are found where lines cross without a common node, and their order is right.

use corniche_roads::Structure::{self, Bridge, Ground, Tunnel};

use super::*;
use crate::network_tests::{Way, distance_m, network, way};

/// Returns the upper way, the lower way, whether the order is known, and the position in metres.
fn found(ways: &[Way<'_>]) -> Vec<(i64, i64, bool, [i64; 2])> {
    let (network, chains) = network(ways);
    let mut found: Vec<_> = crossings(&network, &chains, &distance_m)
        .all
        .into_iter()
        .map(|Crossing { at, upper, lower, order, .. }| {
            let at = at.map(|part| (part / 1000.0).round() as i64);
            (upper.way_id, lower.way_id, order == Order::Known, at)
        })
        .collect();
    found.sort_unstable();
    found
}

fn across(id: i64, east: i64, structure: Structure, layer: i8) -> Way<'static> {
    let nodes = [(100 * id, east, -50), (100 * id + 1, east, 50)];
    Way { layer, ..way(id, structure, &nodes) }
}

fn along(id: i64, structure: Structure, layer: i8) -> Way<'static> {
    Way { layer, ..way(id, structure, &[(10 * id, 0, 0), (10 * id + 1, 400, 0)]) }
}

#[test]
fn bridges_are_above_the_ground_and_tunnels_below_whatever_their_layers() {
    let ways = [
        along(1, Ground, 3),
        across(2, 10, Bridge, -2),
        across(3, 20, Tunnel, 4),
        across(4, 30, Ground, 1),
    ];
    assert_eq!(found(&ways), [(1, 3, true, [20, 0]), (2, 1, true, [10, 0])]);
}

#[test]
fn spans_are_ordered_by_layer() {
    let ways = [
        along(1, Bridge, 2),
        across(2, 10, Bridge, 0),
        across(3, 20, Bridge, 3),
        across(4, 30, Bridge, 2),
        across(5, 40, Tunnel, 0),
    ];
    let expected = [
        (1, 2, true, [10, 0]),
        (1, 4, false, [30, 0]),
        (1, 5, true, [40, 0]),
        (3, 1, true, [20, 0]),
    ];
    let mut all = found(&ways);
    all.iter_mut()
        .filter(|(.., known, _)| !known)
        .for_each(|one| (one.0, one.1) = (one.0.min(one.1), one.0.max(one.1)));
    all.sort_unstable();
    assert_eq!(all, expected);
}

/// A road through a point of a bridge that is not a node of the road crosses once. A road with that
/// node does not cross.
#[test]
fn points_on_lines_count_once_and_common_nodes_never() {
    let bridge = || way(1, Bridge, &[(1, 0, 0), (2, 100, 0), (3, 200, 10)]);
    assert_eq!(found(&[bridge(), across(2, 100, Ground, 0)]), [(1, 2, true, [100, 0])]);
    let meets = way(2, Ground, &[(20, 100, -50), (2, 100, 0), (21, 100, 50)]);
    assert_eq!(found(&[bridge(), meets]), []);
    let lies_on_it = way(2, Ground, &[(20, 20, 0), (21, 80, 0)]);
    assert_eq!(found(&[bridge(), lies_on_it]), []);
}

#[test]
fn places_are_told_along_chains() {
    let (network, chains) = network(&[
        way(1, Bridge, &[(1, 0, 0), (2, 30, 40), (3, 130, 40)]),
        way(2, Ground, &[(4, 100, 0), (5, 100, 100)]),
    ]);
    let found = crossings(&network, &chains, &distance_m).all;
    let [Crossing { upper, lower, .. }] = found[..] else { panic!("{found:?}") };
    let is = |along_m: f64, expected: f64| (along_m - expected).abs() < 1e-9;
    assert!(is(upper.along_m, 120.0) && is(lower.along_m, 0.0), "{upper:?} {lower:?}");
}

/// A bridge without a layer is below one with layer 1, and above one with layer −1.
#[test]
fn layers_are_compared_as_they_are_tagged() {
    let ways = [along(1, Bridge, 0), across(2, 10, Bridge, 1), across(3, 20, Bridge, -1)];
    assert_eq!(found(&ways), [(1, 3, true, [20, 0]), (2, 1, true, [10, 0])]);
    let ways = [along(1, Tunnel, 0), across(2, 10, Tunnel, -1), across(3, 20, Tunnel, 1)];
    assert_eq!(found(&ways), [(1, 2, true, [10, 0]), (3, 1, true, [20, 0])]);
}

/// A road that goes to and fro over a bridge thousands of times, or a bridge over a road, is
/// omitted; other crossings stay.
#[test]
fn what_crosses_too_often_is_left_out_and_told() {
    let zigzag = |id: i64, structure| {
        let nodes: Vec<(i64, i64, i64)> =
            (0..3000).map(|k| (100_000 + k, k, if k % 2 == 0 { -40 } else { 40 })).collect();
        way(id, structure, &nodes)
    };
    let straight = |id: i64, structure| way(id, structure, &[(1, -100, 0), (2, 5000, 0)]);
    for kinds in [[Ground, Bridge], [Bridge, Ground], [Bridge, Bridge], [Tunnel, Ground]] {
        let other = across(3, -50, if kinds[1] == Ground { Bridge } else { Ground }, 1);
        let (network, chains) = network(&[zigzag(1, kinds[0]), straight(2, kinds[1]), other]);
        let found = crossings(&network, &chains, &distance_m);
        assert_eq!(found.left_out, [1]);
        let ways: Vec<[i64; 2]> =
            found.all.iter().map(|own| [own.upper.way_id, own.lower.way_id]).collect();
        assert!(ways == [[3, 2]] || ways == [[2, 3]], "{ways:?}");
    }
}

/// The boxes of parallel diagonals overlap although no two diagonals cross: the work is
/// proportional to the number of points.
#[test]
fn lines_over_each_other_end_soon() {
    let diagonal = |k: i64| {
        let up = 90_000 * (k % 2);
        (100 + k, 3 * k + up, up)
    };
    let diagonals: Vec<(i64, i64, i64)> = (0..20_000).map(diagonal).collect();
    let (network, chains) = network(&[
        way(1, Bridge, &diagonals),
        way(2, Ground, &[(1, -100, -50), (2, -100, 50)]),
        way(3, Bridge, &[(3, -200, 0), (4, -50, 0)]),
    ]);
    let found = crossings(&network, &chains, &distance_m);
    assert_eq!(found.left_out, [1]);
    let ways: Vec<[i64; 2]> =
        found.all.iter().map(|own| [own.upper.way_id, own.lower.way_id]).collect();
    assert_eq!(ways, [[3, 2]]);
}
