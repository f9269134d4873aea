//! Two clicks close in time and position are a double click, and quick drags are not.

use super::*;

fn click(clicks: &mut Clicks, at: DVec2, now_s: f64) -> bool {
    let click = clicks.press(at, now_s);
    clicks.release();
    click
}

#[test]
fn two_clicks_soon_and_near_are_one_double_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert!(!click(&mut clicks, at, 5.0));
    clicks.move_to(at + 4.0);
    assert!(click(&mut clicks, at + 2.0, 5.3));
    assert!(!click(&mut clicks, at, 5.4), "the third begins again");
    assert!(!click(&mut clicks, at, 6.0), "too late");
    assert!(!click(&mut clicks, at + 20.0, 6.1), "too far");
}

#[test]
fn two_quick_drags_from_one_place_are_no_double_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert!(!clicks.press(at, 5.0));
    clicks.move_to(at + 30.0);
    clicks.move_to(at);
    clicks.release();
    assert!(!clicks.press(at, 5.2));
}

#[test]
fn without_a_release_between_there_is_no_second_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert!(!clicks.press(at, 5.0));
    assert!(!clicks.press(at, 5.1));
    clicks.release();
    clicks.let_go();
    assert!(!clicks.press(at, 5.2), "the window lost the mouse between");
}
