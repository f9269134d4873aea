//! Decks between supports, lifts at crossings, and the problems reported for them.

use corniche_roads::Structure::{Bridge, Ground, Tunnel};
use proptest::prelude::*;

use super::*;
use crate::{
    SpanReason::{GradeOverLimit, LayerTie, NoGround, OrderUnreachable},
    network_tests::{Way, at, solved, way},
};

/// Returns a bridge of 200 m over a gorge, and a road beneath it at a distance from the bridge's
/// beginning.
fn over_gorge(crossed_at: i64) -> [Way<'static>; 4] {
    [
        way(1, Ground, &[(1, -50, 0), (2, 0, 0)]),
        way(2, Bridge, &[(2, 0, 0), (3, 200, 0)]),
        way(3, Ground, &[(3, 200, 0), (4, 250, 0)]),
        way(4, Ground, &[(5, crossed_at, -50), (6, crossed_at, 50)]),
    ]
}

#[test]
fn a_deck_is_straight_between_its_ends_and_its_free_height_is_told() {
    let ground = |[east, _]: [f64; 2]| {
        Some(if east <= 0.0 {
            500.0
        } else if east >= 200.0 {
            510.0
        } else {
            420.0
        })
    };
    solved(&over_gorge(40), ground, |decks, network, chains| {
        for (along_m, expected) in [(0.0, 500.0), (40.0, 502.0), (200.0, 510.0)] {
            assert!((at(decks, network, chains, 2, along_m) - expected).abs() < 1e-9);
        }
        let [FreeHeight { free_m: Some(free_m), .. }] = decks.free_heights() else { panic!() };
        assert!((free_m - 82.0).abs() < 1e-9);
        assert!(decks.problems(&|_| true).is_empty());
    });
}

/// On flat ground, a bridge over a road is lifted to a metre, as a tent to the nearest support and
/// not beyond.
#[test]
fn a_lift_is_a_tent_with_its_apex_over_the_crossing() {
    solved(
        &over_gorge(80),
        |_| Some(100.0),
        |decks, network, chains| {
            let expected = [
                (0.0, 100.0),
                (40.0, 100.5),
                (80.0, 101.0),
                (120.0, 100.5),
                (160.0, 100.0),
                (200.0, 100.0),
            ];
            for (along_m, expected) in expected {
                let found = at(decks, network, chains, 2, along_m);
                assert!((found - expected).abs() < 1e-9, "{along_m}: {found}");
            }
            assert!(decks.problems(&|_| true).is_empty());
        },
    );
}

/// Near a support the flank would be too steep. A secondary road may have 12 %, so 3 m away 0.36 m
/// are created, and a metre away the minimum.
#[test]
fn a_lift_is_no_steeper_than_its_class_but_never_less_than_the_least() {
    for (from_m, expected) in [(3, 100.36), (1, 100.3)] {
        solved(
            &over_gorge(from_m),
            |_| Some(100.0),
            |decks, network, chains| {
                let found = at(decks, network, chains, 2, from_m as f64);
                assert!((found - expected).abs() < 1e-9, "{found}");
                let problems: Vec<_> =
                    decks.problems(&|_| true).iter().map(|problem| problem.reason).collect();
                assert_eq!(problems, [OrderUnreachable]);
            },
        );
    }
}

/// Three bridges of layers 1 to 3 cross each other, each a metre above the one below.
#[test]
fn stacked_bridges_are_lifted_from_below() {
    let bridge = |id: i64, layer: i8, [east, north]: [i64; 2]| {
        let nodes = [(10 * id, -east, -north), (10 * id + 1, east, north)];
        let end = |which: usize, k: i64| {
            let (node, east, north) = nodes[which];
            way(
                100 * id + k,
                Ground,
                &[(node, east, north), (10 * id + 5 + k, 2 * east, 2 * north)],
            )
        };
        [Way { layer, ..way(id, Bridge, &nodes) }, end(0, 1), end(1, 2)]
    };
    let mut ways: Vec<Way<'_>> = [(3, 3, [100, 0]), (4, 2, [0, 100]), (5, 1, [100, 100])]
        .into_iter()
        .flat_map(|(id, layer, end)| bridge(id, layer, end))
        .collect();
    ways.push(way(9, Ground, &[(91, -100, 90), (92, 100, -90)]));
    ways.sort_by_key(|way| way.id);
    solved(
        &ways,
        |_| Some(0.0),
        |decks, network, chains| {
            let heights = [5, 4, 3].map(|id| {
                let middle_m = if id == 5 { 100.0 * 2.0_f64.sqrt() } else { 100.0 };
                at(decks, network, chains, id, middle_m)
            });
            for (found, expected) in heights.iter().zip([1.0, 2.0, 3.0]) {
                assert!((found - expected).abs() < 1e-6, "{heights:?}");
            }
            assert!(decks.problems(&|_| true).is_empty(), "{:?}", decks.problems(&|_| true));
            assert_eq!(decks.free_heights().len(), 6);
        },
    );
}

