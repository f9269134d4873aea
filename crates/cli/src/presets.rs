//! Presets and settings files: the only place that reads TOML.

use std::{collections::BTreeMap, fs, num::NonZeroUsize, path::Path};

use corniche_roads::{ClassFilter, FrcTable, FunctionalRoadClass};
use serde::Deserialize;

use crate::failure::Failure;

/// FRC tables that come with the program.
const FRC_PRESETS: [(&str, &str); 5] = [
    ("default", include_str!("../../../config/frc/default.toml")),
    ("valhalla", include_str!("../../../config/frc/valhalla.toml")),
    ("fraunhofer", include_str!("../../../config/frc/fraunhofer.toml")),
    ("itinero", include_str!("../../../config/frc/itinero.toml")),
    ("here5", include_str!("../../../config/frc/here5.toml")),
];

/// An FRC table as it is written down.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FrcFile {
    name: String,
    least_class: u8,
    classes: BTreeMap<String, u8>,
    #[serde(default)]
    not_roads: Vec<String>,
}

/// A preset by its name, else a file by its path.
pub(crate) fn frc_table(name_or_path: &str) -> Result<FrcTable, Failure> {
    if let Some((_, text)) = FRC_PRESETS.iter().find(|(name, _)| *name == name_or_path) {
        return parse_frc(name_or_path, text);
    }
    let text = fs::read_to_string(name_or_path).map_err(|error| {
        let names = FRC_PRESETS.map(|(name, _)| name).join(", ");
        Failure::unusable(format!(
            "--frc-table {name_or_path:?} is neither a preset ({names}) nor a readable file: {error}"
        ))
    })?;
    parse_frc(name_or_path, &text)
}

fn parse_frc(source: &str, text: &str) -> Result<FrcTable, Failure> {
    let file: FrcFile = toml::from_str(text)
        .map_err(|error| Failure::unusable(format!("FRC table {source:?}: {error}")))?;
    let classes = file.classes.into_iter().collect();
    FrcTable::new(file.name, classes, file.not_roads, file.least_class)
        .map_err(|error| Failure::unusable(format!("FRC table {source:?}: {error}")))
}

/// A settings file: what the command line can say, by section. What it leaves out is decided elsewhere.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Config {
    pub(crate) terrain: TerrainConfig,
    pub(crate) roads: RoadConfig,
    pub(crate) resources: ResourceConfig,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub(crate) struct TerrainConfig {
    pub(crate) crs: Option<String>,
    pub(crate) dem_crs: Option<String>,
    pub(crate) nodata: Option<f64>,
    pub(crate) cell: Option<f64>,
    pub(crate) max_error: Option<f64>,
    pub(crate) fill_voids: Option<u32>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub(crate) struct RoadConfig {
    pub(crate) frc_table: Option<String>,
    pub(crate) all_classes: bool,
    pub(crate) simplify: Option<f64>,
    /// Coarsest cell, metres, at which each class is shown; a class left out is shown on every level.
    pub(crate) class_max_cell: Option<BTreeMap<String, f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub(crate) struct ResourceConfig {
    pub(crate) threads: Option<NonZeroUsize>,
    pub(crate) memory: Option<String>,
}

/// Reads a settings file.
pub(crate) fn read_config(path: &Path) -> Result<Config, Failure> {
    let text = fs::read_to_string(path).map_err(|error| {
        Failure::unusable(format!("cannot read settings {}: {error}", path.display()))
    })?;
    toml::from_str(&text)
        .map_err(|error| Failure::unusable(format!("settings {}: {error}", path.display())))
}

/// A filter from coarsest cells by class number.
pub(crate) fn class_filter(cells: &BTreeMap<String, f64>) -> Result<ClassFilter, Failure> {
    let mut class_max_cell_m = [None; FunctionalRoadClass::COUNT];
    for (class, &cell_m) in cells {
        let slot = class.parse::<usize>().ok().and_then(|number| class_max_cell_m.get_mut(number));
        *slot.ok_or_else(|| {
            Failure::unusable(format!("class-max-cell: {class:?} is no class; classes are 0 to 8"))
        })? = Some(cell_m);
    }
    ClassFilter::new(class_max_cell_m)
        .map_err(|error| Failure::unusable(format!("class-max-cell: {error}")))
}

#[cfg(test)]
mod tests {
    use corniche_roads::Classified;

    use super::*;

    #[test]
    fn every_preset_is_a_table_under_its_own_name() {
        for (name, _) in FRC_PRESETS {
            let table = frc_table(name).unwrap();
            assert_eq!(table.name(), name);
            let motorway = FunctionalRoadClass::new(0).unwrap();
            assert_eq!(table.classify(&[("highway", "motorway")]), Classified::Road(motorway));
        }
    }

    #[test]
    fn links_keep_their_parents_class_in_the_default_table() {
        let table = frc_table("default").unwrap();
        for (value, class) in
            [("motorway_link", 0), ("trunk_link", 1), ("tertiary_link", 4), ("living_street", 6)]
        {
            let class = FunctionalRoadClass::new(class).unwrap();
            assert_eq!(table.classify(&[("highway", value)]), Classified::Road(class));
        }
    }

    #[test]
    fn settings_files_are_read_whole_or_refused() {
        let config: Config = toml::from_str(
            "[terrain]\nmax-error = 5.0\n[roads]\nclass-max-cell = { \"7\" = 30.0 }\n[resources]\nthreads = 2\n",
        )
        .unwrap();
        assert_eq!(config.terrain.max_error, Some(5.0));
        assert!(class_filter(&config.roads.class_max_cell.unwrap()).is_err(), "8 would outlast 7");
        assert!(toml::from_str::<Config>("[terrain]\nmaxerror = 5.0\n").is_err());
        assert!(toml::from_str::<Config>("[terain]\n").is_err());
    }
}
