//! The camera travels from one view to another in a short time.

use corniche_viewer::camera::Orientation;

use super::{
    options::Inertia,
    view::{View, half_turn},
};

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
    pub(crate) fn view(&self, now_s: f64, inertia: Inertia) -> (View, bool) {
        let t = match inertia {
            Inertia::On => ((now_s - self.begun_s) / TRAVEL_S).clamp(0.0, 1.0),
            Inertia::Off => 1.0,
        };
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
