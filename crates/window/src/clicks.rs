//! Two clicks that are one.

use glam::DVec2;

/// The second comes no later than this,
const WITHIN_S: f64 = 0.4;
/// and no farther away.
const WITHIN_POINTS: f64 = 6.0;
/// A hand is not quite still while it clicks; what moves farther drags.
const STILL_POINTS: f64 = 3.0;

/// Remembers the last click.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clicks {
    last: Option<Last>,
}

#[derive(Debug, Clone, Copy)]
struct Last {
    at_s: f64,
    at: DVec2,
    is_released: bool,
}

/// What a press is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Click {
    /// The first one.
    Single,
    /// The second of two; a third is a first again.
    Double,
}

impl Clicks {
    /// The button goes down, at a place in points and a time of any clock.
    pub(crate) fn press(&mut self, at: DVec2, now_s: f64) -> Click {
        let is_second = self.last.is_some_and(|last| {
            last.is_released
                && now_s - last.at_s <= WITHIN_S
                && last.at.distance(at) <= WITHIN_POINTS
        });
        self.last = (!is_second).then_some(Last { at_s: now_s, at, is_released: false });
        if is_second { Click::Double } else { Click::Single }
    }

    /// The cursor is here; with the button held that may be a drag, which is no click.
    pub(crate) fn move_to(&mut self, at: DVec2) {
        let is_drag = |last: &Last| !last.is_released && last.at.distance(at) > STILL_POINTS;
        self.last = self.last.filter(|last| !is_drag(last));
    }

    /// The button goes up.
    pub(crate) fn release(&mut self) {
        if let Some(last) = &mut self.last {
            last.is_released = true;
        }
    }

    /// Whatever was begun is not ended.
    pub(crate) fn let_go(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
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
}
