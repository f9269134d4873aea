//! Errors of reading a style.

use corniche_layers::LayerGeometry;

use crate::style_preset_names;

/// Why a text is not a valid style. The caller knows which file the text came from.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum StyleError {
    #[error("the text has {bytes} bytes; a style may have at most {limit}")]
    TooLong { bytes: usize, limit: usize },
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    #[error(
        "base: {text:?} is not a built-in style; choose one of {}. A file cannot be a base: copy its contents instead",
        style_preset_names().collect::<Vec<_>>().join(", ")
    )]
    Base { text: String },
    #[error("{entry} of {value} is out of range; it must be {least} to {most}")]
    Range { entry: String, value: f64, least: f64, most: f64 },
    #[error("roads.{text:?} is not a road class; classes are 0 to 8")]
    Class { text: String },
    #[error(
        "[roads.{class}] is missing; define every class from 0 to 8, or start the style with base = \"road-atlas\""
    )]
    MissingClass { class: String },
    #[error("layer_defaults.{text:?} is not a geometry; choose area, line or point")]
    LayerDefaults { text: String },
    #[error(
        "{path} is not the name of a layer or of a class; use 1 to 32 characters of a-z, 0-9 and '-', beginning with a letter"
    )]
    LayerId { path: String },
    #[error(
        "{path}: {entry} is for layers of {geometry}s, but {}; remove it",
        if other.is_empty() { format!("these are {}s", expected.name()) } else { format!("{other} is for layers of {}s", expected.name()) },
        geometry = geometry.name()
    )]
    LayerGeometry {
        path: String,
        entry: &'static str,
        geometry: LayerGeometry,
        other: &'static str,
        expected: LayerGeometry,
    },
    #[error(
        "a dash pattern needs two or four lengths (dash, gap, dash, gap), or none for a solid line; {count} were given"
    )]
    DashCount { count: usize },
    #[error("a line can have dash or pattern, not both; remove one of the two")]
    DashAndPattern,
    #[error("a pattern has 1 to {most} widths, not {count}")]
    PatternCount { count: usize, most: usize },
    #[error(
        "a width of {value} in a pattern is out of range; it must be 0 to 1, a share of the line's width"
    )]
    PatternShare { value: f32 },
    #[error("a pattern of {value} pixels is out of range; it must be 2 to {most}")]
    PatternLength { value: f32, most: f32 },
    #[error("a dash or gap of {value} pixels is out of range; it must be 1 to {most}")]
    DashLength { value: f32, most: f32 },
    #[error("a style has 2 to {most} [[tint]] entries, not {count}")]
    TintCount { count: usize, most: usize },
    #[error(
        "every [[tint]] entry needs a height: write either share in all entries or height_m in all entries"
    )]
    TintUnit,
    #[error(
        "tint_by_climate = true needs height_m in the [[tint]] entries; shares follow the package's own heights"
    )]
    TintClimate,
    #[error("the heights of [[tint]] must ascend, by 1 m or more")]
    TintHeightOrder,
    #[error("[roads.{class}] needs either color (center is optional) or bands")]
    RoadColor { class: usize },
    #[error("[roads.{class}]: {source}")]
    Bands { class: usize, source: Box<StyleError> },
    #[error("a road has 1 to {most} bands, not {count}")]
    BandCount { count: usize, most: usize },
    #[error("the first band must have a width of 1 (the whole road), not {width}")]
    FirstBand { width: f32 },
    #[error(
        "band {number} has a width of {width} after one of {before}; widths must decrease, and none may be below 0.01"
    )]
    BandOrder { number: usize, width: f32, before: f32 },
    #[error("lane_width_m has no effect without own_width = true")]
    LaneWidth,
    #[error("the shares of [[tint]] must ascend from 0 to 1, both included, by 0.001 or more")]
    TintOrder,
}
