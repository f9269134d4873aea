//! The settings that determine, for given inputs, the tiles of a package and the heights in them:
//! those of [`SettingsRecord`].
//!
//! The other settings change at most the manifest: the attribution, the name of the program, and
//! the names of the input files.
//!
//! The build records the settings with [`record_settings`]; `verify` converts them back with
//! [`terrain`] and [`roads`] to open the elevation files and the extract as the build did.

use corniche_gis::RegionPolygons;
use corniche_layers::LayerTable;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_tileset::{LayerTableRecord, PhotoRecord, PolygonRecord, SettingsRecord};
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::{PlanSettings, RoadSettings, TerrainSettings, hex::hex};

/// Copies one setting from the checked settings into a record, or back.
macro_rules! take {
    (($record:ident from $settings:ident) $name:ident $key:ident [$($path:tt)+] $usual:tt) => {
        $record.$key.clone_from(&$settings.$($path)+);
    };
    (($record:ident into $settings:ident) $name:ident $key:ident [$($path:tt)+] $usual:tt) => {
        $settings.$($path)+.clone_from(&$record.$key);
    };
}

/// The record of a build. `max_error_m` is the tolerance of the finest level, given or derived from
/// the cell; the levels of `photo` are given or derived from the photos.
pub fn record_settings(
    settings: &PlanSettings,
    max_error_m: f64,
    photo: Option<PhotoRecord>,
) -> SettingsRecord {
    let PlanSettings { terrain, roads, layers, .. } = settings;
    let RoadSettings { table, filter, .. } = roads;
    let mut record = SettingsRecord {
        max_error_m,
        polygon: terrain.plan.polygon.as_ref().map(polygon_record),
        frc_table: table.name().to_owned(),
        frc_table_sha256: table_sha256(table),
        class_labels: table.recorded_labels().map(Vec::from),
        classes: table.chosen_classes(),
        class_max_cell_m: filter.class_max_cell_m().to_vec(),
        photo,
        layers: layers.iter().map(layer_table_record).collect(),
        ..SettingsRecord::default()
    };
    corniche_settings::placed! { Terrain [take] (record from terrain) }
    corniche_settings::placed! { Roads [take] (record from roads) }
    record
}

/// The record of a layer's table.
#[must_use]
pub fn layer_table_record(table: &LayerTable) -> LayerTableRecord {
    let sha256 = hex(&Sha256::digest(json_text(table.form())));
    LayerTableRecord { id: table.id().to_owned(), sha256 }
}

/// The record of a polygon: the name of its file, and the hash of the region that it encloses.
fn polygon_record(polygon: &RegionPolygons) -> PolygonRecord {
    let name = polygon.path().file_name().unwrap_or(polygon.path().as_os_str());
    PolygonRecord { name: name.to_string_lossy().into_owned(), sha256: polygon_sha256(polygon) }
}

/// SHA-256 of a polygon's coordinate system and corners, whatever the format of its file.
#[must_use]
pub fn polygon_sha256(polygon: &RegionPolygons) -> String {
    hex(&Sha256::digest(polygon.canonical_bytes()))
}

/// The settings for the ground that a package records. Only the hash of a polygon is recorded, so
/// the polygon is omitted here: it comes from its file.
#[must_use]
pub fn terrain(record: &SettingsRecord) -> TerrainSettings {
    let mut terrain = TerrainSettings {
        // The build has already started.
        allow_fine_cell: true,
        allow_ballpark: true,
        max_error_m: Some(record.max_error_m),
        ..TerrainSettings::default()
    };
    corniche_settings::placed! { Terrain [take] (record into terrain) }
    terrain
}

/// The settings for roads that a package records, with its table of classes; `None` if the record
/// has no valid filter.
#[must_use]
pub fn roads(record: &SettingsRecord, table: FrcTable) -> Option<RoadSettings> {
    let mut roads = RoadSettings { filter: filter(record)?, ..RoadSettings::from_table(table) };
    corniche_settings::placed! { Roads [take] (record into roads) }
    Some(roads)
}

/// Which levels show which class; `None` if the record has no valid filter.
#[must_use]
pub fn filter(record: &SettingsRecord) -> Option<ClassFilter> {
    ClassFilter::new(record.class_max_cell_m.as_slice().try_into().ok()?).ok()
}

/// SHA-256 of a record as JSON.
#[must_use]
pub fn sha256(record: &SettingsRecord) -> String {
    hex(&Sha256::digest(json_text(record)))
}

/// A record as JSON.
fn json_text<T: Serialize + std::fmt::Debug>(record: &T) -> String {
    // A record of numbers and texts can always be written as JSON; if it cannot, its debug form is
    // just as unique.
    serde_json::to_string(record).unwrap_or_else(|_| format!("{record:?}"))
}

/// SHA-256 of an FRC table's text.
#[must_use]
pub fn table_sha256(table: &FrcTable) -> String {
    hex(&Sha256::digest(table.canonical_text()))
}

#[cfg(test)]
#[path = "settings_record_tests.rs"]
mod tests;
