//! The right supports are refused on networks whose line without these supports is known.

use corniche_roads::Structure::{Bridge, Ground};
use proptest::prelude::*;

use crate::{
    SpanReason::{self, GroundWayOnDeck},
    network_tests::{Way, at, solved, way},
};

/// Returns a motorway viaduct of 1000 m, at 600 m above sea level at both ends, with nodes of
/// streets in the valley at distances from its first node.
fn viaduct(streets: &[i64]) -> Vec<Way<'static>> {
    let mut deck = vec![(1, 0, 0)];
    deck.extend((10..).zip(streets).map(|(id, &east)| (id, east, 0)));
    deck.push((2, 1000, 0));
    let mut ways = vec![
        way(1, Ground, &[(3, -200, 0), (1, 0, 0)]),
        way(2, Bridge, &deck),
        way(3, Ground, &[(2, 1000, 0), (4, 1200, 0)]),
    ];
    ways.extend((10..).zip(streets).map(|(id, &east)| {
        way(id, Ground, &[(100 + id, east, -200), (id, east, 0), (200 + id, east, 200)])
    }));
    for way in &mut ways[..3] {
        way.highway = "motorway";
    }
    ways
}

/// Returns the ground: the height of the ends, and a valley between them.
fn valley(depth_m: f64) -> impl Fn([f64; 2]) -> Option<f64> + Copy {
    move |[east, _]: [f64; 2]| {
        Some(if east <= 0.0 || east >= 1000.0 { 600.0 } else { 600.0 - depth_m })
    }
}

/// The heights of way 2 every hundred metres, and the reasons with their ways and nodes.
type Found = (Vec<f64>, Vec<(SpanReason, i64, Option<i64>)>);

