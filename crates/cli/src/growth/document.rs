//! The growth table as a JSON document.

use corniche_tileset::Manifest;

use super::factors::{PAPER_GROWTH, of_level, whole};
use crate::documents::growth::{
    GrowthDocument, LayerBytesDocument, LevelGrowthDocument, WholeGrowthDocument,
};

/// Creates the document from a manifest.
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
            factors,
        }
    };
    GrowthDocument {
        rows: manifest.growth.clone(),
        levels: manifest.levels.iter().map(|record| level(record.level)).collect(),
        all_levels: WholeGrowthDocument {
            source_vertices: all.source_vertices,
            geo_vertices: all.geo_vertices,
            growth_over_source: all_factors.growth_over_source,
            raw_bytes_over_source: all_factors.raw_bytes_over_source,
            stored_bytes_over_source: all_factors.stored_bytes_over_source,
        },
        paper: PAPER_GROWTH,
        layers: manifest
            .layers
            .iter()
            .map(|layer| LayerBytesDocument {
                layer: layer.table.id.clone(),
                stored_bytes: layer.levels.iter().map(|level| level.bytes).sum(),
            })
            .collect(),
    }
}
