//! `GeoPackages` of roads and layers open in QGIS as a map, and record the tolerance of heights: read
//! with Python's `SQLite` and XML.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path, process::Command};

use e2e::{corniche, manifest, root, skip, text};
use gdal::{Dataset, vector::LayerAccess as _};
use serde_json::Value;

/// Prints the style that QGIS looks up, by the rules of its `QgsOgrProviderMetadata::loadStyle`.
const READ: &str = r#"
import json, sqlite3, sys
from xml.etree import ElementTree
file, layer = sys.argv[1:]
base = sqlite3.connect(file)
one = lambda query, *values: base.execute(query, values).fetchall()
column = one("SELECT column_name FROM gpkg_geometry_columns WHERE table_name = ?", layer)[0][0]
rows = one("SELECT styleQML, useAsDefault, update_time FROM layer_styles WHERE f_table_schema = '' AND f_table_name = ? AND f_geometry_column = ?",
           layer, column)
style = ElementTree.fromstring(rows[0][0])
renderer = style.find("renderer-v2")
symbols = {symbol.get("name"): symbol for symbol in renderer.find("symbols")}
print(json.dumps({
    "rows": len(rows), "default": rows[0][1], "time": rows[0][2], "renderer": renderer.get("type"),
    "categories": [entry.get("value") for entry in renderer.find("categories")],
    "drawn": all(len(symbols[entry.get("symbol")]) > 0 for entry in renderer.find("categories")),
    "classes": [str(row[0]) for row in one(f"SELECT DISTINCT {renderer.get('attr')} FROM {layer}")],
    "table": one("SELECT data_type FROM gpkg_contents WHERE table_name = 'layer_styles'"),
    "description": one("SELECT description FROM gpkg_contents WHERE table_name = ?", layer)[0][0],
}))
"#;

fn read(file: &Path, layer: &str) -> Option<Value> {
    let python = std::env::var_os("CORNICHE_PYTHON").unwrap_or_else(|| "python3".into());
    let Ok(ran) = Command::new(python).args(["-c", READ, text(file), layer]).output() else {
        skip("there is no python3");
        return None;
    };
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    Some(serde_json::from_slice(&ran.stdout).unwrap())
}

/// The table has one style, which is the default, and a category with a symbol for each class in
/// the data.
#[test]
fn each_class_of_a_geopackage_has_a_look_in_qgis() {
    let folder = tempfile::tempdir().unwrap();
    let package = root().join("tests/golden/all-sections.pmtiles");
    let level = manifest(&package)["levels"].as_array().unwrap().last().unwrap().clone();
    let bound_m = level["geometric_error_m"].as_f64().unwrap();
    for layer in ["roads", "areas", "boundaries"] {
        let [file, again] =
            ["a.gpkg", "b.gpkg"].map(|name| folder.path().join(format!("{layer}-{name}")));
        for file in [&file, &again] {
            let what = if layer == "roads" { &["roads"][..] } else { &["layer", layer] };
            let words = [text(&package), "-q", "-o", text(file)];
            let ran = corniche([&["export"], what, &words].concat());
            assert_eq!(ran.code, 0, "{}", ran.err);
        }
        assert!(fs::read(&file).unwrap() == fs::read(&again).unwrap(), "{layer}: other bytes");
        let Some(found) = read(&file, layer) else { return };
        assert_eq!((&found["rows"], &found["default"]), (&1.into(), &1.into()), "{layer}");
        assert_eq!(found["renderer"], "categorizedSymbol", "{layer}");
        assert_eq!(
            (&found["time"], &found["drawn"]),
            (&"1970-01-01T00:00:00.000Z".into(), &true.into())
        );
        assert_eq!(found["table"], serde_json::json!([["attributes"]]), "{layer}");
        let list = |name: &str| found[name].as_array().unwrap().clone();
        let (classes, categories) = (list("classes"), list("categories"));
        assert!(classes.len() > 1, "{layer}: {classes:?}");
        assert!(classes.iter().all(|class| categories.contains(class)), "{layer}: {found}");

        // GDAL lists the features first, and the table of styles without geometry.
        let dataset = Dataset::open(&file).unwrap();
        let names: Vec<String> = dataset.layers().map(|layer| layer.name()).collect();
        assert_eq!(names, [layer, "layer_styles"]);

        let description = found["description"].as_str().unwrap();
        let told = description.split_once("Heights are within ").map(|(_, told)| told);
        let told = told.map(|told| told.split(' ').next().unwrap().parse::<f64>().unwrap());
        match told {
            // It is reported in whole centimetres, rounded up.
            Some(told_m) if layer != "areas" => {
                assert!((bound_m..bound_m + 0.01).contains(&told_m), "{bound_m}: {description}");
            }
            other => assert!(other.is_none() && layer == "areas", "{layer}: {description}"),
        }
    }
}
