use corniche_viewer::camera::Orientation;

use super::{
    options::Inertia,
    view::{View, half_turn},
};

/// How long the way back to the first view takes.
const RETURN_S: f64 = 0.8;

/// The way back to the first view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReturnHome {
    from: View,
    begun_s: f64,
}

impl ReturnHome {
    /// Begins at a view.
    pub(crate) fn begin(from: View, now_s: f64) -> Self {
        Self { from, begun_s: now_s }
    }

    /// The view at a time, and whether the way is at its end.
    pub(crate) fn view(&self, home: View, now_s: f64, inertia: Inertia) -> (View, bool) {
        let t = match inertia {
            Inertia::On => ((now_s - self.begun_s) / RETURN_S).clamp(0.0, 1.0),
            Inertia::Off => 1.0,
        };
        if t >= 1.0 {
            return (home, true);
        }
        // A step without a jump of the speed at either end.
        let share = t * t * (3.0 - 2.0 * t);
        let from = self.from.orientation;
        let turn_deg = half_turn(home.orientation.heading_deg - from.heading_deg);
        let view = View {
            eye_in_world: self.from.eye_in_world.lerp(home.eye_in_world, share),
            orientation: Orientation {
                heading_deg: from.heading_deg + share * turn_deg,
                pitch_deg: from.pitch_deg + share * (home.orientation.pitch_deg - from.pitch_deg),
            },
            focus_m: home.focus_m,
        };
        (view, false)
    }
}
