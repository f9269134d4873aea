//! The levels of a package, in the document of `corniche info`.

use corniche_tileset::{Distribution, LevelRecord, SampleErrorRecord};
use serde::Serialize;

#[cfg(test)]
use crate::documents::record_schemas::{DistributionDocument, SamplesDocument};

/// What a level is, and how close it is to the data.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Spacing of its nodes, east and north, working metres.
    cell_m: [f64; 2],
    /// Meshing tolerance against the level's own raster.
    max_error_m: f64,
    /// Largest stored geometric error of its tiles.
    geometric_error_m: f64,
    /// Stored geometric errors of its tiles; null on a level without tiles.
    #[cfg_attr(test, schemars(with = "Option<DistributionDocument>"))]
    errors_m: Option<Distribution>,
    /// How far its TINs are from the DEM's own samples.
    #[cfg_attr(test, schemars(with = "SamplesDocument"))]
    sample_error: SampleErrorRecord,
    /// Stored error over the largest true one, where that can be measured.
    #[cfg_attr(test, schemars(with = "Option<DistributionDocument>"))]
    tightness: Option<Distribution>,
    /// Least important class shown on this level; null shows no road.
    least_class: Option<u8>,
    /// Tolerance of the simplification of roads; 0 keeps every point.
    simplify_tolerance_m: f64,
    /// How far outside a tile its plan lines reach.
    width_margin_m: f64,
    /// Tiles with ground.
    tiles: u64,
    /// Triangles in them.
    triangles: u64,
    /// Vertices in them.
    vertices: u64,
    /// Stored bytes of their ground.
    terrain_bytes: u64,
    /// Stored bytes of their relief; 0 without.
    relief_bytes: u64,
    /// Full-resolution nodes with data that the level's TINs do not cover.
    uncovered_nodes: u64,
}

impl From<&LevelRecord> for LevelDocument {
    fn from(level: &LevelRecord) -> Self {
        Self {
            level: level.level,
            cell_m: level.cell_m.to_array(),
            max_error_m: level.max_error_m,
            geometric_error_m: level.geometric_error_m,
            errors_m: level.errors_m,
            sample_error: level.sample_error,
            tightness: level.tightness,
            least_class: level.least_class,
            simplify_tolerance_m: level.simplify_tolerance_m,
            width_margin_m: level.width_margin_m,
            tiles: level.tiles,
            triangles: level.triangles,
            vertices: level.vertices,
            terrain_bytes: level.terrain_bytes,
            relief_bytes: level.relief_bytes,
            uncovered_nodes: level.uncovered_nodes,
        }
    }
}
