//! The view with which a window opens.

use corniche_tileset::Manifest;
use corniche_viewer::{
    CameraRequest, OffGround, SightedGround,
    camera::{Camera, Orientation},
};

use crate::controls::View;

/// The view that was asked for, in a window of this size, of which `covered_px` on the right are covered. `vertical_scale` is the world
/// height of a metre of true height.
///
/// # Errors
/// When the place that was asked for has no ground.
pub fn first_view(
    camera: CameraRequest,
    manifest: &Manifest,
    ground: SightedGround,
    vertical_scale: f64,
    size_px: [u32; 2],
    covered_px: u32,
) -> Result<View, OffGround> {
    let part_px = match camera {
        // All of it must be visible, so it is framed in the part that is not covered.
        CameraRequest::Overview | CameraRequest::OverviewFromAbove { .. } => {
            [size_px[0].saturating_sub(covered_px).max(1), size_px[1]]
        }
        CameraRequest::LookAt { .. } | CameraRequest::FromAbove { .. } => size_px,
    };
    let orientation = camera.orientation();
    let camera = camera.camera(manifest, ground, vertical_scale, part_px)?;
    Ok(in_left_part(&camera, orientation, size_px[0]))
}

/// A view that shows in the left part of a window of this width what `camera` shows in a picture of its own.
fn in_left_part(camera: &Camera, orientation: Orientation, window_width_px: u32) -> View {
    let mut view = View::of(camera, orientation);
    let part_width_px = camera.size_px()[0];
    let hidden_px = f64::from(window_width_px.saturating_sub(part_width_px));
    // The middle of the window lies this far to the right of the middle of the part. A pixel has the same size in both,
    // for the size follows from the height of the picture.
    let aside_px = hidden_px / 2.0;
    // Near things move farther aside than those in the middle: a step back makes room for them.
    let back_m = view.focus_m * hidden_px / f64::from(part_width_px) / 8.0;
    let aside_m = aside_px * camera.pixel_at_unit_depth_m() * (view.focus_m + back_m);
    let axes = view.world_from_view();
    view.eye_in_world += axes.x_axis * aside_m + axes.z_axis * back_m;
    view
}

#[cfg(test)]
#[path = "first_view_tests.rs"]
mod tests;
