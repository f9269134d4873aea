//! Position and direction of the camera: pure functions in f64, no GPU.
//!
//! ```text
//!  world (working CRS)          view                     clip, after division by w
//!    z up                         y up                     y up, −1…1
//!    │  y north                   │                        │
//!    │ /                          │                        │      z = near / depth
//!    └──── x east                 └──── x right            └──── x right
//!                                /                              1 at the near plane, 0 infinitely far
//!                               z towards the viewer
//! ```
//!
//! The GPU never sees world positions: it gets positions *relative to the eye* in f32, taken as
//! differences of f64 (Cozzi & Ring 2011, ch. 5). Depth is reversed with an infinite far plane, which
//! distributes the precision of a float evenly over distance (Reed 2015, *Depth Precision Visualized*).

use corniche_geom::Bounds;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// Vertical field of view of every camera made here.
pub(crate) const FOV_Y_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// How much farther away than necessary the camera stands from a box that it frames, as a share of the distance.
const FRAME_MARGIN: f64 = 0.03;
/// The near plane lies at this share of the distance to what is looked at.
const NEAR_SHARE: f64 = 1e-3;

/// A box in world space with sides along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldBox {
    /// West, south, bottom.
    pub min: DVec3,
    /// East, north, top.
    pub max: DVec3,
}

impl WorldBox {
    /// The box over a plan rectangle between two heights, both in world metres.
    #[must_use]
    pub fn new(plan: Bounds, height_m: [f64; 2]) -> Self {
        Self {
            min: DVec3::new(plan.min_x, plan.min_y, height_m[0]),
            max: DVec3::new(plan.max_x, plan.max_y, height_m[1]),
        }
    }

    /// Its middle.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Its eight corners.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> {
        let Self { min, max } = *self;
        (0..8).map(move |bits| {
            let pick =
                |bit: usize, low: f64, high: f64| if bits >> bit & 1 == 0 { low } else { high };
            DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
        })
    }

    /// Distance from `point` to the nearest point of the box; 0 inside.
    #[must_use]
    pub fn distance_m(&self, point: DVec3) -> f64 {
        point.distance(point.clamp(self.min, self.max))
    }
}

/// Direction of view: where it points on the compass and how far it is tilted up from straight down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orientation {
    /// Clockwise from north; 0 has north at the top of the picture.
    pub heading_deg: f64,
    /// 0 looks straight down, 90 at the horizon (as `MapLibre` counts).
    pub pitch_deg: f64,
}

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    eye_in_world: DVec3,
    /// Columns: right, up, backward in world space. Orthonormal.
    world_from_view: DMat3,
    fov_y_rad: f64,
    size_px: [u32; 2],
    near_m: f64,
    focus_m: f64,
}

/// The view volume as planes: `dot(normal, point) + offset >= 0` inside. No far plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frustum {
    planes: [DVec4; 5],
}

impl Camera {
    /// Looks at `target_in_world` from `distance_m` away. `size_px` must not hold a 0.
    #[must_use]
    pub fn look_at(
        target_in_world: DVec3,
        distance_m: f64,
        orientation: Orientation,
        size_px: [u32; 2],
    ) -> Self {
        let world_from_view = world_from_view(orientation);
        Self {
            eye_in_world: target_in_world + world_from_view.z_axis * distance_m,
            world_from_view,
            fov_y_rad: FOV_Y_RAD,
            size_px,
            near_m: distance_m * NEAR_SHARE,
            focus_m: distance_m,
        }
    }

