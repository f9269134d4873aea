//! Options of the controls: limits of the camera, what a drag does, and how movements end.

use corniche_geom::Bounds;

/// How far the camera may go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The data in plan; the eye goes no farther from them than their larger side.
    pub data: Bounds,
    /// The eye stays so far above the ground, world metres.
    pub clearance_m: f64,
    /// Farthest tilt from straight down in map mode.
    pub max_pitch_deg: f64,
}

impl Limits {
    /// The largest distance at which something can be grabbed, and the largest height of the eye over the ground.
    #[must_use]
    pub fn far_m(&self) -> f64 {
        4.0 * self.data.width().max(self.data.height()).max(100.0)
    }
}

/// What a drag does to the camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// It moves the ground, as one moves a map on a table.
    Map,
    /// It turns the eye, as one looks around in flight.
    Fly,
}
