//! The view of the camera, and the ground queries that the controls need.

use corniche_viewer::{
    camera::{Camera, Orientation},
    eye_height,
};
use glam::{DMat3, DVec2, DVec3};

/// The ground, as far as it is loaded.
pub trait KnownGround {
    /// The first ground along a ray.
    fn hit(&self, eye_in_world: DVec3, ray_in_world: DVec3) -> Option<DVec3>;
    /// The ground that a camera sees at a pixel.
    fn under(&self, camera: &Camera, at_px: DVec2) -> Option<DVec3> {
        self.hit(camera.ray_start_in_world(at_px), camera.ray_in_world(at_px))
    }
    /// Height of the ground at a place in plan, world metres.
    fn height(&self, at: [f64; 2]) -> Option<f64>;
    /// A height in the middle of the range of heights, in world metres. Where the ground is
    /// unknown, a plane at this height replaces it.
    fn base_height(&self) -> f64;
    /// The heights of the lowest and the highest ground of the package, in world metres.
    fn heights(&self) -> [f64; 2];
}

/// The position and direction of the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraView {
    /// The eye, world metres.
    pub eye_in_world: DVec3,
    /// Direction of view.
    pub orientation: Orientation,
    /// The approximate distance of the ground in view; it determines the near plane and the haze.
    pub focus_m: f64,
    /// For a view from above with parallel rays: the heights between which all ground lies, in
    /// world metres. The eye is then over the middle of the image and looks straight down, at about
    /// the height from which things look as large.
    pub from_above: Option<[f64; 2]>,
}

impl CameraView {
    /// The view of a camera in perspective, whose direction is `orientation`.
    #[must_use]
    pub fn from_camera(camera: &Camera, orientation: Orientation) -> Self {
        Self {
            eye_in_world: camera.eye_in_world,
            orientation,
            focus_m: camera.focus_m,
            from_above: None,
        }
    }

    /// The camera for an image of this size.
    #[must_use]
    pub fn camera(&self, size_px: [u32; 2]) -> Camera {
        let camera = Camera::at_eye(self.eye_in_world, self.focus_m, self.orientation, size_px);
        match self.from_above {
            None => camera,
            Some(heights) => Camera::from_above(
                self.eye_in_world.truncate(),
                camera.pixel_at_depth_m(self.focus_m),
                self.orientation.heading_deg,
                heights,
                size_px,
            ),
        }
    }

    /// The view straight from above with parallel rays: `middle` is in the middle of the image at
    /// the current scale, within a range of distances.
    #[must_use]
    pub fn seen_from_above(
        &self,
        middle: DVec3,
        [least_m, most_m]: [f64; 2],
        heights: [f64; 2],
    ) -> Self {
        let focus_m = self.eye_in_world.distance(middle).clamp(least_m, most_m);
        Self {
            eye_in_world: middle + DVec3::Z * focus_m,
            orientation: Orientation { pitch_deg: 0.0, ..self.orientation },
            focus_m,
            from_above: Some(heights),
        }
    }

    /// The view of the same place in perspective.
    #[must_use]
    pub fn in_perspective(&self) -> Self {
        Self { from_above: None, ..*self }
    }

    /// The matrix of the view's axes; its columns are right, up and backward.
    #[must_use]
    pub fn world_from_view(&self) -> DMat3 {
        // The axes depend neither on the position nor on the size of the image.
        Camera::look_at(DVec3::ZERO, 1.0, self.orientation, [1, 1]).world_from_view
    }

    /// The ground at a pixel. Where there is no ground: the plane at the ground's base height, if
    /// that is no farther away than `most_m`.
    #[must_use]
    pub fn ground_at(
        &self,
        at_px: DVec2,
        size_px: [u32; 2],
        most_m: f64,
        ground: &dyn KnownGround,
    ) -> Option<DVec3> {
        ground
            .under(&self.camera(size_px), at_px)
            .or_else(|| self.on_plane(at_px, size_px, ground.base_height(), most_m))
    }

    /// The point where the ray through a pixel meets the horizontal plane at a height; `None` if it
    /// is farther away than `most_m`.
    #[must_use]
    pub fn on_plane(
        &self,
        at_px: DVec2,
        size_px: [u32; 2],
        height_m: f64,
        most_m: f64,
    ) -> Option<DVec3> {
        let camera = self.camera(size_px);
        let (start, ray) = (camera.ray_start_in_world(at_px), camera.ray_in_world(at_px));
        let depth = (height_m - start.z) / ray.z;
        let is_ahead = depth.is_finite() && depth > 0.0 && depth * ray.length() <= most_m;
        is_ahead.then(|| start + ray * depth)
    }

    /// The view from another direction in which `pivot` stays on its pixel, at the same distance.
    #[must_use]
    pub fn turned_about(&self, pivot: DVec3, orientation: Orientation) -> Self {
        let pivot_in_view = self.world_from_view().transpose() * (pivot - self.eye_in_world);
        let turned = Self { orientation, ..*self };
        Self { eye_in_world: pivot - turned.world_from_view() * pivot_in_view, ..turned }
    }

    /// The view with the eye `factor` times as far from `pivot`, which stays on its pixel.
    #[must_use]
    pub fn zoomed_at(&self, pivot: DVec3, factor: f64) -> Self {
        let eye_in_world = pivot + (self.eye_in_world - pivot) * factor;
        // In perspective the focus follows from the eye's height.
        let focus_m = if self.from_above.is_some() { self.focus_m * factor } else { self.focus_m };
        Self { eye_in_world, focus_m, ..*self }
    }

    /// The view with the eye moved in plan so that `anchor` appears at a pixel; `None` if the eye
    /// would be more than `most_m` away from the anchor.
    #[must_use]
    pub fn dragged(
        &self,
        anchor: DVec3,
        at_px: DVec2,
        size_px: [u32; 2],
        most_m: f64,
    ) -> Option<Self> {
        self.on_plane(at_px, size_px, anchor.z, most_m)
            .map(|beneath| Self { eye_in_world: self.eye_in_world + (anchor - beneath), ..*self })
    }

    /// The height by which the eye must rise to be `clearance_m` above the ground; 0 or negative if
    /// it is high enough.
    #[must_use]
    pub fn lacks_m(&self, clearance_m: f64, ground: &dyn KnownGround) -> f64 {
        let eye = self.eye_in_world;
        if self.from_above.is_some() {
            return f64::NEG_INFINITY;
        }
        ground
            .height([eye.x, eye.y])
            .map_or(f64::NEG_INFINITY, |height_m| height_m + clearance_m - eye.z)
    }

    /// The same view with the focus derived from its height above the ground, by the rule for
    /// flights; from above, with the height derived from the focus.
    #[must_use]
    pub fn refocused(&self, ground: &dyn KnownGround) -> Self {
        let eye = self.eye_in_world;
        let below_m = ground.height([eye.x, eye.y]).unwrap_or_else(|| ground.base_height());
        if self.from_above.is_some() {
            let eye_in_world = eye.with_z(below_m + self.focus_m);
            return Self { eye_in_world, from_above: Some(ground.heights()), ..*self };
        }
        let focus_m = eye_height::focus_m(eye.z - below_m, self.orientation.pitch_deg);
        Self { focus_m, ..*self }
    }
}

/// The same heading, between −180° and 180°.
pub(crate) fn half_turn(heading_deg: f64) -> f64 {
    (heading_deg + 180.0).rem_euclid(360.0) - 180.0
}
