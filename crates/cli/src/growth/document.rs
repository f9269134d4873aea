//! The table of growth as a JSON document.

use corniche_tileset::Manifest;

use super::factors::{PAPER_GROWTH, of_level, whole};
use crate::documents::growth::{GrowthDocument, LevelGrowthDocument, WholeGrowthDocument};

/// The table for programs.
pub(crate) fn document(manifest: &Manifest) -> GrowthDocument {
    let (all, all_factors) = whole(manifest);
    let level = |level: u8| {
        let (row, factors) = of_level(manifest, level);
        LevelGrowthDocument {
            level,
            source_vertices: row.source_vertices,
            simplified_vertices: row.simplified_vertices,
            geo_vertices: row.geo_vertices,
            sv_vertices: row.sv_vertices,
            geo_raw_bytes: row.geo_raw_bytes,
            geo_stored_bytes: row.geo_stored_bytes,
            sv_stored_bytes: row.sv_stored_bytes,
            growth_over_simplified: factors.over_simplified,
            growth_over_source: factors.over_source,
            raw_bytes_over_simplified: factors.raw_over_simplified,
            stored_bytes_over_simplified: factors.stored_over_simplified,
            raw_bytes_over_source: factors.raw_bytes,
            stored_bytes_over_source: factors.stored_bytes,
        }
    };
    GrowthDocument {
        rows: manifest.growth.iter().map(Into::into).collect(),
        levels: manifest.levels.iter().map(|record| level(record.level)).collect(),
        all_levels: WholeGrowthDocument {
            source_vertices: all.source_vertices,
            geo_vertices: all.geo_vertices,
            growth_over_source: all_factors.over_source,
            raw_bytes_over_source: all_factors.raw_bytes,
            stored_bytes_over_source: all_factors.stored_bytes,
        },
        paper: PAPER_GROWTH,
    }
}
