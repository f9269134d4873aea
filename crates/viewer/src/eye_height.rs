//! Consequences of the eye's height above the ground: how low the eye may go, and how far away it
//! looks.
//!
//! Windows, flights and pictures use the same two rules, so that each can show what another has
//! shown. All heights are world heights: true heights times exaggeration and point scale.
//!
//! The near plane is at a thousandth of the focus distance, and the focus distance is at most five
//! times the height above the ground, but at least a metre. So at the minimum height the near plane
//! is a centimetre away from the eye and never reaches the ground.

/// Minimum height of the eye above the ground. A lower eye would see through the skirts of tiles.
const CLEARANCE_M: f64 = 2.0;
/// Minimum cosine of the pitch. With it, the focus is at most 1 / 0.2 = 5 times as far away as the
/// eye is high, even if the view is almost level.
const LEAST_COS: f64 = 0.2;
/// Minimum distance of the focus.
const MIN_FOCUS_M: f64 = 1.0;

/// Minimum height of the eye above the ground; `point_scale` is length in the working CRS over true
/// length.
#[must_use]
pub fn clearance_m(point_scale: f64) -> f64 {
    CLEARANCE_M * point_scale
}

/// Distance of the focus for an eye `above_ground_m` above the ground: the distance of level ground
/// in the middle of the picture. It changes as smoothly as the height and the pitch. Haze and near
/// plane depend on it.
#[must_use]
pub fn focus_m(above_ground_m: f64, pitch_deg: f64) -> f64 {
    (above_ground_m / pitch_deg.to_radians().cos().max(LEAST_COS)).max(MIN_FOCUS_M)
}

/// Rounds how much the eye is too low up to a tenth of a metre, so that a message never says "0.0 m
/// too low".
#[cfg(all(feature = "annotations", not(target_arch = "wasm32")))]
pub(crate) fn rounded_up_m(lacking_m: f64) -> f64 {
    (lacking_m * 10.0).ceil() / 10.0
}

#[cfg(test)]
#[path = "eye_height_tests.rs"]
mod tests;
