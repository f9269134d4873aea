use std::{collections::BTreeMap, num::NonZeroUsize};

use serde::{Deserialize, Deserializer};

use crate::{PresetError, error::bounded};

/// A settings file: what the command line can say, by section. What it leaves out is decided elsewhere.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Config {
    /// `[terrain]`
    pub terrain: TerrainConfig,
    /// `[roads]`
    pub roads: RoadConfig,
    /// `[resources]`
    pub resources: ResourceConfig,
}

/// How the ground is made: the options of the same names.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[expect(missing_docs, reason = "each field is the option of its name, documented there")]
pub struct TerrainConfig {
    pub crs: Option<String>,
    pub dem_crs: Option<String>,
    pub vertical_crs: Option<String>,
    pub dem_vertical_crs: Option<String>,
    pub vertical_shift: Option<f64>,
    /// One value or a list of them.
    #[serde(deserialize_with = "one_or_many")]
    pub nodata: Vec<f64>,
    pub height_range: Option<[f64; 2]>,
    pub cell: Option<CellSides>,
    pub cell_every: Option<u32>,
    pub scale_latitude: Option<f64>,
    pub max_error: Option<f64>,
    pub fill_voids: Option<u32>,
    pub attribution: Vec<String>,
}

/// A cell: one number is a square's side, two are east and north; metres.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number or two of them, [east, north]")]
pub enum CellSides {
    /// The side of a square.
    Square(f64),
    /// East and north.
    Rectangle([f64; 2]),
}

impl CellSides {
    /// East and north, metres.
    #[must_use]
    pub fn to_array(self) -> [f64; 2] {
        match self {
            Self::Square(side_m) => [side_m; 2],
            Self::Rectangle(sides_m) => sides_m,
        }
    }
}

/// How roads are made: the options of the same names.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[expect(missing_docs, reason = "each field is the option of its name, documented there")]
pub struct RoadConfig {
    pub frc_table: Option<String>,
    pub all_classes: bool,
    pub simplify: Option<f64>,
    /// Coarsest cell, metres, at which each class is shown; a class left out is shown on every level.
    pub class_max_cell: Option<BTreeMap<String, f64>>,
}

/// What a run may use: the options of the same names.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
#[expect(missing_docs, reason = "each field is the option of its name, documented there")]
pub struct ResourceConfig {
    pub threads: Option<NonZeroUsize>,
    pub memory: Option<String>,
}

/// A list of numbers, or one alone.
fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a number or a list of numbers")]
    enum OneOrMany {
        One(f64),
        Many(Vec<f64>),
    }
    Ok(match OneOrMany::deserialize(deserializer)? {
        OneOrMany::One(value) => vec![value],
        OneOrMany::Many(values) => values,
    })
}

impl Config {
    /// Reads a settings file's text. Unknown sections and names are refused.
    ///
    /// # Errors
    /// When it is no TOML, or says what no setting is.
    pub fn parse(text: &str) -> Result<Self, PresetError> {
        Ok(toml::from_str(bounded(text)?)?)
    }
}

#[cfg(test)]
#[path = "config_tests.rs"]
mod tests;
