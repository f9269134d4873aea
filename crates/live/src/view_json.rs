//! The view of a map, as JSON.

use corniche_viewer::{CameraRequest, camera::Orientation};
use serde::{Deserialize, Serialize};

/// The view of a map: at a place, from a distance in a direction, or straight from above with
/// parallel rays.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewRecord {
    /// Longitude, degrees.
    pub lon: f64,
    /// Latitude, degrees.
    pub lat: f64,
    /// True height of the place, metres; `None` for that of the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// True metres from the eye to the place; `None` from above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Clockwise from north, degrees.
    #[serde(default)]
    pub heading: f64,
    /// 0 looks straight down, degrees.
    #[serde(default)]
    pub pitch: f64,
    /// Whether rays are parallel.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub above: bool,
    /// True metres per pixel; only from above.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixel_m: Option<f64>,
}

/// The default distance between the eye and the place, metres.
const USUAL_DISTANCE_M: f64 = 5000.0;
/// The default true metres per pixel from above.
const USUAL_PIXEL_M: f64 = 5.0;

impl ViewRecord {
    /// The view of a request that is not the overview.
    #[must_use]
    pub fn from_request(request: CameraRequest) -> Option<Self> {
        match request {
            CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
                Some(Self {
                    lon: lon_deg,
                    lat: lat_deg,
                    height: height_m,
                    distance: Some(distance_m),
                    heading: orientation.heading_deg,
                    pitch: orientation.pitch_deg,
                    ..Self::default()
                })
            }
            CameraRequest::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg } => Some(Self {
                lon: lon_deg,
                lat: lat_deg,
                heading: heading_deg,
                above: true,
                pixel_m: Some(pixel_m),
                ..Self::default()
            }),
            _ => None,
        }
    }

    /// The request for this view.
    #[must_use]
    pub fn request(&self) -> CameraRequest {
        let (lon_deg, lat_deg) = (self.lon, self.lat);
        if self.above {
            let pixel_m = self.pixel_m.unwrap_or(USUAL_PIXEL_M);
            return CameraRequest::FromAbove {
                lon_deg,
                lat_deg,
                pixel_m,
                heading_deg: self.heading,
            };
        }
        let orientation = Orientation { heading_deg: self.heading, pitch_deg: self.pitch };
        let distance_m = self.distance.unwrap_or(USUAL_DISTANCE_M);
        CameraRequest::LookAt { lon_deg, lat_deg, height_m: self.height, distance_m, orientation }
    }
}
