//! Metadata of a GeoPackage: the style for QGIS, and the largest error of heights.

use corniche_styles::Style;
use gdal::{Dataset, errors::GdalError, vector::sql::Dialect};

use super::map_style::{self, StyledClasses};

/// The only time stamp in files, so that the same features give the same bytes.
pub(crate) const NO_TIME: &str = "1970-01-01T00:00:00.000Z";

/// The table that QGIS creates for styles (`QgsOgrProviderMetadata::saveStyle`), and its entry
/// among the tables of the file: one without geometry.
const STYLES_TABLE: [&str; 2] = [
    r#"CREATE TABLE "layer_styles" ("id" INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, "f_table_catalog" TEXT(256), "f_table_schema" TEXT(256),
"f_table_name" TEXT(256), "f_geometry_column" TEXT(256), "styleName" TEXT(30), "styleQML" TEXT, "styleSLD" TEXT, "useAsDefault" BOOLEAN,
"description" TEXT, "owner" TEXT(30), "ui" TEXT(30), "update_time" DATETIME DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')))"#,
    "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change, srs_id)
VALUES ('layer_styles', 'attributes', 'layer_styles', '', '1970-01-01T00:00:00.000Z', 0)",
];

/// Adds the style by class that QGIS applies when it opens the layer.
pub(crate) fn add_style(
    file: &Dataset,
    layer: &str,
    classes: &StyledClasses,
) -> Result<(), GdalError> {
    let qml = map_style::qml(classes, &Style::road_atlas());
    for statement in STYLES_TABLE {
        run(file, statement)?;
    }
    let [name, qml] = [layer, &qml].map(quoted);
    // QGIS expects an empty schema, and the geometry column that GDAL names.
    run(
        file,
        &format!(
            "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name, f_geometry_column, styleName, styleQML, styleSLD, \
             useAsDefault, description, owner, ui, update_time) SELECT '', '', table_name, column_name, table_name, {qml}, '', 1, \
             'by class, as on the default map', '', NULL, '{NO_TIME}' FROM gpkg_geometry_columns WHERE table_name = {name}"
        ),
    )
}

/// Replaces the description of a layer.
pub(crate) fn describe(file: &Dataset, layer: &str, description: &str) -> Result<(), GdalError> {
    let [layer, description] = [layer, description].map(quoted);
    run(
        file,
        &format!("UPDATE gpkg_contents SET description = {description} WHERE table_name = {layer}"),
    )
}

fn run(file: &Dataset, statement: &str) -> Result<(), GdalError> {
    file.execute_sql(statement, None, Dialect::DEFAULT).map(|_| ())
}

/// Returns a text as an SQL literal.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}