#[test]
fn tunnels_are_lowered_beneath_roads() {
    let mut ways = over_gorge(100);
    ways[1].structure = Tunnel;
    solved(
        &ways,
        |_| Some(50.0),
        |decks, network, chains| {
            assert!((at(decks, network, chains, 2, 100.0) - 49.0).abs() < 1e-9);
            assert!((at(decks, network, chains, 2, 50.0) - 49.5).abs() < 1e-9);
        },
    );
}

/// A secondary road may have 12 %, a service road 20 %.
#[test]
fn decks_steeper_than_their_class_are_told() {
    let mut ways = over_gorge(100);
    let ground = |[east, _]: [f64; 2]| {
        Some(if east <= 0.0 {
            0.0
        } else if east >= 200.0 {
            30.0
        } else {
            -50.0
        })
    };
    for (highway, expected) in [("secondary", &[GradeOverLimit][..]), ("service", &[])] {
        ways[1].highway = highway;
        solved(&ways, ground, |decks, _, _| {
            let reasons: Vec<_> =
                decks.problems(&|_| true).iter().map(|problem| problem.reason).collect();
            assert_eq!(reasons, expected);
        });
    }
}

#[test]
fn ties_and_missing_ground_are_told() {
    let mut ways = over_gorge(100);
    ways[3].structure = Bridge;
    solved(
        &ways,
        |[east, _]| (east < 150.0).then_some(7.0),
        |decks, network, chains| {
            assert!((at(decks, network, chains, 2, 200.0) - 7.0).abs() < 1e-9);
            let reasons: Vec<_> =
                decks.problems(&|_| true).iter().map(|problem| problem.reason).collect();
            assert!(reasons.contains(&LayerTie) && reasons.contains(&NoGround), "{reasons:?}");
        },
    );
}

proptest! {
    /// Splitting and turning ways, and adding a constant to the ground, changes nothing else.
    #[test]
    fn decks_do_not_depend_on_how_ways_are_split_or_turned(
        bridge in prop::collection::vec((1..60_i64, -40..40_i64), 2..7),
        cut in any::<prop::sample::Index>(),
        is_turned in any::<bool>(),
        crossed_at in 5..50_i64,
        more_m in -100.0_f64..100.0,
        slope in -0.1_f64..0.1,
    ) {
        let mut east = 0;
        let nodes: Vec<(i64, i64, i64)> = (10..)
            .zip(&bridge)
            .map(|(id, &(run, north))| { east += run; (id, east, north) })
            .collect();
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        let grounds = || [
            way(1, Ground, &[(1, first.1 - 50, first.2), first]),
            way(8, Ground, &[last, (2, last.1 + 50, last.2)]),
            way(9, Ground, &[(3, first.1 + crossed_at, -1000), (4, first.1 + crossed_at, 1000)]),
        ];
        let [one, two, three] = grounds();
        let whole = [one, way(2, Bridge, &nodes), two, three];
        let at_cut = cut.index(nodes.len());
        let mut parts: Vec<Vec<(i64, i64, i64)>> = vec![nodes.clone()];
        if at_cut > 0 && at_cut + 1 < nodes.len() {
            parts = vec![nodes[..=at_cut].to_vec(), nodes[at_cut..].to_vec()];
        }
        if is_turned {
            for part in &mut parts {
                part.reverse();
            }
        }
        let [one, two, three] = grounds();
        let mut split = vec![one];
        split.extend((2..).zip(&parts).map(|(id, part)| way(id, Bridge, part)));
        split.extend([two, three]);
        let ground = move |[east, north]: [f64; 2]| Some(300.0 + slope * east + (north / 9.0).sin());
        let heights = |ways: &[Way<'_>], more_m: f64| {
            solved(ways, |at| ground(at).map(|own_m| own_m + more_m), |decks, network, chains| {
                let (chain, _) = chains.of_road(&network.ways()[network.roads_of(2).start]).next().unwrap();
                let length_m = decks.spans.edges[decks.spans.edge_of(chain).unwrap()].length_m;
                let mut all: Vec<f64> =
                    (0..=20).map(|k| decks.height_m(chain, length_m * f64::from(k) / 20.0).unwrap()).collect();
                // A chain begins at the smaller of its nodes.
                if all.first().unwrap().to_bits() != (ground([first.1 as f64, first.2 as f64]).unwrap() + more_m).to_bits() {
                    all.reverse();
                }
                all
            })
        };
        let expected = heights(&whole, 0.0);
        for (found, expected) in heights(&split, 0.0).iter().zip(&expected) {
            prop_assert!((found - expected).abs() < 1e-9);
        }
        for (found, expected) in heights(&whole, more_m).iter().zip(&expected) {
            prop_assert!((found - expected - more_m).abs() < 1e-9);
        }
    }
}

