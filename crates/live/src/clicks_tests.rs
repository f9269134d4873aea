//! Two clicks soon after each other and near each other are a double click, and quick drags are none.

use super::*;

fn click(clicks: &mut Clicks, at: DVec2, now_s: f64) -> Click {
    let click = clicks.press(at, now_s);
    clicks.release();
    click
}

#[test]
fn two_clicks_soon_and_near_are_one_double_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert_eq!(click(&mut clicks, at, 5.0), Click::Single);
    clicks.move_to(at + 4.0);
    assert_eq!(click(&mut clicks, at + 2.0, 5.3), Click::Double);
    assert_eq!(click(&mut clicks, at, 5.4), Click::Single, "the third begins again");
    assert_eq!(click(&mut clicks, at, 6.0), Click::Single, "too late");
    assert_eq!(click(&mut clicks, at + 20.0, 6.1), Click::Single, "too far");
}

#[test]
fn two_quick_drags_from_one_place_are_no_double_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert_eq!(clicks.press(at, 5.0), Click::Single);
    clicks.move_to(at + 30.0);
    clicks.move_to(at);
    clicks.release();
    assert_eq!(clicks.press(at, 5.2), Click::Single);
}

#[test]
fn without_a_release_between_there_is_no_second_click() {
    let at = DVec2::new(10.0, 20.0);
    let mut clicks = Clicks::default();
    assert_eq!(clicks.press(at, 5.0), Click::Single);
    assert_eq!(clicks.press(at, 5.1), Click::Single);
    clicks.release();
    clicks.let_go();
    assert_eq!(clicks.press(at, 5.2), Click::Single, "the window lost the mouse between");
}
