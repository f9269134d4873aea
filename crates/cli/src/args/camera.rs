//! Where to look from, for all commands that look from one place at first.

use clap::Args;
use corniche_viewer::{CameraRequest, camera::Orientation};

use super::values::parse_position;

/// Side of a pixel of a view from above unless --pixel says otherwise.
const DEFAULT_PIXEL_M: f64 = 5.0;

#[derive(Debug, Args)]
pub(crate) struct CameraArgs {
    /// Look at this longitude and latitude (degrees, WGS84) instead of where the roads are
    #[arg(long, value_name = "LON,LAT", value_parser = parse_position, allow_hyphen_values = true)]
    look_at: Option<[f64; 2]>,
    /// With --look-at: height of the point looked at, in metres, also where there is no ground [default: the ground's]
    #[arg(long, value_name = "METRES", requires = "look_at", allow_hyphen_values = true)]
    height: Option<f64>,
    /// With --look-at: distance from the eye to the point looked at, in metres
    #[arg(long, value_name = "METRES", default_value_t = 5000.0, requires = "look_at")]
    distance: f64,
    /// With --look-at: direction of view, in degrees clockwise from north
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 0.0,
        requires = "look_at",
        allow_hyphen_values = true
    )]
    heading: f64,
    /// With --look-at: tilt of the view, in degrees: 0 looks straight down, 90 at the horizon; a window goes up to 85
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0, requires = "look_at")]
    pitch: f64,
}

impl CameraArgs {
    /// What is asked of the viewer, which checks it.
    pub(crate) fn request(&self) -> CameraRequest {
        let Some([lon_deg, lat_deg]) = self.look_at else { return CameraRequest::Overview };
        CameraRequest::LookAt {
            lon_deg,
            lat_deg,
            height_m: self.height,
            distance_m: self.distance,
            orientation: Orientation { heading_deg: self.heading, pitch_deg: self.pitch },
        }
    }
}

/// A view from above, for commands that make one picture.
#[derive(Debug, Args)]
pub(crate) struct FromAboveArgs {
    /// Look straight down with parallel rays, as on a map: every place at the same scale, north up unless --heading says otherwise
    #[arg(long, conflicts_with_all = ["height", "distance", "pitch"])]
    ortho: bool,
    /// With --ortho and --look-at: side of a pixel on the ground, in metres [default: 5]
    #[arg(long, value_name = "METRES", requires = "ortho", requires = "look_at")]
    pixel: Option<f64>,
}

impl FromAboveArgs {
    /// What is asked of the viewer, which checks it.
    pub(crate) fn request(&self, camera: &CameraArgs) -> CameraRequest {
        match (self.ortho, camera.look_at) {
            (false, _) => camera.request(),
            (true, None) => CameraRequest::OverviewFromAbove,
            (true, Some([lon_deg, lat_deg])) => CameraRequest::FromAbove {
                lon_deg,
                lat_deg,
                pixel_m: self.pixel.unwrap_or(DEFAULT_PIXEL_M),
                heading_deg: camera.heading,
            },
        }
    }
}

#[cfg(test)]
#[path = "camera_tests.rs"]
mod tests;