/// A bridge over a tunnel at the same height keeps its free height: the tunnel goes down.
#[test]
fn a_tunnel_is_lowered_beneath_a_bridge() {
    let mut ways = over_gorge(100).to_vec();
    ways[3] = way(4, Tunnel, &[(5, 100, -50), (6, 100, 50)]);
    ways.push(way(5, Ground, &[(7, 100, -90), (5, 100, -50)]));
    ways.push(way(6, Ground, &[(6, 100, 50), (8, 100, 90)]));
    solved(
        &ways,
        |_| Some(100.0),
        |decks, network, chains| {
            assert!((at(decks, network, chains, 2, 100.0) - 100.0).abs() < 1e-9);
            assert!((at(decks, network, chains, 4, 50.0) - 99.0).abs() < 1e-9);
            assert!(decks.problems(&|_| true).is_empty(), "{:?}", decks.problems(&|_| true));
        },
    );
}

/// Along a stretch that both share, the deck is a metre above the road everywhere, and one crossing
/// is reported.
#[test]
fn a_deck_clears_the_whole_stretch_that_it_shares_with_a_road() {
    let mut ways = over_gorge(100).to_vec();
    ways[3] = way(4, Ground, &[(5, 40, -50), (6, 60, 0), (7, 140, 0), (8, 160, 50)]);
    solved(
        &ways,
        |_| Some(100.0),
        |decks, network, chains| {
            for (along_m, expected) in
                [(0, 100.0), (30, 100.5), (60, 101.0), (100, 101.0), (140, 101.0)]
            {
                let found = at(decks, network, chains, 2, f64::from(along_m));
                assert!((found - expected).abs() < 1e-9, "{along_m}: {found}");
            }
            let [FreeHeight { free_m: Some(free_m), .. }] = decks.free_heights() else { panic!() };
            assert!((free_m - 1.0).abs() < 1e-9);
            assert!(decks.problems(&|_| true).is_empty(), "{:?}", decks.problems(&|_| true));
        },
    );
}

proptest! {
    /// Flanks as steep as the class allows are not reported as too steep, whatever the rounding
    /// errors.
    #[test]
    fn lifts_are_not_told_as_too_steep(
        crossed_at in 11..30_i64,
        base_m in 0.0_f64..4000.0,
        slope in -0.09_f64..0.09,
    ) {
        let ground = move |[east, _]: [f64; 2]| Some(base_m + slope * east);
        solved(&over_gorge(crossed_at), ground, |decks, _, _| {
            let is_told = decks.problems(&|_| true).iter().any(|problem| problem.reason == GradeOverLimit);
            prop_assert!(!is_told, "{:?}", decks.problems(&|_| true));
            Ok(())
        })?;
    }
}
