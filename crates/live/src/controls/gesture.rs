//! A drag: what was grabbed, and how fast the eye moved last.

use glam::DVec3;

use super::input::Button;

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
