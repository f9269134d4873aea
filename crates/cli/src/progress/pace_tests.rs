//! Clocks here are artificial, so each expected time has a closed form.

use super::*;

fn seconds(s: f64) -> Duration {
    Duration::from_secs_f64(s)
}

/// Feeds a pace with (time, steps done so far), and asks between any two entries how long the rest
/// of `total` takes. Returns (time, estimated time left, true time left).
fn estimates(clock: &[(f64, u64)]) -> Vec<(f64, f64, f64)> {
    let &(end_s, total) = clock.last().unwrap();
    let mut pace = Pace::new();
    let mut found = Vec::new();
    for pair in clock.windows(2) {
        let [(at_s, done), (next_s, _)] = [pair[0], pair[1]];
        pace.record(seconds(at_s), done);
        for now_s in [at_s, f64::midpoint(at_s, next_s), next_s - (next_s - at_s) * 1e-3] {
            let left = pace.left(seconds(now_s), total - done).unwrap();
            found.push((now_s, left.as_secs_f64(), end_s - now_s));
        }
    }
    found
}

#[track_caller]
fn check_exact(found: &[(f64, f64, f64)]) {
    assert!(!found.is_empty());
    for &(now_s, estimate_s, truth_s) in found {
        assert!((estimate_s - truth_s).abs() < 1e-6, "{now_s}: {estimate_s}, not {truth_s}");
    }
}

/// A steady stage is estimated exactly from its first step on, however coarse the steps are.
#[test]
fn a_steady_stage_is_estimated_exactly() {
    for steps in [2, 10, 333, 5000] {
        let clock: Vec<_> = (1..=steps).map(|k| (0.7 * k as f64, k)).collect();
        check_exact(&estimates(&clock));
    }
}

/// Workers deliver in bursts; at any moment between two bursts the estimate is exact.
#[test]
fn bursts_do_not_disturb_the_estimate() {
    for burst in [7, 64] {
        let clock: Vec<_> =
            (1..=50).map(|k: u32| (3.0 * f64::from(k), burst * u64::from(k))).collect();
        check_exact(&estimates(&clock));
    }
}

/// The steps of a burst come one by one, a ten-thousandth of a second apart.
#[test]
fn a_burst_of_single_steps_counts_as_one() {
    let mut clock = Vec::new();
    for burst in 1..=40_u64 {
        for step in 0..16 {
            clock.push((3.0 * burst as f64 + step as f64 * 1e-4, (burst - 1) * 16 + step + 1));
        }
    }
    let (end_s, total) = (120.0015, 640);
    let mut pace = Pace::new();
    for &(at_s, done) in &clock {
        pace.record(seconds(at_s), done);
        if done % 16 == 0 && done < total {
            let left_s = pace.left(seconds(at_s + 1.0), total - done).unwrap().as_secs_f64();
            let truth_s = end_s - at_s - 1.0;
            assert!((left_s - truth_s).abs() < 0.1, "{at_s}: {left_s}, not {truth_s}");
        }
    }
}

/// 1000 steps, 2 per second until `slow_from` steps are done, then 1 per second.
fn slowing(slow_from: u64) -> Vec<(f64, u64)> {
    let time_s = |k: u64| k.min(slow_from) as f64 / 2.0 + k.saturating_sub(slow_from) as f64;
    (1..=1000).map(|k| (time_s(k), k)).collect()
}

/// Half of the steps are fast, which takes 250 s. Before the change it is unpredictable. After it,
/// at `t`, the rate is averaged from `t / 4` on: `2 (250 - t / 4)` fast steps and `t - 250` slow
/// ones in `3 t / 4`.
#[test]
fn a_stage_that_slows_by_half_is_estimated_ever_better() {
    for (now_s, estimate_s, truth_s) in estimates(&slowing(500)) {
        if now_s < 250.0 {
            assert!((estimate_s - (500.0 - now_s)).abs() < 1e-6, "{now_s}: {estimate_s}");
            continue;
        }
        // Just after a step.
        if now_s.fract() == 0.0 {
            let rate = (250.0 + now_s / 2.0) / (0.75 * now_s);
            let expected_s = truth_s / rate;
            // The window begins up to one spacing early.
            let off_s = (estimate_s - expected_s).abs();
            assert!(off_s < 0.015 * expected_s, "{now_s}: {estimate_s}, not {expected_s}");
        }
        // From 82 % of the steps on.
        if now_s.fract() == 0.0 && now_s > 250.0 * 2.32 {
            assert!((0.8 * truth_s..=truth_s + 1e-6).contains(&estimate_s), "{now_s}");
        }
    }
}

/// Once all fast steps are in the first quarter of the elapsed time, at 200 s (and one spacing),
/// the estimate is exact.
#[test]
fn a_fast_start_is_forgotten() {
    let found = estimates(&slowing(100));
    let after: Vec<_> = found.into_iter().filter(|(now_s, ..)| *now_s > 210.0).collect();
    check_exact(&after);
}

/// 10 steps in 10 s, then nothing: the estimate is counted down to the next step, then the 90
/// others take ever longer.
#[test]
fn a_stage_that_stands_still_needs_ever_more_time() {
    let mut pace = Pace::new();
    for k in 1..=10_u64 {
        pace.record(Duration::from_secs(k), k);
    }
    let left_s = |now_s: u64| pace.left(Duration::from_secs(now_s), 90).unwrap().as_secs_f64();
    assert!((left_s(10) - 90.0).abs() < 1e-9 && (left_s(11) - 89.0).abs() < 1e-9);
    // The rate is averaged from 2 s on: 8 steps, and the one that may be done now.
    for now_s in [12, 20, 100, 10_000] {
        let expected_s = 89.0 * (now_s - 2) as f64 / 9.0;
        assert!((left_s(now_s) - expected_s).abs() < 1e-9, "{now_s}: {}", left_s(now_s));
        let rate = pace.per_second(Duration::from_secs(now_s)).unwrap();
        assert!((rate - 9.0 / (now_s - 2) as f64).abs() < 1e-12, "{now_s}: {rate}");
    }
}

#[test]
fn without_a_step_nothing_is_estimated() {
    let mut pace = Pace::new();
    assert_eq!((pace.left(seconds(5.0), 3), pace.per_second(seconds(5.0))), (None, None));
    assert_eq!(pace.left(seconds(5.0), 0), Some(Duration::ZERO), "nothing needs no time");
    // A step at the very begin gives no rate.
    pace.record(Duration::ZERO, 1);
    assert_eq!((pace.left(seconds(1.0), 3), pace.per_second(seconds(1.0))), (None, None));
}

/// A build of weeks with billions of steps records some hundred moments.
#[test]
fn what_is_kept_does_not_grow_with_the_steps() {
    let mut pace = Pace::new();
    for k in 1..=1_000_000_u64 {
        pace.record(seconds(k as f64 * 1e-3), k);
        assert!(pace.kept.len() <= 130, "{}", pace.kept.len());
    }
}
