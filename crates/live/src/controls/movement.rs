//! Movements of the camera that take several frames: drags, steps that were asked for, and the way
//! to another view.

use corniche_viewer::camera::Orientation;
use glam::{DVec2, DVec3};

use super::{
    input::Button,
    view::{View, half_turn},
};

/// The speed of a throw is measured over this time before the button goes up.
const THROW_WINDOW_S: f64 = 0.08;

/// What a drag does, as long as its button is held.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Gesture {
    /// Keeps the anchor under the cursor.
    Pan { button: Button, anchor: DVec3 },
    /// Turns and tilts about the pivot.
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

    /// The point of the ground that is held, in world space.
    pub(crate) fn held_mut(&mut self) -> Option<&mut DVec3> {
        match self {
            Self::Pan { anchor: held, .. } | Self::Turn { pivot: held, .. } => Some(held),
            Self::Look { .. } => None,
        }
    }
}

/// Times and positions of the eye at the last moves of a drag.
#[derive(Debug, Clone, Default)]
pub(crate) struct Trail(Vec<(f64, DVec3)>);

impl Trail {
    /// A drag begins.
    pub(crate) fn begin(now_s: f64, eye: DVec3) -> Self {
        Self(vec![(now_s, eye)])
    }

    /// The drag goes on.
    pub(crate) fn push(&mut self, now_s: f64, eye: DVec3) {
        // One move from before the time window stays: where frames are slow, the speed can be measured by no other.
        let is_old = |(time_s, _): &(f64, DVec3)| now_s - time_s > THROW_WINDOW_S;
        let old = self.0.iter().take_while(|mark| is_old(mark)).count();
        self.0.drain(..old.saturating_sub(1));
        self.0.push((now_s, eye));
    }

    /// The speed of the eye in plan when the button goes up, metres per second; `None` if the last move is too long ago.
    /// The last frame began at `frame_s`.
    pub(crate) fn speed_m_per_s(&self, now_s: f64, frame_s: f64) -> Option<DVec3> {
        let ((from_s, from), (to_s, to)) = (self.0.first()?, self.0.last()?);
        // Moves that happen while a frame is drawn are reported after it, all at once: they may have taken as long as the
        // frame.
        let dt_s = (to_s - from_s).max(now_s - frame_s);
        let is_throw = now_s - to_s <= THROW_WINDOW_S / 2.0 && dt_s > 0.0;
        is_throw.then(|| ((*to - *from) / dt_s).with_z(0.0))
    }
}

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

/// How long the way to another view takes.
const TRAVEL_S: f64 = 0.8;

/// The way from one view to another: back to the first one, or to a place that was asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Travel {
    from: View,
    to: View,
    begun_s: f64,
}

impl Travel {
    /// Begins at the view `from`.
    pub(crate) fn begin(from: View, to: View, now_s: f64) -> Self {
        Self { from, to, begun_s: now_s }
    }

    /// The ground at the end of the way is higher by this now, world metres.
    pub(crate) fn raise_end(&mut self, by_m: f64) {
        self.to.eye_in_world.z += by_m;
    }

    /// The view at a time, and whether the way is at its end.
    pub(crate) fn view(&self, now_s: f64, is_gradual: bool) -> (View, bool) {
        let t = if is_gradual { ((now_s - self.begun_s) / TRAVEL_S).clamp(0.0, 1.0) } else { 1.0 };
        if t >= 1.0 {
            return (self.to, true);
        }
        // A step without a jump of the speed at either end.
        let share = t * t * (3.0 - 2.0 * t);
        let (from, to) = (self.from.orientation, self.to.orientation);
        let turn_deg = half_turn(to.heading_deg - from.heading_deg);
        let view = View {
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
