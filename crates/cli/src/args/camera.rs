//! The camera options of all commands that begin with a view from one point.

use clap::Args;
use corniche_viewer::{CameraRequest, camera::Orientation};

use super::values::{parse_dpi, parse_position, parse_scale};

/// The ground size of a pixel in a view from above, unless `--pixel` is given.
const DEFAULT_PIXEL_M: f64 = 5.0;
/// Pixels per inch in print, unless `--dpi` is given.
const DEFAULT_DPI: f64 = 300.0;
/// An inch, in metres.
const INCH_M: f64 = 0.0254;

#[derive(Debug, Args)]
pub(crate) struct CameraArgs {
    /// Look at this longitude and latitude (degrees, WGS84) instead of at the roads
    #[arg(long, value_name = "LON,LAT", value_parser = parse_position, allow_hyphen_values = true)]
    look_at: Option<[f64; 2]>,
    /// With --look-at: height of the target, in metres, also where there is no ground [default: the
    /// ground's]
    #[arg(long, value_name = "METRES", requires = "look_at", allow_hyphen_values = true)]
    height: Option<f64>,
    /// With --look-at: distance from the camera to the target, in metres
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
    /// With --look-at: tilt of the view, in degrees: 0 looks straight down, 90 at the horizon; a
    /// window allows up to 85
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0, requires = "look_at")]
    pitch: f64,
}

impl CameraArgs {
    /// The request to the viewer, which checks it.
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

/// The options of a view from above, for commands that render one image.
#[derive(Debug, Args)]
pub(crate) struct FromAboveArgs {
    /// Look straight down with parallel rays, as on a map: the scale is the same everywhere, and
    /// north is up unless --heading is given
    #[arg(long, conflicts_with_all = ["height", "distance", "pitch"])]
    pub ortho: bool,
    /// With --ortho and --look-at: ground size of a pixel, in metres [default: 5]
    #[arg(long, value_name = "METRES", requires = "ortho", requires = "look_at")]
    pixel: Option<f64>,
    /// With --ortho: scale in print, such as 1:25000 or 25000; without --look-at, centred on the
    /// overview
    #[arg(long, value_name = "1:N", requires = "ortho", conflicts_with = "pixel", allow_hyphen_values = true, value_parser = parse_scale)]
    scale: Option<u32>,
    /// With --scale: pixels per inch in print, also stored in the file [default: 300]
    #[arg(long, value_name = "N", requires = "scale", allow_hyphen_values = true, value_parser = parse_dpi)]
    dpi: Option<f64>,
    /// With --ortho: also write the georeference next to the image: a world file (.pgw) and its
    /// coordinate system (.prj)
    #[arg(long, requires = "ortho")]
    pub world_file: bool,
}

/// The scale and resolution of an image in print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PrintScale {
    /// The denominator of the scale.
    pub denominator: u32,
    /// Pixels per inch.
    pub dots_per_inch: f64,
}

impl PrintScale {
    /// The ground size of a pixel, in metres.
    pub(crate) fn pixel_m(self) -> f64 {
        f64::from(self.denominator) * INCH_M / self.dots_per_inch
    }

    /// Pixels per metre of paper, rounded, as PNG stores them.
    pub(crate) fn dots_per_metre(self) -> u32 {
        (self.dots_per_inch / INCH_M).round() as u32
    }
}

impl FromAboveArgs {
    /// The scale in print, if one is requested.
    pub(crate) fn print_scale(&self) -> Option<PrintScale> {
        let dots_per_inch = self.dpi.unwrap_or(DEFAULT_DPI);
        self.scale.map(|denominator| PrintScale { denominator, dots_per_inch })
    }

    /// The request to the viewer, which checks it.
    pub(crate) fn request(&self, camera: &CameraArgs) -> CameraRequest {
        let pixel_m = self.print_scale().map(PrintScale::pixel_m).or(self.pixel);
        match (self.ortho, camera.look_at) {
            (false, _) => camera.request(),
            (true, None) => CameraRequest::OverviewFromAbove { pixel_m },
            (true, Some([lon_deg, lat_deg])) => CameraRequest::FromAbove {
                lon_deg,
                lat_deg,
                pixel_m: pixel_m.unwrap_or(DEFAULT_PIXEL_M),
                heading_deg: camera.heading,
            },
        }
    }
}

#[cfg(test)]
#[path = "camera_tests.rs"]
mod tests;
