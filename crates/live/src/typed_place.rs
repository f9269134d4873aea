//! "Go to": the place that a user types.

use corniche_tileset::Manifest;
use corniche_viewer::parse_lon_lat;
use glam::DVec3;

use crate::controls::KnownGround;

/// The ground at the place that a text tells, in world metres.
///
/// # Errors
/// In words, when the text tells no place or there is no ground.
pub fn place_in_world(
    text: &str,
    manifest: &Manifest,
    ground: &dyn KnownGround,
) -> Result<DVec3, String> {
    let [lon_deg, lat_deg] = parse_lon_lat(text).map_err(|error| error.to_string())?;
    let at = |lon_lat_deg| {
        let [x, y] = manifest.coordinates.working_from_wgs84(lon_lat_deg)?;
        Some(DVec3::new(x, y, ground.height([x, y])?))
    };
    at([lon_deg, lat_deg]).ok_or_else(|| {
        let [west, south, east, north] = manifest.wgs84_bounds.to_array();
        let hint = if at([lat_deg, lon_deg]).is_some() {
            "; longitude comes first: are the two numbers the wrong way round?"
        } else {
            ""
        };
        format!(
            "there is no ground at longitude {lon_deg}, latitude {lat_deg}; the package covers longitudes {west:.4} to \
             {east:.4} and latitudes {south:.4} to {north:.4}{hint}"
        )
    })
}
