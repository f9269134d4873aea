//! Two clicks that are one.

use glam::DVec2;

/// The second comes no later than this,
const WITHIN_S: f64 = 0.4;
/// and no farther away.
const WITHIN_PX: f64 = 6.0;

/// Remembers the last click.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clicks {
    last: Option<(f64, DVec2)>,
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
    /// The button goes down, at a time of any clock.
    pub(crate) fn press(&mut self, at_px: DVec2, now_s: f64) -> Click {
        let is_second = self.last.is_some_and(|(last_s, last_px)| {
            now_s - last_s <= WITHIN_S && last_px.distance(at_px) <= WITHIN_PX
        });
        self.last = (!is_second).then_some((now_s, at_px));
        if is_second { Click::Double } else { Click::Single }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_clicks_soon_and_near_are_one_double_click() {
        let at = DVec2::new(10.0, 20.0);
        let mut clicks = Clicks::default();
        assert_eq!(clicks.press(at, 5.0), Click::Single);
        assert_eq!(clicks.press(at + 2.0, 5.3), Click::Double);
        assert_eq!(clicks.press(at, 5.4), Click::Single, "the third begins again");
        assert_eq!(clicks.press(at, 6.0), Click::Single, "too late");
        assert_eq!(clicks.press(at + 20.0, 6.1), Click::Single, "too far");
    }
}
