//! The schemas under `docs/schema` are those of the types. `CORNICHE_BLESS=1` writes them.

use std::{fs, path::PathBuf};

use corniche_geom::NodeIndex;
use corniche_tileset::{ClipRecord, LeftOutRecord, PolygonRecord, ReliefLevels};
use schemars::{JsonSchema, Schema, generate::SchemaSettings};
use serde_json::{Value, json};

use super::{
    growth::{ComparisonDocument, GrowthDocument},
    info_schema::InfoDocument,
    plan::PlanDocument,
    profile::ProfileDocument,
    progress::ProgressRecord,
    record_schemas::JobDocument,
    tile::TileDocument,
    verify::VerifyDocument,
};

/// The schema of a serialized type: fields that may be null are required.
fn schema<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<T>()
}

fn schemas() -> [(&'static str, &'static str, Schema); 9] {
    [
        ("growth", "corniche growth --json", schema::<GrowthDocument>()),
        (
            "growth-comparison",
            "corniche growth --json of several packages",
            schema::<ComparisonDocument>(),
        ),
        ("info", "corniche info --json", schema::<InfoDocument>()),
        ("job", "a line of corniche jobs", schema::<JobDocument>()),
        ("plan", "corniche plan --json", schema::<PlanDocument>()),
        ("profile", "corniche profile --json", schema::<ProfileDocument<'_>>()),
        ("progress", "a line of --json-progress", schema::<ProgressRecord<'_>>()),
        ("tile", "corniche tile --json", schema::<TileDocument<'_>>()),
        ("verify", "corniche verify --json", schema::<VerifyDocument>()),
    ]
}

/// Writes each paragraph of a description in one line: comments wrap, and documents do not.
fn unwrap_descriptions(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                match value {
                    Value::String(text) if name == "description" => {
                        let paragraphs = text.split("\n\n").map(|text| text.replace('\n', " "));
                        *text = paragraphs.collect::<Vec<_>>().join("\n\n");
                    }
                    value => unwrap_descriptions(value),
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(unwrap_descriptions),
        _ => {}
    }
}

#[test]
fn the_schemas_in_the_docs_are_those_of_the_program() {
    let folder: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "..", "docs", "schema"].iter().collect();
    for (name, title, schema) in schemas() {
        let mut value = serde_json::to_value(schema).unwrap();
        value["title"] = json!(title);
        unwrap_descriptions(&mut value);
        let text = format!("{}\n", serde_json::to_string_pretty(&value).unwrap());
        let path = folder.join(format!("{name}.schema.json"));
        if std::env::var_os("CORNICHE_BLESS").is_some() {
            fs::create_dir_all(&folder).unwrap();
            fs::write(&path, &text).unwrap();
        }
        let stored = fs::read_to_string(&path).unwrap_or_default();
        assert!(
            stored == text,
            "{} is not up to date; write it with CORNICHE_BLESS=1",
            path.display()
        );
    }
}

/// A new field of the manifest must also be in the document.
#[test]
fn the_document_has_all_fields_of_the_manifest() {
    fn check(manifest: &Value, document: &Value, place: &str) {
        match (manifest, document) {
            (Value::Object(fields), Value::Object(ours)) => {
                let names = |fields: &serde_json::Map<String, Value>| -> Vec<String> {
                    fields.keys().cloned().collect()
                };
                assert_eq!(names(fields), names(ours), "{place}");
                for (name, value) in fields {
                    check(value, &ours[name], &format!("{place}.{name}"));
                }
            }
            (Value::Array(values), Value::Array(ours)) => {
                assert_eq!(values.len(), ours.len(), "{place}");
                for (value, our) in values.iter().zip(ours) {
                    check(value, our, place);
                }
            }
            // Pairs in the file are objects here.
            (Value::Array(pair), Value::Object(_)) => assert_eq!(pair.len(), 2, "{place}"),
            _ => assert_eq!(manifest, document, "{place}"),
        }
    }
    let mut manifest = corniche_testing::package::manifest();
    // Optional fields are included, too.
    manifest.clip = Some(ClipRecord {
        nodes: [NodeIndex { i: -1, j: 0 }, NodeIndex { i: 2, j: 3 }],
        whole_data_bounds: manifest.data_bounds,
        whole_wgs84_bounds: manifest.wgs84_bounds,
    });
    manifest.settings.bounds_deg = Some([9.0, 47.0, 10.0, 48.0]);
    manifest.settings.polygon =
        Some(PolygonRecord { name: "a.gpkg".to_owned(), sha256: "12".to_owned() });
    manifest.vertical.height_step_m = 1.0;
    manifest.settings.relief = ReliefLevels::Full;
    manifest.levels.iter_mut().for_each(|level| level.relief_bytes = 7);
    manifest.settings.classes = Some(vec![0, 8]);
    manifest.counts.left_out = vec![LeftOutRecord {
        reason: "class is off".to_owned(),
        highway: "path".to_owned(),
        ways: 2,
        length_um: 7,
    }];
    let document = super::info::InfoDocument { manifest: &manifest, tiles: Vec::new() };
    check(
        &serde_json::to_value(&manifest).unwrap(),
        &serde_json::to_value(document).unwrap()["manifest"],
        "manifest",
    );
}
