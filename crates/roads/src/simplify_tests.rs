//! Simplified lines stay within their tolerance and keep fixed points.

use super::*;
use crate::{FunctionalRoadClass, MetNodes, Road, RoadAttributes};
use proptest::{collection::vec, prelude::*};

fn road(points: Vec<LatticePoint>, inner_fixed: &[u32]) -> Option<Road> {
    let line = Polyline::new(points).ok()?;
    let last = line.points().len() as u32 - 1;
    let mut fixed: Vec<u32> = inner_fixed.iter().copied().filter(|&i| i > 0 && i < last).collect();
    fixed.extend([0, last]);
    fixed.sort_unstable();
    fixed.dedup();
    Some(Road {
        way_id: 1,
        class: FunctionalRoadClass::new(0).unwrap(),
        attributes: RoadAttributes::default(),
        line,
        fixed,
        node_ids: Vec::new(),
        same_places: Vec::new(),
        met: MetNodes::default(),
    })
}

fn simplified(road: &Road, tolerance_steps: f64) -> Polyline {
    simplify(&road.line, &road.fixed, tolerance_steps)
}

fn line(points: &[(i64, i64)], inner_fixed: &[u32]) -> Road {
    road(points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect(), inner_fixed).unwrap()
}

#[track_caller]
fn check(
    points: &[(i64, i64)],
    inner_fixed: &[u32],
    tolerance_steps: f64,
    expected: &[(i64, i64)],
) {
    let thin = simplified(&line(points, inner_fixed), tolerance_steps);
    let thin: Vec<(i64, i64)> = thin.points().iter().map(|p| (p.u, p.v)).collect();
    assert_eq!(thin, expected);
}

#[test]
fn drops_points_within_the_tolerance_and_no_others() {
    check(&[(0, 0), (50, 3), (100, 0)], &[], 3.0, &[(0, 0), (100, 0)]);
    check(&[(0, 0), (50, 3), (100, 0)], &[], 2.999, &[(0, 0), (50, 3), (100, 0)]);
    check(&[(0, 0), (50, 0), (100, 0)], &[], 1e-9, &[(0, 0), (100, 0)]);
}

#[test]
fn zero_and_senseless_tolerances_keep_every_point() {
    let points = [(0, 0), (50, 0), (100, 0)];
    for tolerance_steps in [0.0, -1.0, f64::NAN] {
        check(&points, &[], tolerance_steps, &points);
    }
    check(&points, &[], f64::INFINITY, &[(0, 0), (100, 0)]);
}

#[test]
fn measures_to_the_segment_where_a_line_overshoots() {
    // Measured to the infinite line through both ends, no point is far away; past the end, one is
    // 40 steps away.
    check(&[(0, 0), (140, 0), (100, 0)], &[], 10.0, &[(0, 0), (140, 0), (100, 0)]);
    check(&[(0, 0), (140, 0), (100, 0)], &[], 40.0, &[(0, 0), (100, 0)]);
}

#[test]
fn fixed_points_are_kept() {
    check(&[(0, 0), (25, 0), (50, 0), (100, 0)], &[2], 9.0, &[(0, 0), (50, 0), (100, 0)]);
}

#[test]
fn a_ring_never_vanishes() {
    let ring = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0)];
    check(&ring, &[], 1e9, &[(0, 0), (10, 10), (0, 0)]);
    check(&ring, &[], 5.0, &ring);
    // The shape is a lollipop whose ring is between two visits of one junction.
    let lollipop = [(-100, 0), (0, 0), (5, 5), (9, 0), (5, -5), (0, 0)];
    check(&lollipop, &[1], 50.0, &[(-100, 0), (0, 0), (9, 0), (0, 0)]);
}

#[test]
fn stays_right_for_country_long_segments() {
    let far = 1_i64 << 44;
    check(&[(0, 0), (far / 2, 2), (far, 0)], &[], 1.5, &[(0, 0), (far / 2, 2), (far, 0)]);
    check(&[(0, 0), (far / 2, 2), (far, 0)], &[], 2.0, &[(0, 0), (far, 0)]);
}

/// Whether p is within an integer `tolerance` of segment a–b, with integers alone: the oracle.
fn is_within(p: LatticePoint, a: LatticePoint, b: LatticePoint, tolerance: i128) -> bool {
    let square = |p: LatticePoint, q: LatticePoint| {
        i128::from(p.u - q.u).pow(2) + i128::from(p.v - q.v).pow(2)
    };
    let (ab, along) =
        (square(a, b), i128::from((b.u - a.u) * (p.u - a.u) + (b.v - a.v) * (p.v - a.v)));
    let area = i128::from((b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u));
    if along <= 0 {
        square(a, p) <= tolerance.pow(2)
    } else if along >= ab {
        square(b, p) <= tolerance.pow(2)
    } else {
        area.pow(2) <= tolerance.pow(2) * ab
    }
}

/// Returns the indices in `source` of the points of `thin`, matched greedily from the front so that
/// fixed points are matched.
fn is_subsequence(thin: &[LatticePoint], source: &[LatticePoint]) -> bool {
    let mut rest = source.iter();
    thin.iter().all(|point| rest.any(|other| other == point))
}

/// Whether the source can be cut at its points into stretches, one per segment of `thin`, each
/// within the tolerance of its segment. Dynamic programming tries all ways of cutting.
fn is_near(thin: &[LatticePoint], source: &[LatticePoint], tolerance: i128) -> bool {
    let mut reached = vec![false; source.len()];
    reached[0] = thin[0] == source[0];
    for segment in thin.windows(2) {
        let mut next = vec![false; source.len()];
        for start in (0..source.len()).filter(|&i| reached[i]) {
            for end in start + 1..source.len() {
                if !is_within(source[end], segment[0], segment[1], tolerance) {
                    break;
                }
                next[end] |= source[end] == segment[1];
            }
        }
        reached = next;
    }
    reached[source.len() - 1]
}

