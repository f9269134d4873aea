//! What is left of a step that was asked for and is done over several frames.

use glam::{DVec2, DVec3};

/// A step with less than this left, in its unit, is completed at once.
const DONE: f64 = 1e-3;

/// What is still to be done of steps that were asked for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pending {
    pub(crate) pan_px: DVec2,
    pub(crate) heading_deg: f64,
    pub(crate) pitch_deg: f64,
    pub(crate) zoom_levels: f64,
    /// The point about which to zoom; without it the middle of the picture.
    pub(crate) pivot: Option<DVec3>,
}

impl Pending {
    /// Whether anything is left that can be seen.
    pub(crate) fn is_some(&self) -> bool {
        self.pan_px.abs().max_element() > DONE
            || self.heading_deg.abs() > DONE
            || self.pitch_deg.abs() > DONE
            || self.zoom_levels.abs() > DONE
    }

    /// Takes this share of every step out, or all of it where too little would be left.
    pub(crate) fn take(&mut self, share: f64) -> Self {
        let left = self.times(1.0 - share);
        let (taken, left) =
            if left.is_some() { (self.times(share), left) } else { (*self, Self::default()) };
        *self = left;
        taken
    }

    fn times(&self, factor: f64) -> Self {
        Self {
            pan_px: self.pan_px * factor,
            heading_deg: self.heading_deg * factor,
            pitch_deg: self.pitch_deg * factor,
            zoom_levels: self.zoom_levels * factor,
            pivot: self.pivot,
        }
    }
}
