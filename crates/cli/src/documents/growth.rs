//! The JSON document of `corniche growth`.

use corniche_tileset::GrowthRow;
use serde::Serialize;

#[cfg(test)]
use crate::documents::info_schema::RowDocument;

/// What laying roads on the terrain costs.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct GrowthDocument {
    /// One for each level and class.
    #[cfg_attr(test, schemars(with = "Vec<RowDocument>"))]
    pub(crate) rows: Vec<GrowthRow>,
    /// One for each level.
    pub(crate) levels: Vec<LevelGrowthDocument>,
    /// All levels, against one copy of the source.
    pub(crate) all_levels: WholeGrowthDocument,
    /// What Vaaraniemi, Treib & Westermann 2011 report (section 7, "about"): times the size of the road data.
    pub(crate) paper: f64,
}

/// What a level costs, all classes. Ratios are null where there is nothing to divide by.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LevelGrowthDocument {
    /// Level.
    pub(crate) level: u8,
    /// Points of the source lines that lie in tiles with ground.
    pub(crate) source_vertices: u64,
    /// Points of the level's simplified lines that lie in tiles with ground.
    pub(crate) simplified_vertices: u64,
    /// Vertices of the clipped lines.
    pub(crate) geo_vertices: u64,
    /// Points of the plan lines for shadow volumes.
    pub(crate) sv_vertices: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    pub(crate) geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored.
    pub(crate) geo_stored_bytes: u64,
    /// Bytes of the plan lines as stored.
    pub(crate) sv_stored_bytes: u64,
    /// What it grew by.
    #[serde(flatten)]
    pub(crate) factors: Factors,
}

/// What a row, or a sum of rows, grew by. Ratios are null where there is nothing to divide by.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct Factors {
    /// Clipped vertices over simplified ones.
    pub(crate) growth_over_simplified: Option<f64>,
    /// Clipped vertices over the source's.
    pub(crate) growth_over_source: Option<f64>,
    /// Clipped bytes, raw, over those of the simplified lines.
    pub(crate) raw_bytes_over_simplified: Option<f64>,
    /// Clipped bytes, stored, over those of the simplified lines.
    pub(crate) stored_bytes_over_simplified: Option<f64>,
    /// Clipped bytes, raw, over the source's.
    pub(crate) raw_bytes_over_source: Option<f64>,
    /// Clipped bytes, stored, over the source's.
    pub(crate) stored_bytes_over_source: Option<f64>,
}

/// What all levels cost together. Ratios are null where there is nothing to divide by.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct WholeGrowthDocument {
    /// Points of the source lines, once.
    pub(crate) source_vertices: u64,
    /// Vertices of the clipped lines of all levels.
    pub(crate) geo_vertices: u64,
    /// Clipped vertices over the source's.
    pub(crate) growth_over_source: Option<f64>,
    /// Clipped bytes, raw, over the source's.
    pub(crate) raw_bytes_over_source: Option<f64>,
    /// Clipped bytes, stored, over the source's.
    pub(crate) stored_bytes_over_source: Option<f64>,
}

/// Several packages beside each other.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ComparisonDocument {
    /// The packages, in the order in which they were named.
    pub(crate) packages: Vec<ComparedDocument>,
    /// In what they differ beside cell and error bound. Where there is something, their growth tells of that, too.
    pub(crate) differences: Vec<DifferenceDocument>,
}

/// One of several packages.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ComparedDocument {
    /// Its path, as it was given.
    pub(crate) package: String,
    /// Cell of its finest level, east and north, working metres.
    pub(crate) cell_m: [f64; 2],
    /// Its `--max-error`, metres.
    pub(crate) max_error_m: f64,
    /// What `corniche growth --json` tells of it alone.
    pub(crate) growth: GrowthDocument,
}

/// Something in which packages differ.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct DifferenceDocument {
    /// Its name in words, such as "extract", "classes by level", "voids filled" or "polygon".
    pub(crate) what: String,
    /// The values, two at least.
    pub(crate) values: Vec<DifferentValueDocument>,
}

/// A value, and who has it.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct DifferentValueDocument {
    /// The packages that have it, by their paths.
    pub(crate) packages: Vec<String>,
    /// In words.
    pub(crate) value: String,
}
