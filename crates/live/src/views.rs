//! Views of a package and the requests for them: for the first view, for a place, and for the
//! current view.

use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, SightedGround, ViewpointOffGround,
    camera::{Camera, Orientation},
    eye_height::clearance_m,
    parse_lon_lat,
};
use glam::DVec3;

use crate::controls::{CameraLimits, CameraView, KnownGround};

/// The largest tilt in map mode. Nearer to the horizon, the ground under the cursor is too far away
/// to be dragged.
pub const MAX_PITCH_DEG: f64 = 85.0;

/// The limits of the camera over the package of this manifest.
pub(crate) fn limits(manifest: &Manifest) -> CameraLimits {
    CameraLimits {
        data: manifest.data_bounds,
        clearance_m: clearance_m(manifest.point_scale),
        max_pitch_deg: MAX_PITCH_DEG,
    }
}

/// The requested first view, in a window of this size whose right `covered_px` are covered.
/// `vertical_scale` is the world height of one metre of true height.
///
/// # Errors
/// When there is no ground at the requested place.
pub fn first_view(
    camera: CameraRequest,
    manifest: &Manifest,
    ground: SightedGround,
    vertical_scale: f64,
    size_px: [u32; 2],
    covered_px: u32,
) -> Result<CameraView, ViewpointOffGround> {
    let part_px = match camera {
        CameraRequest::FromAbove { .. } => {
            return view_on(camera, manifest, ground, vertical_scale, size_px);
        }
        // The whole package must be visible, so it is framed in the uncovered part.
        CameraRequest::Overview | CameraRequest::OverviewFromAbove { .. } => {
            [size_px[0].saturating_sub(covered_px).max(1), size_px[1]]
        }
        CameraRequest::LookAt { .. } => size_px,
    };
    let orientation = camera.orientation();
    let camera = camera.camera(manifest, ground, vertical_scale, part_px)?;
    Ok(in_left_part(&camera, orientation, size_px[0]))
}

/// The view of a request over this ground. World heights are `vertical_scale` times true heights.
///
/// # Errors
/// When the place has no ground, and no height is given.
pub(crate) fn view_on(
    request: CameraRequest,
    manifest: &Manifest,
    ground: SightedGround,
    vertical_scale: f64,
    size_px: [u32; 2],
) -> Result<CameraView, ViewpointOffGround> {
    let camera = request.camera(manifest, ground, vertical_scale, size_px)?;
    let orientation = request.orientation();
    let view = CameraView::from_camera(&camera, orientation);
    let CameraRequest::FromAbove { pixel_m, .. } = request else { return Ok(view) };
    let heights = ground.heights_m.map(|height_m| height_m * vertical_scale);
    let target = camera.target_in_world();
    let at_one_m = Camera::look_at(DVec3::ZERO, 1.0, orientation, size_px).pixel_at_unit_depth_m();
    let focus_m = pixel_m * manifest.point_scale / at_one_m;
    let eye_in_world = DVec3::new(target.x, target.y, heights[0].midpoint(heights[1]) + focus_m);
    Ok(CameraView { eye_in_world, focus_m, from_above: Some(heights), ..view })
}

/// A view whose left part, in a window of this width, shows what `camera` shows in an image of its
/// own.
fn in_left_part(camera: &Camera, orientation: Orientation, window_width_px: u32) -> CameraView {
    let mut view = CameraView::from_camera(camera, orientation);
    let part_width_px = camera.size_px[0];
    let hidden_px = f64::from(window_width_px.saturating_sub(part_width_px));
    // The middle of the window is this far to the right of the middle of the part. A pixel has the
    // same size in both, because its size follows from the height of the image.
    let aside_px = hidden_px / 2.0;
    // Near objects move farther aside than those in the middle, so the eye steps back.
    let back_m = view.focus_m * hidden_px / f64::from(part_width_px) / 8.0;
    let aside_m = aside_px * camera.pixel_at_unit_depth_m() * (view.focus_m + back_m);
    let axes = view.world_from_view();
    view.eye_in_world += axes.x_axis * aside_m + axes.z_axis * back_m;
    view
}

/// The request that shows a view again. World heights are `vertical_scale` times true heights.
///
/// [`CameraRequest::camera`] makes the same camera from it, whatever the ground there. Without
/// ground in the middle of the image, the target is a point in the air at the distance that drags
/// and turns use.
pub(crate) fn request_of_view(
    view: &CameraView,
    ground: &dyn KnownGround,
    vertical_scale: f64,
    manifest: &Manifest,
    size_px: [u32; 2],
) -> CameraRequest {
    let (eye, orientation) = (view.eye_in_world, view.orientation);
    let degrees = |at: DVec3| manifest.coordinates.wgs84_from_working([at.x, at.y]);
    if view.from_above.is_some() {
        let [lon_deg, lat_deg] = degrees(eye);
        // The target may be at any depth.
        let pixel_m = view.camera(size_px).pixel_at_depth_m(0.0) / manifest.point_scale;
        let heading_deg = orientation.heading_deg;
        return CameraRequest::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg };
    }
    let ahead = -view.world_from_view().z_axis;
    let in_air = || eye + ahead * view.focus_m;
    let target = ground.hit(eye, ahead).unwrap_or_else(in_air);
    let [lon_deg, lat_deg] = degrees(target);
    let distance_m = eye.distance(target) / manifest.point_scale;
    let height_m = Some(target.z / vertical_scale);
    CameraRequest::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation }
}

/// Returns the ground at the place written in a text, in world metres.
///
/// # Errors
/// When the text is not a place or there is no ground, as a message.
pub(crate) fn place_in_world(
    text: &str,
    manifest: &Manifest,
    ground: &dyn KnownGround,
) -> Result<DVec3, String> {
    let [lon_deg, lat_deg] = parse_lon_lat(text).map_err(|error| error.to_string())?;
    let at = |lon_lat_deg| {
        let [x, y] = manifest.coordinates.working_from_wgs84(lon_lat_deg)?;
        Some(DVec3::new(x, y, ground.height([x, y])?))
    };
    at([lon_deg, lat_deg]).ok_or_else(|| {
        let [west, south, east, north] = manifest.wgs84_bounds.to_array();
        let hint = if at([lat_deg, lon_deg]).is_some() {
            "; longitude comes first: the two numbers are probably swapped"
        } else {
            ""
        };
        format!(
            "there is no ground at longitude {lon_deg}, latitude {lat_deg}; the package covers longitudes {west:.4} to \
             {east:.4} and latitudes {south:.4} to {north:.4}{hint}"
        )
    })
}

#[cfg(test)]
#[path = "views_tests.rs"]
mod tests;
