//! A recorded path of the camera: keyframes in a text file, and the camera's position between them.
//!
//! ```toml
//! crs = "EPSG:2056"   # the CRS of x_m and y_m; optional
//! metres_per_unit = [1.0, 1.0]   # x_m and y_m are coordinates of that CRS times these; default: as in the package
//!
//! [[keyframe]]
//! time_s = 0.0
//! lon_deg = 9.52      # WGS84; or x_m and y_m, in working metres
//! lat_deg = 47.14
//! height_m = 1800.0   # true height of the eye, in the package's vertical datum
//! heading_deg = 45.0  # clockwise from north
//! pitch_deg = 65.0    # 0 looks straight down, 90 at the horizon
//!
//! [[keyframe]]
//! time_s = 12.5
//! # …
//! ```
//!
//! Between two keyframes the camera moves smoothly, and each coordinate stays between its values at
//! these keyframes. So the camera never goes below the lower keyframe.

mod error;
mod keyframe;
mod pass_over;
mod path;
mod text;

pub use self::{
    error::FlightError,
    keyframe::{Keyframe, Pose},
    path::Flight,
    text::{FlightRecord, WorkingCrs},
};

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "keyframes are met exactly")]
#[path = "flight_tests.rs"]
mod tests;
