//! The ground under the cursor and the scale in the middle of the image, found by rays into the
//! scene.

use corniche_geom::CoordinateTable;
use corniche_viewer::camera::Camera;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use crate::controls::KnownGround;

/// A place on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPoint {
    /// Longitude and latitude, WGS84.
    pub lon_lat_deg: [f64; 2],
    /// x and y in the working CRS, true height.
    pub at_m: [f64; 3],
}

impl GroundPoint {
    /// The place at a point of the world.
    pub(crate) fn from_world(
        in_world: DVec3,
        vertical_scale: f64,
        coordinates: &CoordinateTable,
    ) -> Self {
        let DVec3 { x, y, z } = in_world;
        let lon_lat_deg = coordinates.wgs84_from_working([x, y]);
        Self { lon_lat_deg, at_m: [x, y, z / vertical_scale] }
    }

    /// The place as JSON for a page.
    pub(crate) fn record(&self) -> Value {
        let ([lon, lat], [.., height]) = (self.lon_lat_deg, self.at_m);
        json!({ "lon": lon, "lat": lat, "height": height })
    }
}

/// The results of rays into the scene. They are kept while neither the scene nor the cursor
/// changes.
#[derive(Default)]
pub struct GroundProbe {
    cursor_px: Option<DVec2>,
    /// The ground under the cursor, and the side of a pixel there in world metres.
    cursor: Option<(GroundPoint, f64)>,
    /// The side of a pixel on the ground in the middle of the window, in world metres.
    pub middle_pixel_m: Option<f64>,
}

impl GroundProbe {
    /// Updates what may have changed. `is_new` means that the scene has changed.
    pub fn look(
        &mut self,
        camera: &Camera,
        cursor_px: Option<DVec2>,
        is_new: bool,
        ground: &dyn KnownGround,
        vertical_scale: f64,
        coordinates: &CoordinateTable,
    ) {
        let pixel_m = |at_px: DVec2| {
            let hit = ground.under(camera, at_px)?;
            let (_, depth_m) = camera.project(hit)?;
            Some((hit, camera.pixel_at_depth_m(depth_m)))
        };
        if is_new {
            let [width, height] = camera.size_px.map(f64::from);
            self.middle_pixel_m =
                pixel_m(DVec2::new(width, height) / 2.0).map(|(_, pixel_m)| pixel_m);
        }
        if is_new || self.cursor_px != cursor_px {
            self.cursor = cursor_px.and_then(pixel_m).map(|(hit, pixel_m)| {
                (GroundPoint::from_world(hit, vertical_scale, coordinates), pixel_m)
            });
            self.cursor_px = cursor_px;
        }
    }

    /// The ground under the cursor.
    #[must_use]
    pub fn cursor(&self) -> Option<GroundPoint> {
        self.cursor.map(|(point, _)| point)
    }

    /// The side of a pixel on the ground under the cursor, in world metres.
    #[must_use]
    pub fn cursor_pixel_m(&self) -> Option<f64> {
        self.cursor.map(|(_, pixel_m)| pixel_m)
    }
}
