//! What follows from the eye's height above the ground beneath it: how low it may go, and how far away it looks.
//!
//! Windows, flights and pictures go by the same two rules, so that what one of them shows the others can show too. All
//! heights are world heights: true ones times exaggeration and the point scale.
//!
//! The near plane lies at a thousandth of the focus, and the focus is at most five times the height above the ground (a
//! metre at least): so at the least height it is a centimetre away, and never reaches the ground.

/// The eye stays at least so far above the ground: nearer it would see through the TIN's skirts.
const CLEARANCE_M: f64 = 2.0;
/// A view that looks level is about so many times as far from the ground as it is high.
const LEAST_COS: f64 = 0.2;
/// The nearest focus.
const MIN_FOCUS_M: f64 = 1.0;

/// Least height of the eye above the ground; `point_scale` is length in the working CRS over true length.
#[must_use]
pub fn clearance_m(point_scale: f64) -> f64 {
    CLEARANCE_M * point_scale
}

/// How far away the ground is that one looks at from `above_ground_m`: the way to level ground in the middle of the
/// picture. It changes as smoothly as that height and the pitch. Haze and near plane follow from it.
#[must_use]
pub fn focus_m(above_ground_m: f64, pitch_deg: f64) -> f64 {
    (above_ground_m / pitch_deg.to_radians().cos().max(LEAST_COS)).max(MIN_FOCUS_M)
}

/// How much the eye is too low, as it is told: rounded up to a tenth of a metre, for "0.0 m too low" says nothing.
pub(crate) fn rounded_up_m(lacking_m: f64) -> f64 {
    (lacking_m * 10.0).ceil() / 10.0
}

#[cfg(test)]
#[path = "eye_height_tests.rs"]
mod tests;
