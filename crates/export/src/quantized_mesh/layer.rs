//! layer.json, which describes the available tiles for viewers.

use corniche_tileset::Manifest;
use serde_json::{Value, json};

use super::{
    available::{TileRectangle, beneath, to_json},
    encode::{METADATA_NAME, NORMALS_NAME},
    quantized_mesh_request::{Availability, QuantizedMeshRequest, QuantizedMeshSummary},
    tiling::TerrainTile,
};

/// The file's name.
pub(crate) const LAYER: &str = "layer.json";

/// The interval of levels whose tiles describe the availability of the tiles beneath them. Other
/// writers also use ten.
const METADATA_LEVELS: u8 = 10;

/// Returns the content of layer.json. With [`Availability::Layer`] it lists all tiles.
///
/// `corniche` is a custom member that viewers ignore: the format has no place for errors.
pub(crate) fn layer(
    manifest: &Manifest,
    request: &QuantizedMeshRequest,
    available: &[Vec<TileRectangle>],
    summary: &QuantizedMeshSummary,
) -> Value {
    let data = manifest.wgs84_bounds;
    let bounds = request.bounds.map_or(data, |bounds| bounds.within(data));
    let levels: Vec<Value> = summary
        .levels
        .iter()
        .map(|level| {
            json!({
                "level": level.level,
                "tiles": level.tiles,
                "assumed_error_m": rounded(level.assumed_error_m),
                "deviation_m": (level.places > 0).then(|| rounded(level.deviation_m)),
                "deviation_rms_m": (level.places > 0).then(|| rounded(level.deviation_rms_m)),
            })
        })
        .collect();
    let mut layer = json!({
        "tilejson": "2.1.0",
        "format": "quantized-mesh-1.0",
        "version": "1.0.0",
        "scheme": "tms",
        "projection": request.tiling.projection(),
        "tiles": ["{z}/{x}/{y}.terrain"],
        "minzoom": 0,
        "maxzoom": available.len() - 1,
        "bounds": bounds.to_array(),
        "extensions": [NORMALS_NAME],
        "attribution": manifest.attribution.join("; "),
        "description": format!("heights: {}", summary.heights),
        "corniche": { "levels": levels },
    });
    match request.availability {
        Availability::Layer => layer["available"] = to_json(available),
        Availability::Tiles => {
            layer["extensions"] = json!([NORMALS_NAME, METADATA_NAME]);
            layer["metadataAvailability"] = METADATA_LEVELS.into();
        }
    }
    layer
}

/// Returns the availability of the tiles beneath a tile, if it describes them.
///
/// `CesiumJS` (1.145) fails at a tile with metadata if layer.json has no `metadataAvailability`, so
/// with [`Availability::Layer`] no tile has metadata.
pub(crate) fn metadata(
    request: &QuantizedMeshRequest,
    available: &[Vec<TileRectangle>],
    tile: TerrainTile,
) -> Option<String> {
    let tells =
        request.availability == Availability::Tiles && tile.z.is_multiple_of(METADATA_LEVELS);
    let beneath = || beneath(available, tile, METADATA_LEVELS);
    tells.then(|| json!({ "available": to_json(&beneath()) }).to_string())
}

/// Rounds to millimetres.
fn rounded(metres: f64) -> f64 {
    (metres * 1e3).round() / 1e3
}
