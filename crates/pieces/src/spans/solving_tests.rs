//! A tile holds a limited number of points of bridges and tunnels, and the longest way is skipped
//! first.

use corniche_geom::LatticePoint;
use corniche_roads::{FunctionalRoadClass, Structure};
use corniche_tileset::{RunOwner, SpanHeight, SpanPoint};

use super::*;

fn run(way_id: i64, points: usize) -> SpanRun {
    let point =
        |k: usize| SpanPoint { at: LatticePoint::new(k as i64, 0), height: SpanHeight::Steps(1) };
    SpanRun {
        way_id,
        owner: RunOwner::Road(FunctionalRoadClass::new(3).unwrap()),
        structure: Structure::Bridge,
        points: (0..points).map(point).collect(),
    }
}

#[test]
fn the_longest_ways_are_left_out_until_the_rest_fits() {
    let ways = |runs: &[SpanRun]| runs.iter().map(|run| run.way_id).collect::<Vec<_>>();
    let mut few = vec![run(1, 2), run(2, 300), run(2, 5)];
    assert_eq!((left_out(&mut few).count(), ways(&few)), (0, vec![1, 2, 2]));
    let half = MAX_SPAN_POINTS / 2;
    let mut full = vec![run(1, half), run(2, half)];
    assert_eq!(left_out(&mut full).count(), 0);
    // The second way has the most points, in two runs.
    let mut many = vec![run(1, 7), run(2, half), run(3, half + 1), run(2, half)];
    assert_eq!((left_out(&mut many).collect::<Vec<_>>(), ways(&many)), (vec![2], vec![1, 3]));
}
