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
mod tests {
    use super::*;

    #[test]
    fn settings_files_are_read_whole_or_refused() {
        let config = Config::parse(
            "[terrain]\nmax-error = 5.0\nvertical-shift = -1.5\n[roads]\nsimplify = 0.5\n[resources]\nthreads = 2\n",
        )
        .unwrap();
        assert_eq!(config.terrain.max_error, Some(5.0));
        assert_eq!(config.terrain.vertical_shift, Some(-1.5));
        assert_eq!(config.roads.simplify, Some(0.5));
        assert_eq!(config.resources.threads, NonZeroUsize::new(2));
        for bad in ["[terrain]\nmaxerror = 5.0\n", "[terain]\n", "[resources]\nthreads = 0\n", "a"]
        {
            assert!(matches!(Config::parse(bad), Err(PresetError::Toml(_))), "{bad}");
        }
    }

    #[test]
    fn one_value_for_no_data_is_said_as_shortly_as_before() {
        let nodata = |text: &str| Config::parse(text).map(|config| config.terrain.nodata);
        assert_eq!(nodata("[terrain]\nnodata = -9999\n").unwrap(), [-9999.0]);
        assert_eq!(nodata("[terrain]\nnodata = [-9999, 0.5]\n").unwrap(), [-9999.0, 0.5]);
        assert_eq!(nodata("[terrain]\n").unwrap(), [0.0; 0]);
        assert!(nodata("[terrain]\nnodata = \"none\"\n").is_err());
        let config = Config::parse("[terrain]\nheight-range = [-500, 9000]\n").unwrap();
        assert_eq!(config.terrain.height_range, Some([-500.0, 9000.0]));
        assert!(Config::parse("[terrain]\nheight-range = [1]\n").is_err());
    }

    #[test]
    fn a_cell_is_a_square_or_a_rectangle() {
        let cell = |text: &str| {
            let config = Config::parse(&format!("[terrain]\ncell = {text}\n"));
            config.map(|config| config.terrain.cell.map(CellSides::to_array))
        };
        assert_eq!(cell("30").unwrap(), Some([30.0, 30.0]));
        assert_eq!(cell("2.5").unwrap(), Some([2.5, 2.5]));
        assert_eq!(cell("[20, 30.5]").unwrap(), Some([20.0, 30.5]));
        for bad in ["[]", "[1]", "[1, 2, 3]", "\"30\"", "true", "{ east = 1 }"] {
            let said = cell(bad).unwrap_err().to_string();
            assert!(said.contains("[east, north]"), "{bad}: {said}");
        }
        let rest = "[terrain]\ncrs = \"dem\"\ncell-every = 3\nscale-latitude = -46.5\n";
        let terrain = Config::parse(rest).unwrap().terrain;
        assert_eq!((terrain.crs.as_deref(), terrain.cell_every), (Some("dem"), Some(3)));
        assert_eq!(terrain.scale_latitude, Some(-46.5));
        assert!(Config::parse("[terrain]\ncell-every = -1\n").is_err());
    }

    #[test]
    fn a_text_that_is_no_settings_is_not_even_parsed() {
        let long = "#".repeat(crate::error::MAX_TEXT_BYTES + 1);
        assert!(matches!(Config::parse(&long), Err(PresetError::TooLong { .. })));
        let deep = format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000));
        assert!(matches!(Config::parse(&deep), Err(PresetError::Toml(_))));
    }
}
