//! The camera that a picture or a new window is asked to begin with.

use corniche_tileset::Manifest;
use glam::DVec3;

use crate::{
    camera::{Camera, Orientation, WorldBox},
    tiles::{LoadTileError, TileSource, TileStore},
};

/// Where to look from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CameraRequest {
    /// The whole package, obliquely from the south.
    FrameAll,
    /// A place on the ground from a distance.
    LookAt {
        /// Longitude of the place, WGS84.
        lon_deg: f64,
        /// Latitude of the place, WGS84.
        lat_deg: f64,
        /// Distance from the eye to the place, true metres.
        distance_m: f64,
        /// Direction of view.
        orientation: Orientation,
    },
}

/// The place to look at has no ground.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "longitude {lon_deg}, latitude {lat_deg} has no ground: it lies in a void, at the data's edge or outside the \
     package, which covers {covered_deg:?} (west, south, east, north in degrees)"
)]
pub struct OffGround {
    /// Its longitude, WGS84.
    pub lon_deg: f64,
    /// Its latitude, WGS84.
    pub lat_deg: f64,
    /// What the package covers: west, south, east, north.
    pub covered_deg: [f64; 4],
}

/// Why the camera cannot be set up as asked.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
pub enum ViewpointError {
    #[error(transparent)]
    OffGround(#[from] OffGround),
    #[error(transparent)]
    Load(#[from] LoadTileError),
}

impl CameraRequest {
    /// Direction of view.
    #[must_use]
    pub fn orientation(self) -> Orientation {
        match self {
            Self::FrameAll => Orientation { heading_deg: 0.0, pitch_deg: 45.0 },
            Self::LookAt { orientation, .. } => orientation,
        }
    }

    /// The camera for a package with this manifest and these tiles. Its ground lies between the true heights
    /// `height_range_m`; world heights are `vertical_scale` times true ones.
    ///
    /// # Errors
    /// When the place has no ground, or a tile there cannot be read.
    pub fn camera(
        self,
        manifest: &Manifest,
        source: &dyn TileSource,
        height_range_m: [f64; 2],
        vertical_scale: f64,
        size_px: [u32; 2],
    ) -> Result<Camera, ViewpointError> {
        match self {
            Self::FrameAll => {
                let range_m = height_range_m.map(|height_m| height_m * vertical_scale);
                let subject = WorldBox::new(manifest.data_bounds, range_m);
                Ok(Camera::framing(subject, self.orientation(), size_px))
            }
            Self::LookAt { lon_deg, lat_deg, distance_m, orientation } => {
                let covered_deg = manifest.wgs84_bounds.to_array();
                let off_ground = OffGround { lon_deg, lat_deg, covered_deg };
                let at = manifest.coordinates.working_from_wgs84([lon_deg, lat_deg]);
                let at = at.ok_or(off_ground)?;
                let height_m = TileStore::new(source).ground_height_m(at)?.ok_or(off_ground)?;
                let target = DVec3::new(at[0], at[1], height_m * vertical_scale);
                let distance_in_world_m = distance_m * manifest.point_scale;
                Ok(Camera::look_at(target, distance_in_world_m, orientation, size_px))
            }
        }
    }
}
