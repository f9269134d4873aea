//! The summary of the ground of a tile, without its triangles.

use corniche_geom::{GridFrame, TileId};

use crate::payload::{
    context::CodingContext, damage::DecodeError, section_kind::SectionKind, terrain,
    tile_payload::TerrainSummary,
};

/// Reads the summary of the ground of a tile; `None` without ground. The triangles are not decoded:
/// this function is for tiles that are inspected to find the tiles to draw.
///
/// # Errors
/// When the bytes are not a payload of tile `id`, the section is damaged, or the summary is
/// invalid. The coded bits of the triangles are only covered by the section's checksum.
pub fn terrain_summary(
    bytes: &[u8],
    id: TileId,
    frame: &GridFrame,
    quantum_m: f64,
) -> Result<Option<TerrainSummary>, DecodeError> {
    let (context, sections) = CodingContext::open(bytes, id, frame, quantum_m)?;
    let record = terrain::record_in(&sections, context.scale);
    let record = record.map_err(SectionKind::Terrain.damaged(id))?;
    Ok(record.map(|record| TerrainSummary {
        geometric_error_m: record.geometric_error_m,
        height_range_m: record.height_range_m,
    }))
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
