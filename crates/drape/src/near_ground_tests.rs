//! No ground near a segment is outside the bounds.

use corniche_geom::LatticePoint;
use proptest::prelude::*;

use super::*;
use crate::extrude::tests::ground;

/// The distance of a point from a segment.
fn distance(at: [f64; 2], [p, q]: [[f64; 2]; 2]) -> f64 {
    let (d, e) = ([q[0] - p[0], q[1] - p[1]], [at[0] - p[0], at[1] - p[1]]);
    let squared = d[0] * d[0] + d[1] * d[1];
    let share =
        if squared > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (e[0] - share * d[0]).hypot(e[1] - share * d[1])
}

proptest! {
    /// All ground within the reach is within the bounds, with holes or without, in the interior of
    /// the ground or at its boundary.
    #[test]
    fn no_ground_is_beyond_the_bounds(
        p in (-1500_i64..17_500, -1500_i64..17_500), by in (-4000_i64..4000, -4000_i64..4000),
        reach in 1_i64..3000, seed in 0_i32..1000, holes in 2_u32..60, steep in 1_i32..40,
        samples in prop::collection::vec((0.0..=1.0_f64, -1.0..=1.0_f64, -1.0..=1.0_f64), 100),
    ) {
        let rough = |column: i32, row: i32| steep * (column * 7919 + row * 104_729 + seed * 31).rem_euclid(97);
        let surface = ground(rough, |column, row| (column * 5 + row * 3) % holes == 1);
        let ends = [[p.0 as f64, p.1 as f64], [(p.0 + by.0) as f64, (p.1 + by.1) as f64]];
        let found = near_ground(ends, &surface, reach as f64, &StepBudget::unlimited());
        for (share, east, north) in samples {
            // Points anywhere around the segment, most of them near.
            let at = [0, 1].map(|axis| ends[0][axis] + share * (ends[1][axis] - ends[0][axis]));
            let at = LatticePoint::new((at[0] + east * reach as f64) as i64, (at[1] + north * reach as f64) as i64);
            let away = distance(at.in_steps(), ends);
            let Some(triangle) = surface.locate(at).filter(|_| away <= reach as f64) else { continue };
            let height_m = surface.height_at_point_m(triangle, at);
            let NearGround { range_m: [low_m, high_m], rise_m } = found.expect("there is ground");
            prop_assert!(height_m >= low_m - rise_m * away, "{height_m} under {low_m} by more than {away} · {rise_m}");
            prop_assert!(height_m <= high_m + rise_m * away, "{height_m} over {high_m} by more than {away} · {rise_m}");
        }
    }
}

/// The slope is 3 in 4 along the segment, with 0.5 m per step of height; the expected values have a
/// closed form.
#[test]
fn on_a_plane_the_bounds_are_those_of_the_plane() {
    let surface = ground(|column, _| 1500 * column, |_, _| false);
    let found = near_ground(
        [[4000.0, 8000.0], [6000.0, 8000.0]],
        &surface,
        1000.0,
        &StepBudget::unlimited(),
    )
    .unwrap();
    let [low_m, high_m] = found.range_m;
    // The slack is one step beyond each end, and the padding.
    assert!((low_m - 3000.0).abs() < 1.0 && low_m <= 3000.0, "{found:?}");
    assert!((high_m - 4500.0).abs() < 1.0 && high_m >= 4500.0, "{found:?}");
    assert!((found.rise_m - 0.75).abs() < 1e-12, "{found:?}");
}

#[test]
fn beside_a_hole_it_is_the_range_within_the_reach() {
    let surface = ground(|column, _| 100 * column, |column, row| column == 9 && row == 8);
    let near = |x: f64| {
        near_ground([[x, 7500.0], [x, 7600.0]], &surface, 1000.0, &StepBudget::unlimited()).unwrap()
    };
    assert!(near(5000.0).rise_m > 0.0, "far from it");
    let beside = near(8500.0);
    assert!(beside.rise_m.abs() < 1e-12, "{beside:?}");
    let [low_m, high_m] = beside.range_m;
    assert!((low_m - 375.0).abs() < 0.1 && (high_m - 475.0).abs() < 0.1, "{beside:?}");
}

#[test]
fn far_from_all_ground_there_is_nothing() {
    let surface = ground(|_, _| 10, |_, _| false);
    assert_eq!(
        near_ground([[-9000.0, 0.0], [-8000.0, 0.0]], &surface, 1000.0, &StepBudget::unlimited()),
        None
    );
    assert!(
        near_ground([[-900.0, 500.0], [-900.0, 500.0]], &surface, 1000.0, &StepBudget::unlimited())
            .is_some()
    );
}
