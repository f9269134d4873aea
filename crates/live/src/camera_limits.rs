//! How far the camera may go and tilt over a package.

use corniche_tileset::Manifest;
use corniche_viewer::eye_height::clearance_m;

use crate::controls::Limits;

/// The largest tilt in map mode. Nearer to the horizon, the ground under the cursor is too far away to be dragged.
pub const MAX_PITCH_DEG: f64 = 85.0;

/// How far the camera may go over the package of this manifest.
#[must_use]
pub fn limits(manifest: &Manifest) -> Limits {
    Limits {
        data: manifest.data_bounds,
        clearance_m: clearance_m(manifest.point_scale),
        max_pitch_deg: MAX_PITCH_DEG,
    }
}
