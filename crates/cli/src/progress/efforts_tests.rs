//! Efforts add up, whatever was expected.

#![allow(clippy::float_cmp, reason = "weights that are exact")]

use super::*;

#[test]
fn steps_count_by_what_they_take() {
    let efforts = Efforts(vec![(10, 1.0), (4, 2.5), (1, 30.0)]);
    let of = |done| efforts.until(done, Some(15)) as f64 / PARTS;
    assert_eq!([of(0), of(10), of(11), of(14), of(15)], [0.0, 10.0, 12.5, 20.0, 50.0]);
    for done in 0..=15 {
        let both = efforts.until(done, Some(15)) + efforts.after(done, Some(15));
        assert_eq!(both as f64 / PARTS, 50.0);
    }
}

/// Two of the four steps are skipped: when all is done, no effort is left.
#[test]
fn steps_that_are_left_out_take_nothing() {
    let efforts = Efforts(vec![(10, 1.0), (4, 2.5), (1, 30.0)]);
    assert_eq!(efforts.after(13, Some(13)), 0);
    assert_eq!(efforts.after(12, Some(13)) as f64 / PARTS, 30.0);
    assert_eq!(efforts.until(10, Some(13)) as f64 / PARTS, 10.0);
}

/// The end of a stage whose last steps are long is predicted within a factor of two after a fifth
/// of its time; by counting steps alone it is not.
#[test]
fn a_stage_whose_last_steps_are_long_is_foreseen() {
    use std::time::Duration;

    use super::super::pace::Pace;

    let runs = vec![(1000, 1.0), (250, 1.6), (60, 3.0), (16, 9.0), (4, 35.0), (5, 140.0)];
    let total: u64 = runs.iter().map(|(steps, _)| steps).sum();
    // The true times of steps differ by up to a quarter.
    let truth: Vec<f64> = runs
        .iter()
        .enumerate()
        .flat_map(|(k, &(steps, each))| {
            let off = if k % 2 == 0 { 1.25 } else { 0.8 };
            std::iter::repeat_n(each * off, steps as usize)
        })
        .collect();
    let end_s: f64 = truth.iter().sum();
    let efforts = Efforts(runs);
    let (mut by_effort, mut by_steps) = (Pace::new(), Pace::new());
    let (mut now_s, mut worst, mut worst_by_steps) = (0.0, 1.0_f64, 1.0_f64);
    for (done, took_s) in (1..).zip(truth) {
        now_s += took_s;
        let elapsed = Duration::from_secs_f64(now_s);
        by_effort.record(elapsed, efforts.until(done, Some(total)));
        by_steps.record(elapsed, done);
        let left_s = end_s - now_s;
        if now_s < 0.2 * end_s || left_s < 0.01 * end_s {
            continue;
        }
        let ratio = |found: Option<Duration>| {
            let found_s = found.unwrap().as_secs_f64().max(1e-9);
            (found_s / left_s).max(left_s / found_s)
        };
        worst = worst.max(ratio(by_effort.left(elapsed, efforts.after(done, Some(total)))));
        worst_by_steps = worst_by_steps.max(ratio(by_steps.left(elapsed, total - done)));
    }
    assert!(worst < 2.0 && worst_by_steps > 2.0, "{worst} {worst_by_steps}");
}
