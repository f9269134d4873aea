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
//! differences of f64 (Cozzi & Ring 2011, ch. 5). Depth is reversed with an infinite far plane,
//! which distributes the precision of a float evenly over distance (Reed 2015, *Depth Precision
//! Visualized*).
//!
//! A camera from above has parallel rays, straight down. Its depth is linear: 1 above all ground, 0
//! below it, and w is 1. Everything that depends on the distance from the eye (levels of detail,
//! widths, classes) uses the distance at which a perspective camera has pixels of the same size:
//! [`Camera::seeing_distance_m`].

use corniche_geom::Bounds;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// Vertical field of view of every camera of this crate.
pub(crate) const FOV_Y_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Additional distance of the camera from a box that it frames, as a share of the minimum distance.
const FRAME_MARGIN: f64 = 0.03;
/// Distance of the near plane, as a share of the distance to the camera's target.
const NEAR_SHARE: f64 = 1e-3;

/// An axis-aligned box in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldBox {
    /// West, south and bottom of the box.
    pub min: DVec3,
    /// East, north and top of the box.
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

    /// Middle of the box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Eight corners of the box.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> {
        let Self { min, max } = *self;
        (0..8).map(move |bits| {
            let pick =
                |bit: usize, low: f64, high: f64| if bits >> bit & 1 == 0 { low } else { high };
            DVec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
        })
    }

    /// Distance from `point` to the nearest point of the box; 0 inside the box.
    #[must_use]
    pub fn distance_m(&self, point: DVec3) -> f64 {
        point.distance(point.clamp(self.min, self.max))
    }
}

/// Direction of view: its compass direction and its tilt up from straight down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Orientation {
    /// Heading, clockwise from north; 0 has north at the top of the picture.
    pub heading_deg: f64,
    /// Pitch: 0 looks straight down, 90 at the horizon (as in `MapLibre`).
    pub pitch_deg: f64,
}

/// How the rays of a camera run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CameraProjection {
    /// All rays start at the eye.
    Perspective,
    /// All rays run straight down, from a level plane through the eye.
    FromAbove {
        /// Depth of a plane below all ground; the near plane is above all ground.
        far_m: f64,
    },
}

/// A camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the eye, world metres.
    pub eye_in_world: DVec3,
    /// Projection of the rays.
    pub projection: CameraProjection,
    /// Columns: right, up, backward in world space. Orthonormal.
    pub world_from_view: DMat3,
    /// Width and height of the picture.
    pub size_px: [u32; 2],
    /// Depth of the near plane.
    pub near_m: f64,
    /// Distance to the camera's target; in a view from above, the distance at which a perspective
    /// camera has pixels of this size.
    pub focus_m: f64,
}

/// The view volume as planes: `dot(normal, point) + offset >= 0` inside. It has no far plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frustum {
    planes: [DVec4; 5],
}

impl Camera {
    /// A camera that looks at `target_in_world` from `distance_m` away. `size_px` must not contain
    /// a 0.
    #[must_use]
    pub fn look_at(
        target_in_world: DVec3,
        distance_m: f64,
        orientation: Orientation,
        size_px: [u32; 2],
    ) -> Self {
        let backward = world_from_view(orientation).z_axis;
        Self::at_eye(target_in_world + backward * distance_m, distance_m, orientation, size_px)
    }

    /// A camera at `eye_in_world` whose target is `distance_m` away.
    #[must_use]
    pub fn at_eye(
        eye_in_world: DVec3,
        distance_m: f64,
        orientation: Orientation,
        size_px: [u32; 2],
    ) -> Self {
        Self {
            eye_in_world,
            projection: CameraProjection::Perspective,
            world_from_view: world_from_view(orientation),
            size_px,
            near_m: distance_m * NEAR_SHARE,
            focus_m: distance_m,
        }
    }

