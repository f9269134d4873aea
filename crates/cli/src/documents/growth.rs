//! The JSON document of `corniche growth`.

use corniche_tileset::GrowthRow;
use schemars::JsonSchema;
use serde::Serialize;

#[cfg(test)]
use crate::documents::info_schema::RowDocument;

/// The cost of draping roads on the terrain: growth is the number of vertices that clipping
/// (splitting at the edges of the triangles) adds.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct GrowthDocument {
    /// One row per level and class.
    #[cfg_attr(test, schemars(with = "Vec<RowDocument>"))]
    pub rows: Vec<GrowthRow>,
    /// One entry per level.
    pub levels: Vec<LevelGrowthDocument>,
    /// All levels, compared with one copy of the source.
    pub all_levels: WholeGrowthDocument,
    /// Growth of the size of the road data that Vaaraniemi, Treib & Westermann 2011 report (section
    /// 7, "about"), as a factor.
    pub paper: f64,
    /// The layers, which are stored in plan and do not grow; omitted if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerBytesDocument>,
}

/// The bytes of a layer.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LayerBytesDocument {
    /// The id of the layer.
    pub layer: String,
    /// Stored bytes of its sections on all levels.
    pub stored_bytes: u64,
}

/// The cost of one level, all classes. Ratios with a denominator of 0 are null.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LevelGrowthDocument {
    /// Level.
    pub level: u8,
    /// Points of the source lines in tiles with ground.
    pub source_vertices: u64,
    /// Points of the level's simplified lines in tiles with ground.
    pub simplified_vertices: u64,
    /// Vertices of the clipped lines.
    pub geo_vertices: u64,
    /// Points of the plan lines for shadow volumes.
    pub sv_vertices: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    pub geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored.
    pub geo_stored_bytes: u64,
    /// Bytes of the plan lines as stored.
    pub sv_stored_bytes: u64,
    /// The growth factors.
    #[serde(flatten)]
    pub factors: Factors,
}

/// The growth factors of a row, or of a sum of rows. Ratios with a denominator of 0 are null.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Factors {
    /// Clipped vertices over simplified ones.
    pub growth_over_simplified: Option<f64>,
    /// Clipped vertices over those of the source.
    pub growth_over_source: Option<f64>,
    /// Clipped bytes, raw, over those of the simplified lines.
    pub raw_bytes_over_simplified: Option<f64>,
    /// Clipped bytes, stored, over those of the simplified lines.
    pub stored_bytes_over_simplified: Option<f64>,
    /// Clipped bytes, raw, over those of the source.
    pub raw_bytes_over_source: Option<f64>,
    /// Clipped bytes, stored, over those of the source.
    pub stored_bytes_over_source: Option<f64>,
}

/// The cost of all levels together. Ratios with a denominator of 0 are null.
#[derive(Serialize, JsonSchema)]
pub(crate) struct WholeGrowthDocument {
    /// Points of the source lines, once.
    pub source_vertices: u64,
    /// Vertices of the clipped lines of all levels.
    pub geo_vertices: u64,
    /// Clipped vertices over those of the source.
    pub growth_over_source: Option<f64>,
    /// Clipped bytes, raw, over those of the source.
    pub raw_bytes_over_source: Option<f64>,
    /// Clipped bytes, stored, over those of the source.
    pub stored_bytes_over_source: Option<f64>,
}

/// A comparison of several packages.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ComparisonDocument {
    /// The packages, in the order of the command line.
    pub packages: Vec<ComparedDocument>,
    /// Settings and inputs that differ, apart from cell and error bound. If there are any,
    /// differences in growth may also result from them.
    pub differences: Vec<DifferenceDocument>,
}

/// One of the compared packages.
#[derive(Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ComparedDocument {
    /// Path of the package, as given.
    pub package: String,
    /// Cell size of the finest level, east and north, working metres.
    pub cell_m: [f64; 2],
    /// The package's `--max-error`, metres.
    pub max_error_m: f64,
    /// The document that `corniche growth --json` prints for this package alone.
    pub growth: GrowthDocument,
}

/// A setting or input in which packages differ.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DifferenceDocument {
    /// Name of the setting or input, such as "extract", "classes by level", "voids filled" or
    /// "polygon".
    pub what: String,
    /// The values, at least two.
    pub values: Vec<DifferentValueDocument>,
}

/// A value, and the packages that have it.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DifferentValueDocument {
    /// Paths of the packages that have it.
    pub packages: Vec<String>,
    /// The value as text.
    pub value: String,
}
