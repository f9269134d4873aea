//! Crossings are found where lines cross without a common node, in the right order.

use corniche_roads::Structure::{self, Bridge, Ground, Tunnel};

use super::*;
use crate::test_network::{Way, distance_m, network, way};

/// Upper way, lower way, whether the order is known, and the place in metres.
fn found(ways: &[Way<'_>]) -> Vec<(i64, i64, bool, [i64; 2])> {
    let (network, chains) = network(ways);
    let mut found: Vec<_> = crossings(&network, &chains, &distance_m)
        .unwrap()
        .into_iter()
        .map(|Crossing { at, upper, lower, order }| {
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
    // A bridge without a layer counts as one of layer 1.
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

/// A road that passes through a point of a bridge, which is no node of it, crosses once; one that has the node does not cross.
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
    let found = crossings(&network, &chains, &distance_m).unwrap();
    let [Crossing { upper, lower, .. }] = found[..] else { panic!("{found:?}") };
    let is = |along_m: f64, expected: f64| (along_m - expected).abs() < 1e-9;
    assert!(is(upper.along_m, 120.0) && is(lower.along_m, 0.0), "{upper:?} {lower:?}");
}
