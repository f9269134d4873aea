//! Ways that no road can be, and roads that look a little like them.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    reason = "a test may unwrap; places that meet are the same"
)]

use corniche_geom::{LatticePoint, Polyline};
use corniche_testing::Random;

use super::{go_to_and_fro, length_of, strips};

const SIDE: i64 = 1000;

fn line(points: impl Iterator<Item = [i64; 2]>) -> Polyline {
    Polyline::new(points.map(|[u, v]| LatticePoint::new(u, v)).collect()).unwrap()
}

fn goes_to_and_fro(line: &Polyline, side: i64) -> bool {
    go_to_and_fro(&[line], side)
}

/// Returns a way that goes `legs` times from one end of a square to the other, each time a step
/// next to the last.
fn zigzag(legs: i64, at: [i64; 2]) -> Polyline {
    line(
        (0..=legs).map(|k| [at[0] + if k % 2 == 0 { 0 } else { SIDE - 2 }, at[1] + k % (SIDE - 1)]),
    )
}

#[test]
fn a_square_may_be_crossed_so_often() {
    for at in [[0, 0], [-5 * SIDE, 3 * SIDE], [7_000_000_000 * SIDE, 0]] {
        assert!(!goes_to_and_fro(&zigzag(250, at), SIDE), "{at:?}");
        assert!(goes_to_and_fro(&zigzag(260, at), SIDE), "{at:?}");
        assert!(goes_to_and_fro(&zigzag(1_000_000, at), SIDE), "{at:?}");
    }
}

/// Long ways, ways of many nodes, and a way with a misplaced node are roads.
#[test]
fn long_roads_do_not() {
    let straight = line((0..100_000).map(|k| [3 * k, 2 * k]));
    let around = line((0..100_000).map(|k| [k * SIDE, (k % 7) * SIDE / 3]));
    let misplaced = line([[0, 0], [50_000 * SIDE, 200_000 * SIDE], [20, 0]].into_iter());
    // The road goes up a slope, in bends that are a tenth of a square apart, over ten squares.
    let bends = line((0..2000).map(|k| [if k % 2 == 0 { 0 } else { 10 * SIDE }, k * SIDE / 10]));
    for road in [straight, around, misplaced, bends] {
        assert!(!goes_to_and_fro(&road, SIDE));
    }
    let endless = line((0..2000).map(|k| [0, if k % 2 == 0 { 0 } else { 1000 * SIDE }]));
    assert!(goes_to_and_fro(&endless, SIDE), "the same way a thousand times");
    let far = line((0..2000).map(|k| [if k % 2 == 0 { -9000 } else { 9000 } * SIDE, k * SIDE]));
    assert!(goes_to_and_fro(&far, SIDE), "longer than anything on earth");
}

/// A way that gaps divide into several roads still counts as one way.
#[test]
fn parts_of_a_way_count_together() {
    let parts: Vec<Polyline> = (0..30).map(|_| zigzag(100, [0, 0])).collect();
    let parts: Vec<&Polyline> = parts.iter().collect();
    assert!(!go_to_and_fro(&parts[..2], SIDE) && go_to_and_fro(&parts, SIDE));
}

/// The parts of a segment are in their strips, meet, and together are as long as the segment.
#[test]
fn strips_add_up() {
    let mut random = Random::new(3);
    let mut coordinate = || (random.share() - 0.5) * 20_000.0;
    for _ in 0..1000 {
        let segment = [[coordinate(), coordinate()], [coordinate(), coordinate()]];
        for axis in [0, 1] {
            let parts: Vec<_> = strips(segment, axis, 1000.0).collect();
            let sum: f64 = parts.iter().map(|&(_, part)| length_of(part)).sum();
            assert!((sum - length_of(segment)).abs() < 1e-6, "{segment:?}");
            for &(strip, part) in &parts {
                let [low, high] = [strip, strip + 1].map(|strip| strip as f64 * 1000.0);
                assert!(part.iter().all(|at| (low..=high).contains(&at[axis])), "{segment:?}");
            }
            let meet =
                |pair: &[(i64, [[f64; 2]; 2])]| length_of([pair[0].1[1], pair[1].1[0]]) == 0.0;
            assert!(parts.windows(2).all(meet), "{segment:?}");
        }
    }
}
