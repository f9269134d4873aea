//! The requested camera of a picture or of a new window.

use corniche_tileset::Manifest;
use glam::{DVec2, DVec3};

use crate::{
    camera::{Camera, Orientation, WorldBox},
    tiles::{LoadTileError, MapExtent, TileSource, TileStore},
};

/// The position from which to look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CameraRequest {
    /// View of the roads, or of the whole package if it has no roads, obliquely from the south.
    Overview,
    /// View of a place on the ground from a distance.
    LookAt {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// True height of the place, metres; `None`: the height of the ground there, which must
        /// exist.
        height_m: Option<f64>,
        /// Distance from the eye to the place, true metres.
        distance_m: f64,
        /// Direction of view.
        orientation: Orientation,
    },
    /// View of the roads, or of the whole package, straight from above with parallel rays and north
    /// up.
    OverviewFromAbove {
        /// Side of a pixel, true metres; the middle of the overview is in the middle of the
        /// picture. `None`: the picture shows all of the overview.
        pixel_m: Option<f64>,
    },
    /// View of a place straight from above with parallel rays. It needs no ground.
    FromAbove {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// Side of a pixel, true metres.
        pixel_m: f64,
        /// Heading: the direction at the top of the picture, clockwise from north.
        heading_deg: f64,
    },
}

/// The place to look at has no ground.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "there is no ground at longitude {lon_deg}, latitude {lat_deg} (a void, the edge of the data, or outside the package); {covered}"
)]
pub struct ViewpointOffGround {
    /// Longitude of the place, WGS84.
    pub lon_deg: f64,
    /// Latitude of the place, WGS84.
    pub lat_deg: f64,
    /// Extent of the package, in words.
    pub covered: String,
}

/// The ground on which a camera is based.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SightedGround {
    /// The extent that [`CameraRequest::Overview`] shows.
    pub extent: MapExtent,
    /// All ground of the package is between these true heights.
    pub heights_m: [f64; 2],
    /// True height of the ground at [`CameraRequest::place`]; `None` if there is no ground or no
    /// place. It is ignored if the request has a height.
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

    /// The ground on which the camera is based, without the height at its place; `None` if there is
    /// no ground.
    ///
    /// # Errors
    /// When a tile cannot be read.
    pub fn sighted_ground<S: TileSource + ?Sized>(
        self,
        store: &mut TileStore<'_, S>,
        manifest: &Manifest,
    ) -> Result<Option<SightedGround>, LoadTileError> {
        let data = manifest.data_bounds;
        let Some(coarsest) = store.coarsest_ground()? else { return Ok(None) };
        let heights_m = coarsest.height_range_m;
        let extent = match self {
            Self::Overview | Self::OverviewFromAbove { .. } => store.map_extent(data)?,
            Self::LookAt { .. } | Self::FromAbove { .. } => None,
        };
        let extent = extent.unwrap_or_else(|| MapExtent::of_data(data, heights_m));
        Ok(Some(SightedGround { extent, heights_m, at_place_m: None }))
    }

    /// The requested place, in the working CRS: [`CameraRequest::camera`] needs the height of the
    /// ground there. `None` for an overview.
    ///
    /// # Errors
    /// When the place is too far away from the package to have a position in the working CRS.
    pub fn place(self, manifest: &Manifest) -> Result<Option<[f64; 2]>, ViewpointOffGround> {
        let (Self::LookAt { lon_deg, lat_deg, .. } | Self::FromAbove { lon_deg, lat_deg, .. }) =
            self
        else {
            return Ok(None);
        };
        let at = manifest.coordinates.working_from_wgs84([lon_deg, lat_deg]);
        at.map(Some).ok_or_else(|| off_ground(lon_deg, lat_deg, manifest))
    }

    /// Returns the camera for a package with this manifest and this ground. World heights are
    /// `vertical_scale` times true heights.
    ///
    /// # Errors
    /// When the place has no ground, and no height is given.
    pub fn camera(
        self,
        manifest: &Manifest,
        ground: SightedGround,
        vertical_scale: f64,
        size_px: [u32; 2],
    ) -> Result<Camera, ViewpointOffGround> {
        let in_world =
            |heights_m: [f64; 2]| heights_m.map(|height_m: f64| height_m * vertical_scale);
        let subject = WorldBox::new(ground.extent.plan, in_world(ground.extent.heights_m));
        let all = in_world(ground.heights_m);
        let from_above = |middle: DVec2, pixel_m: f64, heading_deg| {
            let pixel_in_world_m = pixel_m * manifest.point_scale;
            Camera::from_above(middle, pixel_in_world_m, heading_deg, all, size_px)
        };
        let at = self.place(manifest)?;
        match self {
            Self::Overview => Ok(Camera::framing(subject, self.orientation(), size_px)),
            Self::OverviewFromAbove { pixel_m: None } => {
                Ok(Camera::framing_from_above(subject, 0.0, all, size_px))
            }
            Self::OverviewFromAbove { pixel_m: Some(pixel_m) } => {
                Ok(from_above(subject.center().truncate(), pixel_m, 0.0))
            }
            Self::FromAbove { pixel_m, heading_deg, .. } => {
                // Such a request has a place.
                Ok(from_above(at.unwrap_or_default().into(), pixel_m, heading_deg))
            }
            Self::LookAt { lon_deg, lat_deg, height_m, distance_m, orientation } => {
                let height_m = height_m.or(ground.at_place_m);
                let (Some([x, y]), Some(height_m)) = (at, height_m) else {
                    return Err(off_ground(lon_deg, lat_deg, manifest));
                };
                let target = DVec3::new(x, y, height_m * vertical_scale);
                let distance_in_world_m = distance_m * manifest.point_scale;
                Ok(Camera::look_at(target, distance_in_world_m, orientation, size_px))
            }
        }
    }
}

fn off_ground(lon_deg: f64, lat_deg: f64, manifest: &Manifest) -> ViewpointOffGround {
    ViewpointOffGround { lon_deg, lat_deg, covered: manifest.covered_text([lon_deg, lat_deg]) }
}