fn found(ways: &[Way<'_>], ground: impl Fn([f64; 2]) -> Option<f64>) -> Found {
    solved(ways, ground, |decks, network, chains| {
        let way = &network.ways()[network.roads_of(2).start];
        let mut heights_m = Vec::new();
        for (chain, index) in chains.of_road(way) {
            let edge = decks.spans().edge_of(chain).unwrap();
            let length_m = decks.spans().edges[edge].length_m;
            let is_against = chains.get(chain).links[index].is_against;
            let count = (length_m / 100.0).round() as i32;
            for k in 0..=count {
                let share = f64::from(if is_against { count - k } else { k }) / f64::from(count);
                heights_m.push(decks.height_m(chain, share * length_m).unwrap());
            }
        }
        let problem =
            |problem: &crate::SpanProblem| (problem.reason, problem.way_id, problem.node_id);
        (heights_m, decks.problems(&|_| true).iter().map(problem).collect())
    })
}

#[test]
fn a_street_in_the_valley_that_shares_a_node_with_a_viaduct_does_not_carry_it() {
    let (heights_m, problems) = found(&viaduct(&[500]), valley(60.0));
    assert!(heights_m.iter().all(|height_m| (height_m - 600.0).abs() < 1e-9), "{heights_m:?}");
    assert_eq!(problems, [(GroundWayOnDeck, 2, Some(10))]);
}

/// Several streets are refused one after the other: the next one holds the line down until it is
/// refused, too.
#[test]
fn streets_beside_each_other_are_refused_one_after_the_other() {
    for streets in [&[500, 550][..], &[300, 350, 400, 700], &[100, 200, 300, 400, 500, 600, 900]] {
        let (heights_m, problems) = found(&viaduct(streets), valley(60.0));
        assert!(heights_m.iter().all(|height_m| (height_m - 600.0).abs() < 1e-9), "{heights_m:?}");
        let nodes: Vec<_> = (10..).take(streets.len()).map(Some).collect();
        assert_eq!(problems.iter().map(|(.., node)| *node).collect::<Vec<_>>(), nodes);
    }
}

/// The grade that a motorway climbs, 6 %, decides: 400 m from the nearer end, a street may be 24 m
/// away from the line, and no more.
#[test]
fn a_support_counts_up_to_the_grade_that_its_road_is_built_with() {
    for (depth_m, is_refused) in [(23.9, false), (24.1, true)] {
        let (heights_m, problems) = found(&viaduct(&[400]), valley(depth_m));
        let expected = if is_refused { 600.0 } else { 600.0 - depth_m };
        assert!((heights_m[4] - expected).abs() < 1e-9, "{heights_m:?}");
        assert_eq!(problems.iter().any(|own| own.0 == GroundWayOnDeck), is_refused);
    }
    // A residential street climbs 15 %.
    let mut ways = viaduct(&[400]);
    ways[1].highway = "residential";
    assert!((found(&ways, valley(59.0)).0[4] - 541.0).abs() < 1e-9);
    assert!((found(&ways, valley(61.0)).0[4] - 600.0).abs() < 1e-9);
}

/// An end in the valley stays an end.
#[test]
fn ends_are_never_refused() {
    let ground = |[east, _]: [f64; 2]| Some(if east < 1000.0 { 600.0 } else { 500.0 });
    let (heights_m, problems) = found(&viaduct(&[]), ground);
    assert!((heights_m[10] - 500.0).abs() < 1e-9);
    assert_eq!(problems, [(SpanReason::GradeOverLimit, 2, None)]);
}

/// A ring on a bridge over a cutting has no end: the roads that touch it carry it, except for one
/// in the cutting.
#[test]
fn a_ring_is_carried_by_the_roads_that_touch_it() {
    let ring = [
        (1, 30, 0),
        (2, 21, 21),
        (3, 0, 30),
        (4, -21, 21),
        (5, -30, 0),
        (6, -21, -21),
        (7, 0, -30),
        (8, 21, -21),
    ];
    let mut nodes = ring.to_vec();
    nodes.push(ring[0]);
    let cutting = |[_, north]: [f64; 2]| Some(if north.abs() < 20.0 { 94.0 } else { 100.0 });
    let mut ways = vec![
        way(2, Bridge, &nodes),
        way(3, Ground, &[(3, 0, 30), (9, 0, 200)]),
        way(4, Ground, &[(7, 0, -30), (10, 0, -200)]),
        way(5, Ground, &[(11, -300, 1), (12, 300, 1)]),
    ];
    let is_level = |(heights_m, problems): &Found, nodes: &[i64]| {
        let nodes: Vec<_> = nodes.iter().map(|&id| (GroundWayOnDeck, 2, Some(id))).collect();
        assert!(heights_m.iter().all(|height_m| (height_m - 100.0).abs() < 1e-9), "{heights_m:?}");
        assert_eq!(*problems, nodes);
    };
    is_level(&found(&ways, cutting), &[]);
    // One road leaves in the cutting, where the road beneath passes.
    ways.push(way(6, Ground, &[(1, 30, 0), (13, 100, 0)]));
    is_level(&found(&ways, cutting), &[1]);
    // A single road also carries the ring.
    ways.truncate(2);
    let (heights_m, problems) = found(&ways, cutting);
    assert!(heights_m.iter().all(|height_m| (height_m - 100.0).abs() < 1e-9), "{heights_m:?}");
    assert_eq!(problems, [(SpanReason::OneSupport, 2, None)]);
}

/// If only two roads touch a ring, each is equally far from the other: the one with the smaller
/// node is refused, whichever way comes first.
#[test]
fn of_two_that_are_as_far_off_the_node_decides() {
    let corners = [(21, 0, 0), (22, 50, 0), (23, 100, 0), (24, 100, 50), (25, 100, 100)];
    let ring = [&corners[..], &[(26, 0, 100), corners[0]]].concat();
    for ids in [[3, 4], [4, 3]] {
        let mut ways = vec![
            way(2, Bridge, &ring),
            way(ids[0], Ground, &[(22, 50, 0), (31, 50, -50)]),
            way(ids[1], Ground, &[(24, 100, 50), (32, 150, 50)]),
        ];
        ways.sort_by_key(|way| way.id);
        let ground = |[_, north]: [f64; 2]| Some(if north < 1.0 { 50.0 } else { 100.0 });
        let (heights_m, problems) = found(&ways, ground);
        assert!(heights_m.iter().all(|height_m| (height_m - 100.0).abs() < 1e-9), "{heights_m:?}");
        assert!(problems.contains(&(GroundWayOnDeck, 2, Some(22))), "{problems:?}");
    }
}

/// Decks on coarse levels have the supports of the finest.
#[test]
fn a_support_that_is_refused_carries_on_no_level() {
    solved(&viaduct(&[500]), valley(60.0), |decks, network, chains| {
        let grounds_m: Vec<_> = decks.spans().joints().iter().map(|_| Some(570.0)).collect();
        let heights_m = at(&decks.on(&grounds_m), network, chains, 2, 250.0);
        assert!((heights_m - 570.0).abs() < 1e-9);
        assert_eq!(decks.supports().count(), 2);
    });
}

/// Thousands of streets meet a star of decks, which no real span does, but a hostile file can
/// contain. The work is proportional to their number.
#[test]
fn thousands_of_streets_take_no_longer_than_their_number() {
    let count = 3000_i64;
    let arms = (0..count).map(|k| {
        let node = (10 + k, 1000 + k, k);
        way(10 + 2 * k, Bridge, &[(1, 0, 0), node, (100_000 + k, 2000 + k, k)])
    });
    let streets = (0..count).map(|k| {
        let street = [
            (200_000 + k, 1000 + k, k - 90),
            (10 + k, 1000 + k, k),
            (300_000 + k, 1000 + k, k + 90),
        ];
        way(11 + 2 * k, Ground, &street)
    });
    let mut ways: Vec<Way<'_>> = arms.chain(streets).collect();
    ways.sort_by_key(|way| way.id);
    let ground =
        |[east, _]: [f64; 2]| Some(if (999.0..1999.0).contains(&east) { 0.0 } else { 500.0 });
    let reasons = solved(&ways, ground, |decks, _, _| {
        decks.problems(&|_| true).iter().map(|problem| problem.reason).collect::<Vec<_>>()
    });
    assert!(reasons.contains(&SpanReason::TooIntricate));
}

proptest! {
    /// Which supports are refused does not depend on the order, the direction, the splitting or the
    /// ids of ways.
    #[test]
    fn order_and_splitting_decide_nothing(
        streets in prop::collection::btree_set(1..40_i64, 1..6),
        depths in prop::collection::vec(0.0_f64..60.0, 40),
        cut in any::<prop::sample::Index>(),
        is_turned in any::<bool>(),
        more in 0..40_i64,
    ) {
        let streets: Vec<i64> = streets.into_iter().map(|street| 25 * street - 10).collect();
        let ground = |[east, _]: [f64; 2]| {
            let at = (east / 25.0).floor();
            Some(if (0.0..40.0).contains(&at) && east > 0.0 { 600.0 - depths[at as usize] } else { 600.0 })
        };
        let nodes_refused = |ways: &[Way<'_>]| {
            let (_, problems) = found(ways, ground);
            let refused = problems.into_iter().filter(|own| own.0 == GroundWayOnDeck);
            let mut nodes: Vec<_> = refused.map(|(.., node)| node).collect();
            nodes.sort_unstable();
            nodes
        };
        let whole = viaduct(&streets);
        let expected = nodes_refused(&whole);
        let mut others = viaduct(&streets);
        let deck = others.remove(1);
        let at = 1 + cut.index(deck.nodes.len() - 2);
        let mut parts = [deck.nodes[..=at].to_vec(), deck.nodes[at..].to_vec()];
        if is_turned {
            for part in &mut parts {
                part.reverse();
            }
        }
        let ids = [2, 100 + more];
        others.extend(ids.into_iter().zip(&parts).map(|(id, nodes)| {
            Way { highway: "motorway", ..way(id, Bridge, nodes) }
        }));
        for other in &mut others {
            other.id = if other.id == 2 { 2 } else { 3 + (other.id + more) * 7 % 1009 };
        }
        others.sort_by_key(|way| way.id);
        prop_assert_eq!(nodes_refused(&others), expected);
    }
}
