//! The camera that a picture or a new window is asked to begin with.

use corniche_tileset::Manifest;
use glam::{DVec2, DVec3};

use crate::{
    camera::{Camera, Orientation, WorldBox},
    tiles::MapExtent,
};

/// Where to look from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CameraRequest {
    /// Where the roads are, or the whole package if it has none, obliquely from the south.
    Overview,
    /// A place on the ground from a distance.
    LookAt {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// True height of the place, metres; `None`: that of the ground there, which must have some.
        height_m: Option<f64>,
        /// Distance from the eye to the place, true metres.
        distance_m: f64,
        /// Direction of view.
        orientation: Orientation,
    },
    /// Where the roads are, or the whole package, straight from above with parallel rays and north up.
    OverviewFromAbove {
        /// Side of a pixel, true metres: the middle of the overview is in the middle of the picture. `None`: all of it is in the picture.
        pixel_m: Option<f64>,
    },
    /// A place straight from above with parallel rays. It needs no ground.
    FromAbove {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// Side of a pixel, true metres.
        pixel_m: f64,
        /// What is at the top of the picture, clockwise from north.
        heading_deg: f64,
    },
}

/// The place to look at has no ground.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "longitude {lon_deg}, latitude {lat_deg} has no ground: it lies in a void, at the data's edge or outside the \
     package, which covers {covered}"
)]
pub struct OffGround {
    /// Its longitude, WGS84.
    pub lon_deg: f64,
    /// Its latitude, WGS84.
    pub lat_deg: f64,
    /// What the package covers, in words.
    pub covered: String,
}

/// The ground that a camera is set up by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SightedGround {
    /// What [`CameraRequest::Overview`] shows.
    pub extent: MapExtent,
    /// All ground of the package lies between these true heights.
    pub heights_m: [f64; 2],
    /// True height of the ground at [`CameraRequest::place`]; `None` if there is no ground or no place. It does not count where a height
    /// is given.
    pub at_place_m: Option<f64>,
}

impl CameraRequest {
    /// Direction of view.
    #[must_use]
    pub fn orientation(self) -> Orientation {
        match self {
            Self::Overview => Orientation { heading_deg: 0.0, pitch_deg: 45.0 },
            Self::LookAt { orientation, .. } => orientation,
            Self::OverviewFromAbove { .. } => Orientation { heading_deg: 0.0, pitch_deg: 0.0 },
            Self::FromAbove { heading_deg, .. } => Orientation { heading_deg, pitch_deg: 0.0 },
        }
    }

    /// Whether it shows where the roads are, and not a place that was named.
    #[must_use]
    pub fn is_overview(self) -> bool {
        matches!(self, Self::Overview | Self::OverviewFromAbove { .. })
    }

    /// The place to look at, in the working CRS: [`CameraRequest::camera`] needs the height of the ground there. `None` for
    /// an overview.
    ///
    /// # Errors
    /// When it lies too far away from the package to have a position in the working CRS.
    pub fn place(self, manifest: &Manifest) -> Result<Option<[f64; 2]>, OffGround> {
        let (Self::LookAt { lon_deg, lat_deg, .. } | Self::FromAbove { lon_deg, lat_deg, .. }) =
            self
        else {
            return Ok(None);
        };
        let at = manifest.coordinates.working_from_wgs84([lon_deg, lat_deg]);
        at.map(Some).ok_or_else(|| off_ground(lon_deg, lat_deg, manifest))
    }

    /// The camera for a package with this manifest and this ground. World heights are `vertical_scale` times true ones.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn camera(
        self,
        manifest: &Manifest,
        ground: SightedGround,
        vertical_scale: f64,
        size_px: [u32; 2],
    ) -> Result<Camera, OffGround> {
        let in_world =
            |heights_m: [f64; 2]| heights_m.map(|height_m: f64| height_m * vertical_scale);
        let subject = WorldBox::new(ground.extent.plan, in_world(ground.extent.heights_m));
        let all = in_world(ground.heights_m);
        match self {
            Self::Overview => Ok(Camera::framing(subject, self.orientation(), size_px)),
            Self::OverviewFromAbove { pixel_m: None } => {
                Ok(Camera::framing_from_above(subject, 0.0, all, size_px))
            }
            Self::OverviewFromAbove { pixel_m: Some(pixel_m) } => {
                let middle = subject.center().truncate();
                let pixel_in_world_m = pixel_m * manifest.point_scale;
                Ok(Camera::from_above(middle, pixel_in_world_m, 0.0, all, size_px))
            }
            Self::FromAbove { lon_deg, lat_deg, pixel_m, heading_deg } => {
                let Some([x, y]) = self.place(manifest)? else {
                    return Err(off_ground(lon_deg, lat_deg, manifest));
                };
                let target = DVec2::new(x, y);
                let pixel_in_world_m = pixel_m * manifest.point_scale;
                Ok(Camera::from_above(target, pixel_in_world_m, heading_deg, all, size_px))
            }
            Self::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
                let height_m = height_m.or(ground.at_place_m);
                let (Some([x, y]), Some(height_m)) = (self.place(manifest)?, height_m) else {
                    return Err(off_ground(lon_deg, lat_deg, manifest));
                };
                let target = DVec3::new(x, y, height_m * vertical_scale);
                let distance_in_world_m = distance_m * manifest.point_scale;
                Ok(Camera::look_at(target, distance_in_world_m, orientation, size_px))
            }
        }
    }
}

fn off_ground(lon_deg: f64, lat_deg: f64, manifest: &Manifest) -> OffGround {
    OffGround { lon_deg, lat_deg, covered: manifest.covered_text([lon_deg, lat_deg]) }
}
