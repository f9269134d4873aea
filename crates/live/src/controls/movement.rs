//! Movements of the camera that take several frames: drags, requested steps, and the way to another
//! view.

use corniche_viewer::camera::Orientation;
use glam::{DVec2, DVec3};

use super::{
    input::Button,
    view::{CameraView, half_turn},
};

/// The speed of a throw is measured over this time before the release of the button.
const THROW_WINDOW_S: f64 = 0.08;

/// The effect of a drag while its button is held.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Gesture {
    /// Keeps the anchor under the cursor.
    Pan { button: Button, anchor: DVec3 },
    /// Rotates and tilts about the pivot.
    Turn { button: Button, pivot: DVec3 },
    /// Turns the eye, in fly mode.
    Look { button: Button },
}

impl Gesture {
    /// The button that is held.
    pub(crate) fn button(self) -> Button {
        match self {
            Self::Pan { button, .. } | Self::Turn { button, .. } | Self::Look { button } => button,
        }
    }

    /// The point of the ground that the drag holds, in world space.
    pub(crate) fn held_mut(&mut self) -> Option<&mut DVec3> {
        match self {
            Self::Pan { anchor: held, .. } | Self::Turn { pivot: held, .. } => Some(held),
            Self::Look { .. } => None,
        }
    }
}

/// Times and positions of the eye at the last movements of a drag.
#[derive(Debug, Clone, Default)]
pub(crate) struct Trail(Vec<(f64, DVec3)>);

impl Trail {
    /// Starts a drag.
    pub(crate) fn begin(now_s: f64, eye: DVec3) -> Self {
        Self(vec![(now_s, eye)])
    }

    /// Adds a movement of the drag.
    pub(crate) fn push(&mut self, now_s: f64, eye: DVec3) {
        // One movement from before the time window is kept: with slow frames, the speed cannot be
        // measured without it.
        let is_old = |(time_s, _): &(f64, DVec3)| now_s - time_s > THROW_WINDOW_S;
        let old = self.0.iter().take_while(|mark| is_old(mark)).count();
        self.0.drain(..old.saturating_sub(1));
        self.0.push((now_s, eye));
    }

    /// The speed of the eye in plan at the release of the button, in metres per second; `None` if
    /// the last movement is too long ago. The last frame began at `frame_s`.
    pub(crate) fn speed_m_per_s(&self, now_s: f64, frame_s: f64) -> Option<DVec3> {
        let ((from_s, from), (to_s, to)) = (self.0.first()?, self.0.last()?);
        // Movements during the drawing of a frame are all reported after it: they may have taken as
        // long as the frame.
        let dt_s = (to_s - from_s).max(now_s - frame_s);
        let is_throw = now_s - to_s <= THROW_WINDOW_S / 2.0 && dt_s > 0.0;
        is_throw.then(|| ((*to - *from) / dt_s).with_z(0.0))
    }
}

/// A step with less than this left, in its unit, is completed at once.
const DONE: f64 = 1e-3;

/// The remainder of the requested steps.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pending {
    pub(crate) pan_px: DVec2,
    pub(crate) heading_deg: f64,
    pub(crate) pitch_deg: f64,
    pub(crate) zoom_levels: f64,
    /// The point to zoom about; `None` for the middle of the image.
    pub(crate) pivot: Option<DVec3>,
}

impl Pending {
    /// Whether a visible step is left.
    pub(crate) fn is_some(&self) -> bool {
        self.pan_px.abs().max_element() > DONE
            || self.heading_deg.abs() > DONE
            || self.pitch_deg.abs() > DONE
            || self.zoom_levels.abs() > DONE
    }

    /// Takes this share of every step, or the whole step if too little would be left.
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

/// The duration of the way to another view.
const TRAVEL_S: f64 = 0.8;

/// The way from one view to another: to the first view, or to a requested place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Travel {
    pub(crate) from: CameraView,
    pub(crate) to: CameraView,
    pub(crate) begun_s: f64,
}

impl Travel {
    /// The view at a time, and whether the way has ended.
    pub(crate) fn view(&self, now_s: f64, is_gradual: bool) -> (CameraView, bool) {
        let t = if is_gradual { ((now_s - self.begun_s) / TRAVEL_S).clamp(0.0, 1.0) } else { 1.0 };
        if t >= 1.0 {
            return (self.to, true);
        }
        // A smooth step, without a jump of the speed at either end.
        let share = t * t * (3.0 - 2.0 * t);
        let (from, to) = (self.from.orientation, self.to.orientation);
        let turn_deg = half_turn(to.heading_deg - from.heading_deg);
        let view = CameraView {
            eye_in_world: self.from.eye_in_world.lerp(self.to.eye_in_world, share),
            orientation: Orientation {
                heading_deg: from.heading_deg + share * turn_deg,
                pitch_deg: from.pitch_deg + share * (to.pitch_deg - from.pitch_deg),
            },
            ..self.to
        };
        (view, false)
    }
}
