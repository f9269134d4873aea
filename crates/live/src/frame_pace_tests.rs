//! The next frame is due in time, pauses do not count as frame times, and the median is that of
//! recent frames.

use super::*;

#[test]
fn the_next_frame_is_due_after_the_shortest_time() {
    assert_eq!(Redraw::after(5.0, [None, None]), Redraw::Asked);
    assert_eq!(Redraw::after(5.0, [Some(2.0), None, Some(0.5)]), Redraw::At(5.5));
}

/// The times noted for frames that begin at these seconds.
fn times_ms(frames: &[(f64, bool, bool)]) -> Vec<f64> {
    let mut pace = FramePace::default();
    for &(now_s, is_one_of_many, is_busy) in frames {
        pace.note(now_s, is_one_of_many, is_busy);
    }
    pace.times.iter().collect()
}

#[test]
fn a_frame_takes_the_time_until_the_next_one_begins() {
    let frames = [(1.0, true, true), (1.25, true, true), (1.375, false, false)];
    assert_eq!(times_ms(&frames), [250.0, 125.0]);
}

#[test]
fn only_a_frame_that_is_asked_for_at_once_may_take_longer_than_a_pause() {
    assert_eq!(times_ms(&[(1.0, true, true), (3.0, false, false)]), [2000.0]);
    assert_eq!(times_ms(&[(1.0, true, false), (3.0, false, false)]), [0.0; 0]);
    assert_eq!(times_ms(&[(1.0, true, false), (1.5, false, false)]), [500.0]);
}

#[test]
fn a_frame_that_no_other_follows_is_not_timed() {
    assert_eq!(times_ms(&[(1.0, false, false), (1.25, true, true)]), [0.0; 0]);
}

#[test]
fn half_of_the_frames_took_no_longer_than_the_median() {
    let mut times = FrameTimes::default();
    assert_eq!(times.quantile_ms(0.5), None);
    for ms in [5.0, 1.0, 4.0, 2.0, 3.0] {
        times.push(ms);
    }
    assert_eq!(times.quantile_ms(0.5), Some(3.0));
    assert_eq!(times.quantile_ms(0.95), Some(5.0));
    assert_eq!(times.quantile_ms(0.2), Some(1.0));
    assert_eq!(times.last_ms(), Some(3.0));
}

#[test]
fn old_frames_are_forgotten() {
    let mut times = FrameTimes::default();
    for ms in 0..1000 {
        times.push(f64::from(ms));
    }
    assert_eq!(times.iter().len(), REMEMBERED);
    assert_eq!(times.quantile_ms(1e-9), Some(1000.0 - REMEMBERED as f64));
}