fn points() -> impl Strategy<Value = Vec<LatticePoint>> {
    // A small range makes equal points, rings, overlaps and collinear runs common.
    prop_oneof![(-8..=8_i64, 2..40_usize), (-100_000..=100_000_i64, 2..40_usize)].prop_flat_map(
        |(range, count)| {
            let range = range.abs().max(2);
            vec((-range..=range, -range..=range).prop_map(|(u, v)| LatticePoint::new(u, v)), count)
        },
    )
}

proptest! {
    /// No source point is farther than the tolerance from the segment that replaces its stretch.
    /// Ends and fixed points stay, and the result consists of the source's points in their order.
    #[test]
    fn stays_within_the_tolerance(points in points(), fixed in vec(1..40_u32, 0..5), tolerance in 1..50_000_i64) {
        if let Some(road) = road(points, &fixed) {
            let source = road.line.points();
            let thin = simplified(&road, tolerance as f64);
            prop_assert!(is_subsequence(thin.points(), source));
            prop_assert!(is_near(thin.points(), source, i128::from(tolerance)));
            let fixed: Vec<LatticePoint> = road.fixed.iter().map(|&i| source[i as usize]).collect();
            let mut distinct = fixed.clone();
            distinct.dedup();
            prop_assert!(is_subsequence(&distinct, thin.points()));
        }
    }

    /// A way and its reverse keep the same points.
    #[test]
    fn does_not_depend_on_direction(points in points(), fixed in vec(1..40_u32, 0..5), tolerance in 0.1..50_000.0) {
        if let Some(there) = road(points, &fixed) {
            let last = there.line.points().len() as u32 - 1;
            let back = Road {
                line: Polyline::new(there.line.points().iter().rev().copied().collect()).unwrap(),
                fixed: there.fixed.iter().rev().map(|&i| last - i).collect(),
                ..there.clone()
            };
            let mut reversed = simplified(&back, tolerance).into_points();
            reversed.reverse();
            prop_assert_eq!(simplified(&there, tolerance).into_points(), reversed);
        }
    }

    /// Simplifying again with the same tolerance and junctions never makes the line invalid.
    #[test]
    fn always_leaves_a_polyline(points in points(), tolerance in prop_oneof![Just(f64::INFINITY), Just(f64::MAX), 0.0..10.0]) {
        if let Some(road) = road(points, &[]) {
            prop_assert!(simplified(&road, tolerance).points().len() >= 2);
        }
    }
}

proptest! {
    /// In each stretch, the result has the points that `geo` keeps, if no two distances are equal
    /// and no stretch returns to its start.
    #[test]
    fn keeps_the_points_that_geo_keeps(
        steps in vec((1_i64..1_000_000_000, -1_000_000_000_i64..1_000_000_000), 3..60),
        inner_fixed in vec(0_u32..60, 0..4),
        tolerance_steps in 1e6..1e9_f64,
    ) {
        use geo::{Coord, LineString, Simplify as _};

        let points = steps.iter().scan((0, 0), |at, (du, dv)| {
            *at = (at.0 + du, at.1 + dv);
            Some(LatticePoint::new(at.0, at.1))
        });
        let road = road(points.collect(), &inner_fixed).unwrap();
        let source = road.line.points();
        let mut expected = vec![source[0].in_steps()];
        for pair in road.fixed.windows(2) {
            let stretch = &source[pair[0] as usize..=pair[1] as usize];
            let stretch: LineString =
                stretch.iter().map(|point| Coord::from(point.in_steps())).collect();
            let kept = stretch.simplify(tolerance_steps);
            expected.extend(kept.into_iter().skip(1).map(|at| [at.x, at.y]));
        }
        let kept = simplified(&road, tolerance_steps);
        let kept: Vec<[f64; 2]> = kept.points().iter().map(|point| point.in_steps()).collect();
        prop_assert_eq!(kept, expected);
    }
}

/// A line that goes back and forth keeps its points and is not scanned once for each point,
/// whichever way it runs.
#[test]
fn work_follows_the_points_of_a_zigzag() {
    let zigzag = |k: i64| (1000 * k, if k % 2 == 0 { 0 } else { 1_000_000_000 });
    let spiral = |k: i64| {
        let (angle, reach) = (k as f64 * 0.37, (100_000 - k) as f64 * 1000.0);
        ((reach * angle.cos()) as i64, (reach * angle.sin()) as i64)
    };
    let comb = |k: i64| (1000 * k, [0, 5_000_000, 200, 7_000_000][k as usize % 4]);
    let along = |k: i64| (k * k, -k);
    let shapes: [&dyn Fn(i64) -> (i64, i64); 4] = [&zigzag, &spiral, &comb, &along];
    for shape in shapes {
        let begun = std::time::Instant::now();
        let points: Vec<(i64, i64)> = (0..60_000).map(shape).collect();
        let there = simplified(&line(&points, &[]), 100.0);
        let back = simplified(&line(&points.iter().rev().copied().collect::<Vec<_>>(), &[]), 100.0);
        let turned: Vec<LatticePoint> = back.points().iter().rev().copied().collect();
        assert_eq!(there.points(), turned);
        let source: Vec<LatticePoint> =
            points.iter().map(|&(u, v)| LatticePoint::new(u, v)).collect();
        assert!(is_subsequence(there.points(), &source));
        // One scan per point would take minutes.
        assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
    }
}
