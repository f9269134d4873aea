//! The default flight over a package, for users who give none.

use corniche_geom::Bounds;

use super::{Flight, FlightError, Keyframe, Pose};
use crate::camera::Orientation;

/// Number of keyframes of the flight.
const KEYFRAMES: usize = 33;
/// How many times the ground height is looked up between two keyframes.
const LOOKS: usize = 16;
/// Share of the longer side along which the camera flies; near the end no ground would be ahead of
/// it.
const REACH: f64 = 0.8;
/// Amplitude of the path to either side, as a share of the shorter side.
const SWING: f64 = 0.15;
/// Height above the ground as a share of the shorter side.
const CLEARANCE: f64 = 0.05;
/// Minimum height above the ground.
const MIN_CLEARANCE_M: f64 = 30.0;
/// Speed in true metres per second, as in the flight over Bavaria of Vaaraniemi, Treib & Westermann
/// 2011, section 7.
const SPEED_M_PER_S: f64 = 950.0;
/// Minimum duration: small packages are flown over more slowly.
const MIN_DURATION_S: f64 = 10.0;
const PITCH_DEG: f64 = 65.0;

impl Flight {
    /// Creates an oblique flight along the longer side of `plan`, swinging to both sides, always
    /// well above the ground.
    ///
    /// `height_at` returns the true height of the ground. Where it returns none, the path is above
    /// the highest ground of the whole path. `None` if there is no ground below the path.
    ///
    /// # Errors
    /// The errors of `height_at`.
    pub fn over<E>(
        plan: Bounds,
        height_at: &mut dyn FnMut([f64; 2]) -> Result<Option<f64>, E>,
    ) -> Result<Option<Self>, E> {
        let Ok(in_plan) = in_plan(plan, &[0.0; KEYFRAMES]) else { return Ok(None) };
        let [begin_s, end_s] = in_plan.span_s();
        let mut highest_m = [f64::NEG_INFINITY; KEYFRAMES - 1];
        for (k, highest_m) in highest_m.iter_mut().enumerate() {
            for look in 0..=LOOKS {
                let share = (k as f64 + look as f64 / LOOKS as f64) / (KEYFRAMES - 1) as f64;
                let [x, y, _] = in_plan.at(begin_s + share * (end_s - begin_s)).eye_m;
                if let Some(height_m) = height_at([x, y])? {
                    *highest_m = highest_m.max(height_m);
                }
            }
        }
        let top_m = highest_m.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if top_m.is_infinite() {
            return Ok(None);
        }
        let clearance_m = (CLEARANCE * plan.width().min(plan.height())).max(MIN_CLEARANCE_M);
        let beside = |k: usize| {
            let known =
                |k: usize| highest_m.get(k).map(|m| if m.is_infinite() { top_m } else { *m });
            let both = [k.checked_sub(1).and_then(known), known(k)];
            both.into_iter().flatten().fold(f64::NEG_INFINITY, f64::max)
        };
        // A keyframe is above all ground between it and both its neighbours. Between two keyframes
        // the height is between their heights.
        let heights_m: [f64; KEYFRAMES] = std::array::from_fn(|k| beside(k) + clearance_m);
        Ok(self::in_plan(plan, &heights_m).ok())
    }
}

/// Returns the path at these heights; an error if the bounds have no area.
fn in_plan(plan: Bounds, heights_m: &[f64; KEYFRAMES]) -> Result<Flight, FlightError> {
    let (width_m, height_m) = (plan.width(), plan.height());
    let (long_m, short_m) = (width_m.max(height_m), width_m.min(height_m));
    let duration_s = (REACH * long_m / SPEED_M_PER_S).max(MIN_DURATION_S);
    let share = |k: usize| k as f64 / (KEYFRAMES - 1) as f64;
    let keyframes: [Keyframe; KEYFRAMES] = std::array::from_fn(|k| {
        let angle = std::f64::consts::TAU * share(k);
        let along_m = REACH * long_m * share(k);
        let across_m = SWING * short_m * angle.sin();
        // Sideways metres per metre ahead.
        let turn = SWING * short_m * std::f64::consts::TAU * angle.cos() / (REACH * long_m);
        let [center_x, center_y] = plan.center();
        let (x, y, heading_deg) = if width_m > height_m {
            (plan.min_x + along_m, center_y - across_m, 90.0 + turn.atan().to_degrees())
        } else {
            (center_x + across_m, plan.min_y + along_m, turn.atan().to_degrees())
        };
        let orientation = Orientation { heading_deg, pitch_deg: PITCH_DEG };
        Keyframe {
            time_s: duration_s * share(k),
            pose: Pose { eye_m: [x, y, heights_m[k]], orientation },
        }
    });
    Flight::new(&keyframes)
}