    /// Looks at `subject` from the least distance at which all of it is in the picture, with a small margin, centred.
    #[must_use]
    pub fn framing(subject: WorldBox, orientation: Orientation, size_px: [u32; 2]) -> Self {
        let world_from_view = world_from_view(orientation);
        let view_from_world = world_from_view.transpose();
        let tan = half_extent_at_unit_depth(FOV_Y_RAD, size_px);
        let corners: Vec<DVec3> =
            subject.corners().map(|corner| view_from_world * (corner - subject.center())).collect();
        // With the eye at (ox, oy, d) in view axes around the centre, a corner (x, y, z) is inside iff
        // |x − ox| ≤ tan.x · (d − z), that is d ≥ z + (x − ox) / tan.x and d ≥ z − (x − ox) / tan.x; likewise for
        // y. The least distance for which there is such an ox and oy is where both bounds are equal.
        let reach = |sign: f64| {
            let bounds = corners.iter().map(|corner| sign * corner.truncate() / tan + corner.z);
            bounds.reduce(DVec2::max).unwrap_or_default()
        };
        let least_m = ((reach(1.0) + reach(-1.0)) / 2.0).max_element();
        let distance_m = least_m.max(1.0) * (1.0 + FRAME_MARGIN);
        // The box is centred where the free borders on both sides are equal. Moving the eye right moves everything
        // left, so bisection finds that place.
        let middle = |axis: usize| {
            let far = corners.iter().fold(0.0_f64, |far, corner| far.max(corner[axis].abs()));
            let (mut low, mut high) = (-far, far);
            for _ in 0..60 {
                let offset = f64::midpoint(low, high);
                let places =
                    corners.iter().map(|corner| (corner[axis] - offset) / (distance_m - corner.z));
                let [least, most] = places
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], place| {
                        [least.min(place), most.max(place)]
                    });
                if least + most > 0.0 {
                    low = offset;
                } else {
                    high = offset;
                }
            }
            f64::midpoint(low, high)
        };
        let target = subject.center() + world_from_view * DVec3::new(middle(0), middle(1), 0.0);
        Self::look_at(target, distance_m, orientation, size_px)
    }

    /// The eye, world metres.
    #[must_use]
    pub fn eye_in_world(&self) -> DVec3 {
        self.eye_in_world
    }

    /// Distance to the point that the camera looks at.
    #[must_use]
    pub fn focus_m(&self) -> f64 {
        self.focus_m
    }

    /// The point that the camera looks at.
    #[must_use]
    pub fn target_in_world(&self) -> DVec3 {
        self.eye_in_world - self.world_from_view.z_axis * self.focus_m
    }

    /// Depth of the near plane.
    #[must_use]
    pub fn near_m(&self) -> f64 {
        self.near_m
    }

    /// Width and height of the picture.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The same view with `factor` times as many pixels on each side.
    #[must_use]
    pub fn supersampled(&self, factor: u32) -> Self {
        Self { size_px: self.size_px.map(|side| side * factor), ..*self }
    }

    /// The axes of the view as columns: right, up, backward.
    #[must_use]
    pub fn world_from_view(&self) -> DMat3 {
        self.world_from_view
    }

    /// Half width and half height of what is seen at depth 1.
    pub(crate) fn half_extent_at_unit_depth(&self) -> DVec2 {
        half_extent_at_unit_depth(self.fov_y_rad, self.size_px)
    }

    /// Side of a pixel at depth 1, in metres.
    #[must_use]
    pub fn pixel_at_unit_depth_m(&self) -> f64 {
        2.0 * (self.fov_y_rad / 2.0).tan() / f64::from(self.size_px[1])
    }

    /// Clip space from positions relative to the eye (world axes).
    pub(crate) fn clip_from_relative(&self) -> DMat4 {
        let tan = self.half_extent_at_unit_depth();
        // Rows: x / tan.x, y / tan.y, near, −z.
        let clip_from_view = DMat4::from_cols(
            DVec4::new(1.0 / tan.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, 1.0 / tan.y, 0.0, 0.0),
            DVec4::new(0.0, 0.0, 0.0, -1.0),
            DVec4::new(0.0, 0.0, self.near_m, 0.0),
        );
        clip_from_view * DMat4::from_mat3(self.world_from_view.transpose())
    }

    /// Pixel position (0, 0 is the picture's upper left corner; pixel centres at halves) and depth of a point;
    /// `None` behind the near plane.
    #[must_use]
    pub fn project(&self, point_in_world: DVec3) -> Option<(DVec2, f64)> {
        let clip = self.clip_from_relative() * (point_in_world - self.eye_in_world).extend(1.0);
        let [width, height] = self.size_px.map(f64::from);
        (clip.w >= self.near_m).then(|| {
            let x_px = (0.5 + 0.5 * clip.x / clip.w) * width;
            let y_px = (0.5 - 0.5 * clip.y / clip.w) * height;
            (DVec2::new(x_px, y_px), clip.w)
        })
    }

    /// Direction in world space through a pixel position, scaled so that its depth is 1: a point at depth d
    /// along it is `eye + d · ray`.
    #[must_use]
    pub fn ray_in_world(&self, pixel: DVec2) -> DVec3 {
        let tan = self.half_extent_at_unit_depth();
        let [width, height] = self.size_px.map(f64::from);
        let x = (2.0 * pixel.x / width - 1.0) * tan.x;
        let y = (1.0 - 2.0 * pixel.y / height) * tan.y;
        self.world_from_view * DVec3::new(x, y, -1.0)
    }

    /// What the picture can show.
    pub(crate) fn frustum(&self) -> Frustum {
        let tan = self.half_extent_at_unit_depth();
        let plane = |normal_in_view: DVec3, offset: f64| {
            let normal = self.world_from_view * normal_in_view;
            normal.extend(offset - normal.dot(self.eye_in_world))
        };
        Frustum {
            planes: [
                plane(DVec3::new(1.0, 0.0, -tan.x), 0.0),
                plane(DVec3::new(-1.0, 0.0, -tan.x), 0.0),
                plane(DVec3::new(0.0, 1.0, -tan.y), 0.0),
                plane(DVec3::new(0.0, -1.0, -tan.y), 0.0),
                plane(DVec3::NEG_Z, -self.near_m),
            ],
        }
    }
}

impl Frustum {
    /// Whether some part of the box may be in view. Never false for a box that is in view; true for some that are not.
    ///
    /// Source: Assarsson & Möller 2000, *Optimized View Frustum Culling Algorithms for Bounding Boxes*: only the
    /// corner farthest along each plane's normal is tested.
    pub(crate) fn may_see(&self, subject: &WorldBox) -> bool {
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = DVec3::select(normal.cmpge(DVec3::ZERO), subject.max, subject.min);
            normal.dot(farthest) + plane.w >= 0.0
        })
    }
}

fn half_extent_at_unit_depth(fov_y_rad: f64, [width, height]: [u32; 2]) -> DVec2 {
    let tan = (fov_y_rad / 2.0).tan();
    DVec2::new(tan * f64::from(width) / f64::from(height), tan)
}

fn world_from_view(Orientation { heading_deg, pitch_deg }: Orientation) -> DMat3 {
    // Looking straight down with north up, view axes equal world axes. Tilting up turns about the right axis,
    // heading about the vertical, clockwise seen from above.
    DMat3::from_rotation_z(-heading_deg.to_radians())
        * DMat3::from_rotation_x(pitch_deg.to_radians())
}

#[cfg(test)]
#[path = "camera_tests.rs"]
mod tests;
