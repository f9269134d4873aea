//! A keyframe of a flight: a time, a position and a direction of view.

use crate::camera::Orientation;

/// How many keyframes a flight may have. The most is an hour with 25 keyframes a second, and some more.
pub(crate) const KEYFRAMES: std::ops::RangeInclusive<usize> = 2..=100_000;

/// Where the eye is and how it looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// The eye: x, y in working metres and true height, metres.
    pub eye_m: [f64; 3],
    /// Direction of view.
    pub orientation: Orientation,
}

/// Where the camera is at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keyframe {
    /// Seconds since the beginning of the flight, or since any other fixed moment.
    pub time_s: f64,
    /// The camera.
    pub pose: Pose,
}
