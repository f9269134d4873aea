//! A keyframe of a flight: a time, a position and a direction of view.

use crate::camera::Orientation;

/// How many keyframes a flight may have. The maximum is a little more than an hour with 25
/// keyframes a second.
pub(crate) const KEYFRAMES: std::ops::RangeInclusive<usize> = 2..=100_000;

/// Position and direction of view of the eye.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// Position of the eye: x, y in working metres and true height, metres.
    pub eye_m: [f64; 3],
    /// Direction of view.
    pub orientation: Orientation,
}

/// The pose of the camera at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyframe {
    /// Seconds since the beginning of the flight, or since any other fixed moment.
    pub time_s: f64,
    /// Pose of the camera.
    pub pose: Pose,
}
