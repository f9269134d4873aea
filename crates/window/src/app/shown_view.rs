//! The view as a request that `render` understands.

use corniche_tileset::Manifest;
use corniche_viewer::{CameraRequest, ClassSet};
use glam::DVec3;

use super::{App, ground};
use crate::{
    ShownView,
    controls::{KnownGround, View},
    settings::Compare,
};

impl App {
    /// What is shown, and in words what no command can tell of it. `None` where the style has no name.
    ///
    /// Without ground in the middle of the map, the point looked at hangs in the air at the distance that drags and turns go by.
    pub(crate) fn shown_view(&self) -> Option<(ShownView, String)> {
        let ground = ground(&self.tiles, &self.settings, &self.package);
        let (view, size_px) = (self.camera.view(), self.camera.size_px());
        let ahead = -view.world_from_view().z_axis;
        let in_air = || view.eye_in_world + ahead * view.focus_m;
        let target_in_world = ground.hit(view.eye_in_world, ahead).unwrap_or_else(in_air);
        let settings = &self.settings;
        let shown = ShownView {
            camera: match view.from_above {
                None => camera_request(
                    &view,
                    target_in_world,
                    self.package.vertical_scale(settings.exaggeration),
                    self.package.manifest(),
                ),
                Some(_) => request_from_above(&view, size_px, self.package.manifest()),
            },
            size_px,
            roads: settings.roads,
            style: self.styles.names().get(settings.style)?.clone(),
            photo: settings.photo,
            areas: settings.areas,
            boundaries: settings.boundaries,
            hidden_overlays: settings.hidden_overlays.clone(),
            overlay_colors: self.overlay_colors(),
            exaggeration: settings.exaggeration,
            screen_space_error_px: settings.screen_space_error_px,
            cell_px: settings.cell_px,
            samples_per_side: settings.samples_per_side,
            wireframe: settings.wireframe(),
        };
        let left_out: Vec<&str> = [
            (settings.roads.classes != ClassSet::ALL, "hidden classes"),
            (
                settings.width_factors.iter().any(|factor| (*factor - 1.0).abs() > 0.0),
                "factors on widths",
            ),
            (settings.compare != Compare::Off, "the comparison"),
        ]
        .into_iter()
        .filter_map(|(is_set, what)| is_set.then_some(what))
        .collect();
        let words = if left_out.is_empty() {
            String::new()
        } else {
            format!(" (without {})", left_out.join(", "))
        };
        Some((shown, words))
    }
}

/// The camera of a view that looks at this point in the middle of its picture. `target_in_world` is in world metres, whose heights are
/// `vertical_scale` times true ones.
///
/// [`CameraRequest::camera`] makes the same camera of it, whatever the ground there.
pub(crate) fn camera_request(
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
