//! Spans consist of connected chains, and are carried where they end on something.

use corniche_roads::Structure::{Bridge, Ground, Tunnel};

use crate::{
    SpanReason::{self, GroundWayOnDeck, KindChange, NoSupport, OneSupport, OpenEnd},
    Spans, Support,
    network_tests::{Way, distance_m, network, way},
};

/// The number of spans, the supports by node id, and the reasons with their ways.
type Found = (usize, Vec<(i64, Option<Support>)>, Vec<(SpanReason, i64)>);

fn found(ways: &[Way<'_>]) -> Found {
    let (network, chains) = network(ways);
    let spans = Spans::find(&network, &chains, &distance_m);
    let mut joints: Vec<(i64, Option<Support>)> = spans
        .joints
        .iter()
        .map(|joint| (network.node_id(joint.node).unwrap(), joint.support))
        .collect();
    joints.sort_by_key(|(id, _)| *id);
    let mut problems: Vec<(SpanReason, i64)> = spans
        .problems(&vec![false; spans.joints.len()])
        .iter()
        .map(|problem| (problem.reason, problem.way_id))
        .collect();
    problems.sort_unstable();
    (spans.len(), joints, problems)
}

const ON_GROUND: Option<Support> = Some(Support::Ground);

#[test]
fn a_bridge_of_several_ways_is_one_span_however_they_are_split_and_turned() {
    let all = [(1, 0, 0), (2, 100, 0), (3, 150, 0), (4, 200, 0), (5, 300, 0)];
    let [before, after] = [way(1, Ground, &all[..2]), way(9, Ground, &all[3..])];
    let whole = found(&[before, way(2, Bridge, &all[1..4]), after]);
    assert_eq!(whole, (1, vec![(2, ON_GROUND), (4, ON_GROUND)], vec![]));
    let turned: Vec<_> = all[2..4].iter().rev().copied().collect();
    let [before, after] = [way(1, Ground, &all[..2]), way(9, Ground, &all[3..])];
    assert_eq!(found(&[before, way(2, Bridge, &all[1..3]), way(3, Bridge, &turned), after]), whole);
}

#[test]
fn a_way_that_touches_a_deck_carries_nothing_but_where_the_deck_ends() {
    // Steps meet the deck at 3; at 5, two decks meet and end.
    let ways = [
        way(1, Ground, &[(1, 0, 0), (2, 100, 0)]),
        way(2, Bridge, &[(2, 100, 0), (3, 150, 0), (5, 300, 0)]),
        way(3, Ground, &[(3, 150, 0), (7, 150, 50)]),
        way(4, Bridge, &[(8, 100, 20), (5, 300, 0)]),
        way(5, Ground, &[(5, 300, 0), (6, 400, 0)]),
        way(6, Ground, &[(8, 100, 20), (9, 0, 20)]),
    ];
    let joints = vec![(2, ON_GROUND), (3, None), (5, ON_GROUND), (8, ON_GROUND)];
    assert_eq!(found(&ways), (1, joints, vec![(GroundWayOnDeck, 2)]));
}

/// A street that passes between two bridges is on the ground and carries both.
#[test]
fn a_street_between_two_bridges_carries_them() {
    let ways = [
        way(1, Ground, &[(1, 0, 0), (2, 100, 0)]),
        way(2, Bridge, &[(2, 100, 0), (3, 150, 0), (4, 200, 0)]),
        way(3, Ground, &[(4, 200, 0), (5, 300, 0)]),
        way(4, Ground, &[(6, 150, -50), (3, 150, 0), (7, 150, 50)]),
    ];
    assert_eq!(found(&ways), (1, vec![(2, ON_GROUND), (3, ON_GROUND), (4, ON_GROUND)], vec![]));
}

#[test]
fn ends_where_nothing_goes_on_carry_bridges_and_leave_tunnels_free() {
    let ways = [
        way(1, Ground, &[(1, 0, 0), (2, 100, 0)]),
        way(2, Bridge, &[(2, 100, 0), (3, 200, 0)]),
        way(4, Ground, &[(11, 0, 500), (12, 100, 500)]),
        way(5, Tunnel, &[(12, 100, 500), (13, 200, 500)]),
        way(7, Tunnel, &[(21, 0, 900), (22, 200, 900)]),
    ];
    let joints = vec![
        (2, ON_GROUND),
        (3, Some(Support::OpenEnd)),
        (12, ON_GROUND),
        (13, None),
        (21, None),
        (22, None),
    ];
    assert_eq!(found(&ways), (3, joints, vec![(NoSupport, 7), (OneSupport, 5), (OpenEnd, 2)]));
}

#[test]
fn a_bridge_that_goes_on_as_a_tunnel_is_carried_there() {
    let ways = [
        way(1, Ground, &[(1, 0, 0), (2, 100, 0)]),
        way(2, Bridge, &[(2, 100, 0), (3, 200, 0)]),
        way(3, Tunnel, &[(3, 200, 0), (4, 300, 0)]),
        way(4, Ground, &[(4, 300, 0), (5, 400, 0)]),
    ];
    let other = Some(Support::OtherKind);
    let joints = vec![(2, ON_GROUND), (3, other), (3, other), (4, ON_GROUND)];
    assert_eq!(found(&ways), (2, joints, vec![(KindChange, 2), (KindChange, 3)]));
}
