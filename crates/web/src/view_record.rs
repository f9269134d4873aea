//! Where a map looks, as JSON.

use corniche_live::controls::View;
use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, OffGround, SightedGround,
    camera::{Camera, Orientation},
};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Where a map looks: at a place, from a distance in a direction, or straight from above with parallel rays.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ViewRecord {
    /// Longitude, degrees.
    pub(crate) lon: f64,
    /// Latitude, degrees.
    pub(crate) lat: f64,
    /// True height of the place, metres; `None`: that of the ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) height: Option<f64>,
    /// True metres from the eye to the place; not from above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) distance: Option<f64>,
    /// Clockwise from north, degrees.
    #[serde(default)]
    pub(crate) heading: f64,
    /// 0 looks straight down, degrees.
    #[serde(default)]
    pub(crate) pitch: f64,
    /// Whether rays are parallel.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) above: bool,
    /// True metres in a pixel; only from above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) pixel_m: Option<f64>,
}

/// The distance from which a place is looked at if nothing else is said, metres.
const USUAL_DISTANCE_M: f64 = 5000.0;
/// True metres in a pixel from above if nothing else is said.
const USUAL_PIXEL_M: f64 = 5.0;

impl ViewRecord {
    /// The place of a request that is no overview.
    pub(crate) fn of(request: CameraRequest) -> Option<Self> {
        match request {
            CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
                Some(Self {
                    lon: lon_deg,
                    lat: lat_deg,
                    height: height_m,
                    distance: Some(distance_m),
                    heading: orientation.heading_deg,
                    pitch: orientation.pitch_deg,
                    above: false,
                    pixel_m: None,
                })
            }
            CameraRequest::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg } => Some(Self {
                lon: lon_deg,
                lat: lat_deg,
                height: None,
                distance: None,
                heading: heading_deg,
                pitch: 0.0,
                above: true,
                pixel_m: Some(pixel_m),
            }),
            _ => None,
        }
    }

    /// The request that shows it.
    pub(crate) fn request(&self) -> CameraRequest {
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

/// The view that a request asks for, over this ground. World heights are `vertical_scale` times true ones.
///
/// # Errors
/// When the place has no ground, and no height is given.
pub(crate) fn view_on(
    request: CameraRequest,
    manifest: &Manifest,
    ground: SightedGround,
    vertical_scale: f64,
    size_px: [u32; 2],
) -> Result<View, OffGround> {
    let camera = request.camera(manifest, ground, vertical_scale, size_px)?;
    let heights = ground.heights_m.map(|height_m| height_m * vertical_scale);
    Ok(view_of(request, &camera, manifest, heights))
}

/// The view of a request from above, or of the camera that a request gave.
fn view_of(
    request: CameraRequest,
    camera: &Camera,
    manifest: &Manifest,
    heights: [f64; 2],
) -> View {
    let orientation = request.orientation();
    let view = View::of(camera, orientation);
    let CameraRequest::FromAbove { pixel_m, .. } = request else { return view };
    let target = camera.target_in_world();
    let at_one_m =
        Camera::look_at(DVec3::ZERO, 1.0, orientation, camera.size_px()).pixel_at_unit_depth_m();
    let focus_m = pixel_m * manifest.point_scale / at_one_m;
    let middle = heights[0].midpoint(heights[1]);
    let eye_in_world = DVec3::new(target.x, target.y, middle + focus_m);
    View { eye_in_world, focus_m, from_above: Some(heights), ..view }
}
