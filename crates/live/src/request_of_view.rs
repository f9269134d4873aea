//! A view as a request that `render`, another window or a link understands.

use corniche_tileset::Manifest;
use corniche_viewer::CameraRequest;
use glam::DVec3;

use crate::controls::{KnownGround, View};

/// The request that shows a view again. World heights are `vertical_scale` times true ones.
///
/// Without ground in the middle of the picture, the point looked at hangs in the air at the distance that drags and turns go by.
#[must_use]
pub fn request_of_view(
    view: &View,
    ground: &dyn KnownGround,
    vertical_scale: f64,
    manifest: &Manifest,
    size_px: [u32; 2],
) -> CameraRequest {
    if view.from_above.is_some() {
        return request_from_above(view, size_px, manifest);
    }
    let ahead = -view.world_from_view().z_axis;
    let in_air = || view.eye_in_world + ahead * view.focus_m;
    let target_in_world = ground.hit(view.eye_in_world, ahead).unwrap_or_else(in_air);
    camera_request(view, target_in_world, vertical_scale, manifest)
}

/// The camera of a view that looks at this point in the middle of its picture. `target_in_world` is in world metres, whose heights are
/// `vertical_scale` times true ones.
///
/// [`CameraRequest::camera`] makes the same camera of it, whatever the ground there.
#[must_use]
pub fn camera_request(
    view: &View,
    target_in_world: DVec3,
    vertical_scale: f64,
    manifest: &Manifest,
) -> CameraRequest {
    let [lon_deg, lat_deg] =
        manifest.coordinates.wgs84_from_working([target_in_world.x, target_in_world.y]);
    let distance_m = view.eye_in_world.distance(target_in_world) / manifest.point_scale;
    let height_m = Some(target_in_world.z / vertical_scale);
    CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation: view.orientation }
}

/// The same for a view from above.
fn request_from_above(view: &View, size_px: [u32; 2], manifest: &Manifest) -> CameraRequest {
    let eye = view.eye_in_world;
    let [lon_deg, lat_deg] = manifest.coordinates.wgs84_from_working([eye.x, eye.y]);
    // At any depth.
    let pixel_m = view.camera(size_px).pixel_at_depth_m(0.0) / manifest.point_scale;
    let heading_deg = view.orientation.heading_deg;
    CameraRequest::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg }
}
