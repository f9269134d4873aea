//! A view whose movements are limited: the eye stays over the data and above the ground.

use corniche_geom::Bounds;
use corniche_viewer::camera::{Camera, Orientation};
use glam::{DVec2, DVec3};

use super::{
    options::CameraLimits,
    sight::sees_data,
    view::{CameraView, KnownGround, half_turn},
};

/// A drag over rising ground is solved at most this many times.
const PAN_SOLUTIONS: u32 = 64;
/// When the eye is lifted, it is lifted this much farther than necessary.
const LIFT_MARGIN_M: f64 = 1e-3;

/// A view in an image of some size, and the limits of its movements.
#[derive(Debug, Clone)]
pub(crate) struct BoundedView {
    pub(crate) view: CameraView,
    /// The first view, which is always allowed, even outside the limits.
    pub(crate) home: CameraView,
    pub(crate) limits: CameraLimits,
    pub(crate) size_px: [u32; 2],
}

impl BoundedView {
    /// The camera for the view.
    pub(crate) fn camera(&self) -> Camera {
        self.view.camera(self.size_px)
    }

    /// The middle of the picture.
    pub(crate) fn middle_px(&self) -> DVec2 {
        let [width, height] = self.size_px.map(f64::from);
        DVec2::new(width / 2.0, height / 2.0)
    }

    /// The ground at a pixel.
    pub(crate) fn ground_at(&self, at_px: DVec2, ground: &dyn KnownGround) -> Option<DVec3> {
        self.view.ground_at(at_px, self.size_px, self.limits.far_m(), ground)
    }

    /// The ground in the middle of the image; above the horizon, the point at the distance of the
    /// focus.
    pub(crate) fn middle(&self, ground: &dyn KnownGround) -> DVec3 {
        self.ground_at(self.middle_px(), ground).unwrap_or_else(|| {
            self.view.eye_in_world - self.view.world_from_view().z_axis * self.view.focus_m
        })
    }

    /// The side of a pixel in the middle of the image, in world metres.
    pub(crate) fn pixel_m(&self) -> f64 {
        self.camera().pixel_at_unit_depth_m() * self.view.focus_m
    }

    /// Brings the grabbed point `anchor` under the cursor.
    ///
    /// Ground in the way lifts the eye. Lifting moves the grabbed point away from the cursor, so
    /// the position in plan is solved again. If the ground behind the eye rises as steeply as the
    /// cursor's ray, the iteration does not converge; then the map does not move, just as when it
    /// is dragged beyond the horizon.
    pub(crate) fn pan_to(&mut self, anchor: DVec3, cursor_px: DVec2, ground: &dyn KnownGround) {
        let far_m = self.limits.far_m();
        let mut view = self.view;
        for _ in 0..PAN_SOLUTIONS {
            let Some(dragged) = view.dragged(anchor, cursor_px, self.size_px, far_m) else {
                return;
            };
            view = dragged;
            let lacks_m = view.lacks_m(self.limits.clearance_m, ground);
            if lacks_m <= 0.0 {
                self.view = view;
                return;
            }
            // Without the margin, the missing height would be halved again and again.
            view.eye_in_world.z += lacks_m + LIFT_MARGIN_M;
        }
    }

    /// Moves the eye in plan by this many pixels to the right and ahead.
    pub(crate) fn pan_by(&mut self, step_px: DVec2) {
        let axes = self.view.world_from_view();
        let ahead = DVec3::Z.cross(axes.x_axis);
        self.view.eye_in_world += (axes.x_axis * step_px.x + ahead * step_px.y) * self.pixel_m();
    }

    /// Rotates about a point, as far as the eye stays above the ground.
    pub(crate) fn turn(
        &mut self,
        pivot: DVec3,
        heading_deg: f64,
        pitch_deg: f64,
        ground: &dyn KnownGround,
    ) {
        let most_deg = if self.view.from_above.is_some() { 0.0 } else { self.limits.max_pitch_deg };
        let pitch_deg = pitch_deg.clamp(0.0, most_deg);
        let with = |pitch_deg| {
            let heading_deg = half_turn(heading_deg);
            self.view.turned_about(pivot, Orientation { heading_deg, pitch_deg })
        };
        let lacks = |view: &CameraView| view.lacks_m(self.limits.clearance_m, ground) > 0.0;
        let wanted = with(pitch_deg);
        // The more steeply the eye looks down, the higher it is above the pivot.
        self.view = if lacks(&wanted) {
            with(self.view.orientation.pitch_deg.min(pitch_deg))
        } else {
            wanted
        };
    }

