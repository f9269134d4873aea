//! The valid package with each text of its metadata in turn made harmful: endless, empty, or with
//! characters that terminals, formats or libraries interpret.

use serde_json::{Value, json};

use super::{
    lie_cases::COMMANDING,
    parts::{PackageParts, metadata},
};
use crate::pmtiles::gzip;

/// A package, and its harmful text.
#[derive(Debug)]
#[expect(missing_docs, reason = "the names say what they are")]
pub struct TextCase {
    pub name: String,
    pub bytes: Vec<u8>,
}

/// Iterates over every text of the metadata, with every harmful content.
pub fn text_cases() -> impl Iterator<Item = TextCase> {
    let metadata = with_all_texts();
    let mut places = Vec::new();
    texts(&metadata, String::new(), &mut places);
    let harms = [
        // The text must not determine the width of a column: Rust's formatting takes 16 bits.
        ("66 000 characters", "x".repeat(66_000)),
        ("a million characters", "é ü ".repeat(250_000)),
        ("a NUL", "a\0b".to_owned()),
        ("what commands", COMMANDING.to_owned()),
        ("nothing", String::new()),
    ];
    places.into_iter().flat_map(move |place| {
        let metadata = metadata.clone();
        harms.clone().into_iter().map(move |(harm, text)| {
            let mut metadata = metadata.clone();
            *metadata.pointer_mut(&place).unwrap() = json!(text);
            let metadata = gzip(metadata.to_string().as_bytes());
            let bytes = PackageParts { metadata, ..PackageParts::good() }.assemble();
            TextCase { name: format!("{place}: {harm}"), bytes }
        })
    })
}

/// Metadata with a text in every possible field.
fn with_all_texts() -> Value {
    let mut metadata = metadata();
    let manifest = &mut metadata["corniche"];
    let number = || json!([["text", 1]]);
    manifest["attribution"] = json!(["text", "other text"]);
    manifest["datum_operations"] =
        json!([{ "from": "EPSG:4267", "to": "EPSG:4326", "operation": "NAD27 to WGS 84 (6)" }]);
    for counted in ["defects", "unknown_highways", "tags_taken_otherwise", "highways_left_out"] {
        manifest["counts"][counted] = number();
    }
    manifest["counts"]["roads_in"] = json!(3);
    manifest["counts"]["roads_lost"] = json!([{ "reason": "text", "roads": 1, "length_um": 1 }]);
    manifest["counts"]["left_out"] =
        json!([{ "reason": "text", "highway": "track", "ways": 1, "length_um": 1 }]);
    for counted in ["lost", "unread_values"] {
        manifest["layers"][0]["counts"][counted] = number();
    }
    manifest["settings"]["class_labels"] = json!(vec!["text"; 9]);
    manifest["settings"]["crs"] = json!("EPSG:32632");
    manifest["settings"]["vertical_unit"] = json!("metre");
    metadata
}

/// Collects the JSON pointers of all texts.
fn texts(value: &Value, place: String, places: &mut Vec<String>) {
    match value {
        Value::String(_) => places.push(place),
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                texts(value, format!("{place}/{index}"), places);
            }
        }
        Value::Object(fields) => {
            for (name, value) in fields {
                texts(value, format!("{place}/{name}"), places);
            }
        }
        _ => {}
    }
}
