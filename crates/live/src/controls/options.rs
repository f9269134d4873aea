//! Options of the controls: limits of the camera, what a drag does, and how movements end.

use corniche_geom::Bounds;

/// How far the camera may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraLimits {
    /// The extent of the data in plan. The eye goes no farther beyond it than the length of its
    /// longer side.
    pub data: Bounds,
    /// The least height of the eye above the ground, in world metres.
    pub clearance_m: f64,
    /// The largest tilt from straight down in map mode.
    pub max_pitch_deg: f64,
}

impl CameraLimits {
    /// The largest distance at which something can be grabbed, and the largest height of the eye
    /// above the ground.
    #[must_use]
    pub fn far_m(&self) -> f64 {
        4.0 * self.data.width().max(self.data.height()).max(100.0)
    }
}

/// The effect of a drag on the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// A drag moves the ground, like a map on a table.
    Map,
    /// A drag turns the eye, like looking around in flight.
    Fly,
}
