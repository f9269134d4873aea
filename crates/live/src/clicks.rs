//! Distinguishes double clicks from single clicks.

use glam::DVec2;

/// The largest time between the two clicks of a double click.
const WITHIN_S: f64 = 0.4;
/// The largest distance between the two clicks of a double click.
const WITHIN_POINTS: f64 = 6.0;
/// A cursor that moves farther than this with the button held is a drag, not a click: no hand is
/// perfectly still.
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

impl Clicks {
    /// Handles a press of the button, at a position in points and a time of any clock. Returns
    /// whether this is the second click of a double click. The next click after a double click is a
    /// first one again.
    pub(crate) fn press(&mut self, at: DVec2, now_s: f64) -> bool {
        let is_second = self.last.is_some_and(|last| {
            last.is_released
                && now_s - last.at_s <= WITHIN_S
                && last.at.distance(at) <= WITHIN_POINTS
        });
        self.last = (!is_second).then_some(Last { at_s: now_s, at, is_released: false });
        is_second
    }

    /// Handles a movement of the cursor. If the button is held, the movement may be a drag instead
    /// of a click.
    pub(crate) fn move_to(&mut self, at: DVec2) {
        let is_drag = |last: &Last| !last.is_released && last.at.distance(at) > STILL_POINTS;
        self.last = self.last.filter(|last| !is_drag(last));
    }

    /// Handles the release of the button.
    pub(crate) fn release(&mut self) {
        if let Some(last) = &mut self.last {
            last.is_released = true;
        }
    }

    /// Forgets a started click, since the window lost the mouse.
    pub(crate) fn let_go(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
#[path = "clicks_tests.rs"]
mod tests;
