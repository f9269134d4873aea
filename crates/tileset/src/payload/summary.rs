//! What the ground of a tile states about itself, without its triangles.

use corniche_geom::{GridFrame, TileId};

use crate::payload::context::Context;
use crate::payload::damage::DecodeError;
use crate::payload::section_kind::Kind;
use crate::payload::terrain;
use crate::payload::tile_payload::TerrainSummary;

/// Reads what the ground of a tile states about itself; `None` without ground. Its triangles are not decoded: this is for tiles that
/// are looked at to find those that are drawn.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, the section is damaged, or what it states is impossible. What the triangles are coded
/// in is covered by the section's checksum alone.
pub fn terrain_summary(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    quantum_m: f64,
) -> Result<Option<TerrainSummary>, DecodeError> {
    let (context, sections) = Context::open(bytes, id, frame, quantum_m)?;
    let failed = |damage| DecodeError { tile: id, part: Kind::Terrain.name(), damage };
    let record = terrain::record_in(&sections, context.scale).map_err(failed)?;
    Ok(record.map(|record| TerrainSummary {
        geometric_error_m: record.geometric_error_m,
        height_range_m: record.height_range_m,
    }))
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