    /// A camera that looks at `subject` from the minimum distance at which all of it is in the
    /// picture, centred, with a small margin.
    #[must_use]
    pub fn framing(subject: WorldBox, orientation: Orientation, size_px: [u32; 2]) -> Self {
        let world_from_view = world_from_view(orientation);
        let view_from_world = world_from_view.transpose();
        let tan = half_extent_at_unit_depth(size_px);
        let corners: Vec<DVec3> =
            subject.corners().map(|corner| view_from_world * (corner - subject.center())).collect();
        // With the eye at (ox, oy, d) in view axes around the centre, a corner (x, y, z) is inside
        // iff
        // |x − ox| ≤ tan.x · (d − z), that is d ≥ z + (x − ox) / tan.x and d ≥ z − (x − ox) / tan.x; likewise for
        // y. The minimum distance for which such ox and oy exist is where both bounds are equal.
        let reach = |sign: f64| {
            let bounds = corners.iter().map(|corner| sign * corner.truncate() / tan + corner.z);
            bounds.reduce(DVec2::max).unwrap_or_default()
        };
        let least_m = ((reach(1.0) + reach(-1.0)) / 2.0).max_element();
        let distance_m = least_m.max(1.0) * (1.0 + FRAME_MARGIN);
        // The box is centred where the free borders on both sides are equal. Moving the eye to the
        // right moves everything to the left, so bisection finds that position.
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

    /// A camera that looks straight down with parallel rays. `place_in_world` is in the middle of
    /// the picture, a pixel is `pixel_m` world metres wide, and all ground is between
    /// `heights_in_world`; the eye is above it. `size_px` must not contain a 0.
    #[must_use]
    pub fn from_above(
        place_in_world: DVec2,
        pixel_m: f64,
        heading_deg: f64,
        heights_in_world: [f64; 2],
        size_px: [u32; 2],
    ) -> Self {
        let orientation = Orientation { heading_deg, pitch_deg: 0.0 };
        let distance_m = pixel_m / pixel_at_unit_depth_m(size_px);
        // Ground at the very end of the range would have the depth that means "no ground".
        let [lowest, highest] = heights_in_world;
        let margin_m = 0.01 * (highest - lowest) + 1.0;
        let eye_in_world = place_in_world.extend(highest + 2.0 * margin_m);
        Self {
            eye_in_world,
            projection: CameraProjection::FromAbove { far_m: eye_in_world.z - lowest + margin_m },
            near_m: margin_m,
            ..Self::look_at(eye_in_world, distance_m, orientation, size_px)
        }
    }

    /// A camera that looks straight down with parallel rays on all of `subject`, centred, with a
    /// small margin. All ground is between `heights_in_world`.
    #[must_use]
    pub fn framing_from_above(
        subject: WorldBox,
        heading_deg: f64,
        heights_in_world: [f64; 2],
        size_px: [u32; 2],
    ) -> Self {
        let axes = world_from_view(Orientation { heading_deg, pitch_deg: 0.0 });
        let half = subject
            .corners()
            .map(|corner| (axes.transpose() * (corner - subject.center())).truncate().abs())
            .fold(DVec2::ZERO, DVec2::max);
        let [width, height] = size_px.map(f64::from);
        let pixel_m = (2.0 * half / DVec2::new(width, height)).max_element().max(1e-3);
        let pixel_m = pixel_m * (1.0 + FRAME_MARGIN);
        Self::from_above(
            subject.center().truncate(),
            pixel_m,
            heading_deg,
            heights_in_world,
            size_px,
        )
    }

    /// The distance from the eye that decides how large things look at a point, and so what is
    /// shown there. In a view from above it is the same everywhere.
    #[must_use]
    pub fn seeing_distance_m(&self, point_in_world: DVec3) -> f64 {
        match self.projection {
            CameraProjection::Perspective => self.eye_in_world.distance(point_in_world),
            CameraProjection::FromAbove { .. } => self.focus_m,
        }
    }

    /// The minimum [`Camera::seeing_distance_m`] over the points of a box.
    #[must_use]
    pub fn seeing_distance_of_box_m(&self, subject: &WorldBox) -> f64 {
        self.seeing_distance_m(self.eye_in_world.clamp(subject.min, subject.max))
    }

    /// Side of a pixel, metres on the ground, at a view depth.
    #[must_use]
    pub fn pixel_at_depth_m(&self, depth_m: f64) -> f64 {
        self.pixel_at_unit_depth_m()
            * match self.projection {
                CameraProjection::Perspective => depth_m,
                CameraProjection::FromAbove { .. } => self.focus_m,
            }
    }

    /// The camera's target; in a view from above, a point in the middle of the heights.
    #[must_use]
    pub fn target_in_world(&self) -> DVec3 {
        let depth_m = match self.projection {
            CameraProjection::Perspective => self.focus_m,
            CameraProjection::FromAbove { far_m } => f64::midpoint(self.near_m, far_m),
        };
        self.eye_in_world - self.world_from_view.z_axis * depth_m
    }

    /// Returns the same view with `factor` times as many pixels on each side.
    #[must_use]
    pub fn supersampled(&self, factor: u32) -> Self {
        Self { size_px: self.size_px.map(|side| side * factor), ..*self }
    }

    /// Half width and half height of the visible rectangle at depth 1.
    pub(crate) fn half_extent_at_unit_depth(&self) -> DVec2 {
        half_extent_at_unit_depth(self.size_px)
    }

    /// Side of a pixel at depth 1, in metres.
    #[must_use]
    pub fn pixel_at_unit_depth_m(&self) -> f64 {
        pixel_at_unit_depth_m(self.size_px)
    }

    /// Half width and half height of the visible rectangle at depth 1, or in a view from above at
    /// any depth.
    pub(crate) fn half_extent(&self) -> DVec2 {
        self.half_extent_at_unit_depth()
            * match self.projection {
                CameraProjection::Perspective => 1.0,
                CameraProjection::FromAbove { .. } => self.focus_m,
            }
    }

    /// Converts a value of the depth buffer to view depth.
    #[must_use]
    pub fn depth_m(&self, depth_buffer: f64) -> f64 {
        match self.projection {
            CameraProjection::Perspective => self.near_m / depth_buffer,
            CameraProjection::FromAbove { far_m } => far_m - depth_buffer * (far_m - self.near_m),
        }
    }

    /// The matrix from positions relative to the eye (world axes) to clip space.
    pub(crate) fn clip_from_relative(&self) -> DMat4 {
        let half = self.half_extent();
        let columns = match self.projection {
            // Rows: x / tan.x, y / tan.y, near, −z.
            CameraProjection::Perspective => {
                [DVec4::new(0.0, 0.0, 0.0, -1.0), DVec4::new(0.0, 0.0, self.near_m, 0.0)]
            }
            // Rows: x / half width, y / half height, (far + z) / (far − near), 1.
            CameraProjection::FromAbove { far_m } => {
                let range_m = far_m - self.near_m;
                [
                    DVec4::new(0.0, 0.0, 1.0 / range_m, 0.0),
                    DVec4::new(0.0, 0.0, far_m / range_m, 1.0),
                ]
            }
        };
        let clip_from_view = DMat4::from_cols(
            DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
            columns[0],
            columns[1],
        );
        clip_from_view * DMat4::from_mat3(self.world_from_view.transpose())
    }

    /// Projects a point: returns its pixel position (0, 0 is the picture's upper left corner; pixel
    /// centres are at halves) and depth; `None` behind the near plane.
    #[must_use]
    pub fn project(&self, point_in_world: DVec3) -> Option<(DVec2, f64)> {
        let from_eye = point_in_world - self.eye_in_world;
        let clip = self.clip_from_relative() * from_eye.extend(1.0);
        let depth_m = match self.projection {
            CameraProjection::Perspective => clip.w,
            CameraProjection::FromAbove { .. } => -from_eye.dot(self.world_from_view.z_axis),
        };
        let [width, height] = self.size_px.map(f64::from);
        (depth_m >= self.near_m).then(|| {
            let x_px = (0.5 + 0.5 * clip.x / clip.w) * width;
            let y_px = (0.5 - 0.5 * clip.y / clip.w) * height;
            (DVec2::new(x_px, y_px), depth_m)
        })
    }

    /// Direction in world space through a pixel position, scaled so that its depth is 1: a point at
    /// depth d along it is `ray_start + d · ray`.
    #[must_use]
    pub fn ray_in_world(&self, pixel: DVec2) -> DVec3 {
        match self.projection {
            CameraProjection::Perspective => {
                self.world_from_view * self.in_picture(pixel).extend(-1.0)
            }
            CameraProjection::FromAbove { .. } => -self.world_from_view.z_axis,
        }
    }

    /// Start of the ray through a pixel position, at depth 0.
    #[must_use]
    pub fn ray_start_in_world(&self, pixel: DVec2) -> DVec3 {
        match self.projection {
            CameraProjection::Perspective => self.eye_in_world,
            CameraProjection::FromAbove { .. } => {
                self.eye_in_world + self.world_from_view * self.in_picture(pixel).extend(0.0)
            }
        }
    }

    /// A pixel position along the right and up axes of the view, from the middle of the picture:
    /// metres at depth 1, in a view from above at any depth.
    fn in_picture(&self, pixel: DVec2) -> DVec2 {
        let half = self.half_extent();
        let [width, height] = self.size_px.map(f64::from);
        DVec2::new((2.0 * pixel.x / width - 1.0) * half.x, (1.0 - 2.0 * pixel.y / height) * half.y)
    }

    /// The view volume of the camera.
    pub(crate) fn frustum(&self) -> Frustum {
        let plane = |normal_in_view: DVec3, offset: f64| {
            let normal = self.world_from_view * normal_in_view;
            normal.extend(offset - normal.dot(self.eye_in_world))
        };
        // The sides meet in the eye, or run straight down next to it.
        let half = self.half_extent();
        let (spread, aside) = match self.projection {
            CameraProjection::Perspective => (half, DVec2::ZERO),
            CameraProjection::FromAbove { .. } => (DVec2::ZERO, half),
        };
        Frustum {
            planes: [
                plane(DVec3::new(1.0, 0.0, -spread.x), aside.x),
                plane(DVec3::new(-1.0, 0.0, -spread.x), aside.x),
                plane(DVec3::new(0.0, 1.0, -spread.y), aside.y),
                plane(DVec3::new(0.0, -1.0, -spread.y), aside.y),
                plane(DVec3::NEG_Z, -self.near_m),
            ],
        }
    }
}

impl Frustum {
    /// Whether a part of the box may be in view. It is never false for a box that is in view, but
    /// true for some boxes that are not.
    ///
    /// Source: Assarsson & Möller 2000, *Optimized View Frustum Culling Algorithms for Bounding
    /// Boxes*: only the corner farthest along each plane's normal is tested.
    pub(crate) fn may_see(&self, subject: &WorldBox) -> bool {
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = DVec3::select(normal.cmpge(DVec3::ZERO), subject.max, subject.min);
            normal.dot(farthest) + plane.w >= 0.0
        })
    }
}

fn pixel_at_unit_depth_m([_, height]: [u32; 2]) -> f64 {
    2.0 * libm::tan(FOV_Y_RAD / 2.0) / f64::from(height)
}

fn half_extent_at_unit_depth([width, height]: [u32; 2]) -> DVec2 {
    let tan = libm::tan(FOV_Y_RAD / 2.0);
    DVec2::new(tan * f64::from(width) / f64::from(height), tan)
}

fn world_from_view(Orientation { heading_deg, pitch_deg }: Orientation) -> DMat3 {
    // Looking straight down with north up, view axes equal world axes. Tilting up turns about the
    // right axis, heading about the vertical, clockwise seen from above.
    DMat3::from_rotation_z(-heading_deg.to_radians())
        * DMat3::from_rotation_x(pitch_deg.to_radians())
}

#[cfg(test)]
#[path = "camera_tests.rs"]
mod tests;
