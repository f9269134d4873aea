//! Double clicks are told from single ones.

use glam::DVec2;

/// The largest time between the two clicks of a double click.
const WITHIN_S: f64 = 0.4;
/// The largest distance between the two clicks of a double click.
const WITHIN_POINTS: f64 = 6.0;
/// A cursor that moves farther than this with the button held is a drag, not a click: a hand is not quite still.
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

/// What a press of the button is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Click {
    /// The first click.
    Single,
    /// The second click of a double click. After it, the next click is a first one again.
    Double,
}

impl Clicks {
    /// The button goes down, at a position in points and a time of any clock.
    pub(crate) fn press(&mut self, at: DVec2, now_s: f64) -> Click {
        let is_second = self.last.is_some_and(|last| {
            last.is_released
                && now_s - last.at_s <= WITHIN_S
                && last.at.distance(at) <= WITHIN_POINTS
        });
        self.last = (!is_second).then_some(Last { at_s: now_s, at, is_released: false });
        if is_second { Click::Double } else { Click::Single }
    }

    /// The cursor is here. If the button is held, this may be a drag, which is no click.
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

    /// Forgets a click that was begun: the window lost the mouse.
    pub(crate) fn let_go(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
#[path = "clicks_tests.rs"]
mod tests;