    /// Turns the eye without moving it.
    pub(crate) fn look(&mut self, heading_deg: f64, pitch_deg: f64) {
        self.view.orientation = Orientation { heading_deg, pitch_deg: pitch_deg.clamp(0.0, 90.0) };
    }

    /// Zooms in unless the eye would be too low or too near to the pivot, or out unless the eye
    /// would be too far away. Returns whether it zoomed.
    pub(crate) fn zoom_by(&mut self, pivot: DVec3, levels: f64, ground: &dyn KnownGround) -> bool {
        let zoomed = self.view.zoomed_at(pivot, libm::exp2(-levels));
        let distance_m = match zoomed.from_above {
            None => zoomed.eye_in_world.distance(pivot),
            Some(_) => zoomed.focus_m,
        };
        let is_too_low = levels > 0.0
            && (zoomed.lacks_m(self.limits.clearance_m, ground) > 0.0
                || distance_m < 2.0 * self.limits.clearance_m);
        let is_too_far = levels < 0.0 && distance_m > self.limits.far_m();
        if is_too_low || is_too_far {
            return false;
        }
        self.view = zoomed;
        true
    }

    /// Multiplies all heights by `factor`; the middle of the image keeps its place. `ground` is the
    /// ground before the change.
    pub(crate) fn rescale_heights(&mut self, factor: f64, ground: &dyn KnownGround) {
        let pivot = self.middle(ground);
        self.view.eye_in_world.z += pivot.z * (factor - 1.0);
        self.home.eye_in_world.z += ground.base_height() * (factor - 1.0);
    }

    /// The view with the same direction and distance, and another place in the middle of the image.
    pub(crate) fn looking_at(
        &self,
        target_in_world: DVec3,
        ground: &dyn KnownGround,
    ) -> CameraView {
        if self.view.from_above.is_some() {
            let eye_in_world = target_in_world + DVec3::Z * self.view.focus_m;
            return CameraView { eye_in_world, ..self.view };
        }
        let distance_m = self.middle(ground).distance(self.view.eye_in_world);
        let distance_m = distance_m.clamp(2.0 * self.limits.clearance_m, self.limits.far_m());
        let Orientation { heading_deg, pitch_deg } = self.view.orientation;
        let pitch_deg = pitch_deg.min(self.limits.max_pitch_deg);
        let orientation = Orientation { heading_deg, pitch_deg };
        let camera = Camera::look_at(target_in_world, distance_m, orientation, self.size_px);
        CameraView::from_camera(&camera, orientation)
    }

    /// Whether the view would show some of the data.
    pub(crate) fn shows_data(&self, view: &CameraView, ground: &dyn KnownGround) -> bool {
        sees_data(view, self.size_px, self.limits.data, ground.heights()[0])
    }

    /// Brings the eye back over the data and above the ground, and adapts the focus.
    pub(crate) fn settle(&mut self, ground: &dyn KnownGround) {
        let Bounds { min_x, min_y, max_x, max_y } = self.limits.data;
        let stray_m = (max_x - min_x).max(max_y - min_y).max(100.0);
        let eye = &mut self.view.eye_in_world;
        let home = self.home.eye_in_world;
        eye.x = eye.x.clamp((min_x - stray_m).min(home.x), (max_x + stray_m).max(home.x));
        eye.y = eye.y.clamp((min_y - stray_m).min(home.y), (max_y + stray_m).max(home.y));
        eye.z = eye.z.min((ground.base_height() + self.limits.far_m()).max(home.z));
        let lacks_m = self.view.lacks_m(self.limits.clearance_m, ground);
        self.view.eye_in_world.z += lacks_m.max(0.0);
        self.view = self.view.refocused(ground);
    }
}
