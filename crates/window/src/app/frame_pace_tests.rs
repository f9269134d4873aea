//! The next frame is due in time, and pauses do not count as frame times.

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
    pace.times().iter().collect()
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
