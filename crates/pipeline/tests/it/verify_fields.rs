//! Changes every field of the manifest in turn and reassembles the package with matching checksums:
//! which check detects the change.
//!
//! The fields are the leaves of the manifest's JSON: a field that is missing from the list below
//! fails the test.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use corniche_testing::some_of;
use std::fmt::Write as _;

use crate::support::{
    parts::{Against, Parts, SOUND},
    seen::{
        SeenBy::{self, By, OtherInput, Refused, Unseen},
        check, row,
    },
};
use corniche_tileset::Manifest;
use corniche_verify::CheckId as C;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

/// A leaf of the manifest, another value for it, and the check that detects it.
struct Change {
    /// JSON pointer.
    at: &'static str,
    new: fn(&Value) -> Value,
    seen: SeenBy,
}

const fn change(at: &'static str, new: fn(&Value) -> Value, seen: SeenBy) -> Change {
    Change { at, new, seen }
}

fn plus(value: &Value, by: f64) -> Value {
    match value.as_u64() {
        Some(count) => json!(count + by as u64),
        None => json!(value.as_f64().unwrap() + by),
    }
}

fn one_more(value: &Value) -> Value {
    plus(value, 1.0)
}

fn little_more(value: &Value) -> Value {
    json!(value.as_f64().unwrap() * 1.000_001 + 1e-7)
}

fn text(_: &Value) -> Value {
    json!("something else")
}

const FREE_TEXT: &str = "a text for people; nothing else depends on it";
const RENAMED: &str = "files may be renamed, and are identified by their content";
const NO_DEM_CRS: &str = "no effect on files that name a CRS; only the settings' hash changes";
const NO_OTHER_BAND: &str = "no effect on files with one band; only the settings' hash changes";
const NO_LATITUDE: &str =
    "no effect on a CRS that is true to scale; only the settings' hash changes";

/// Other values for every leaf of the manifest.
const MANIFEST: &[Change] = &[
    change("/format_version", one_more, Refused),
    change("/generator", text, Unseen(FREE_TEXT)),
    change("/tiling", text, By(C::Texts)),
    change("/crs", |_| json!("EPSG:32633"), By(C::Crs)),
    change(
        "/crs_wkt",
        |wkt| json!(wkt.as_str().unwrap().replace("0.9996", "0.9997")),
        By(C::Coordinates),
    ),
    change("/metres_per_unit/0", little_more, By(C::Coordinates)),
    change("/metres_per_unit/1", little_more, By(C::Coordinates)),
    change("/point_scale", little_more, By(C::Scale)),
    change("/scale/center/0", little_more, By(C::Scale)),
    change("/scale/center/1", little_more, By(C::Scale)),
    change("/scale/least/0", |at| json!(at.as_f64().unwrap() - 1e-4), By(C::Scale)),
    change("/scale/least/1", |at| json!(at.as_f64().unwrap() - 1e-7), By(C::DemPlan)),
    change("/scale/largest/0", |at| json!(at.as_f64().unwrap() + 1e-4), By(C::Scale)),
    change("/scale/largest/1", |at| json!(at.as_f64().unwrap() + 1e-7), By(C::DemPlan)),
    change("/frame/origin_m/0", one_more, By(C::Grid)),
    change("/frame/origin_m/1", one_more, By(C::Grid)),
    change("/frame/cell_m/0", |_| json!(11.25), Refused),
    change("/frame/cell_m/1", |_| json!(20.0), Refused),
    change("/frame/root_corner/i", |i| json!(i.as_i64().unwrap() + 256), Refused),
    change("/frame/root_corner/j", |j| json!(j.as_i64().unwrap() + 256), By(C::Grid)),
    change("/frame/max_level", one_more, Refused),
    change("/data_bounds/min_x", |x| plus(x, 10.0), By(C::SampleSums)),
    change("/data_bounds/min_y", one_more, By(C::Grid)),
    change("/data_bounds/max_x", one_more, By(C::Grid)),
    change("/data_bounds/max_y", |y| plus(y, 10.0), By(C::SampleSums)),
    change("/wgs84_bounds/min_x", |x| json!(x.as_f64().unwrap() - 0.01), By(C::Bounds)),
    change("/wgs84_bounds/min_y", |y| json!(y.as_f64().unwrap() + 0.01), By(C::Bounds)),
    change("/wgs84_bounds/max_x", |x| json!(x.as_f64().unwrap() + 0.01), By(C::Bounds)),
    change("/wgs84_bounds/max_y", |y| json!(y.as_f64().unwrap() + 1e-9), By(C::DemPlan)),
    change("/resampling", text, By(C::DemPlan)),
    change("/nodes_are_samples", |value| json!(!value.as_bool().unwrap()), By(C::DemPlan)),
    change("/vertical/quantum_m", |q| json!(q.as_f64().unwrap() * 2.0), By(C::LevelRecords)),
    change("/vertical/unit", text, By(C::Texts)),
    change("/vertical/datum", text, By(C::DemPlan)),
    change("/vertical/treatment", text, By(C::DemPlan)),
    change("/vertical/range_m/0", |low| json!(low.as_f64().unwrap() - 1.0), By(C::RootHeights)),
    change("/vertical/range_m/1", one_more, By(C::RootHeights)),
    change("/coordinates/bounds/min_x", one_more, By(C::Coordinates)),
    change("/coordinates/bounds/min_y", one_more, By(C::Coordinates)),
    change("/coordinates/bounds/max_x", one_more, By(C::Coordinates)),
    change("/coordinates/bounds/max_y", one_more, By(C::Coordinates)),
    change("/coordinates/size", one_more, Refused),
    change(
        "/coordinates/samples_deg/7/0",
        |lon| json!(lon.as_f64().unwrap() + 1e-6),
        By(C::Coordinates),
    ),
    change(
        "/coordinates/samples_deg/7/1",
        |lat| json!(lat.as_f64().unwrap() + 1e-6),
        By(C::Coordinates),
    ),
    change("/levels/1/level", one_more, Refused),
    change("/levels/1/cell_m/0", one_more, By(C::LevelRecords)),
    change("/levels/1/cell_m/1", one_more, By(C::LevelRecords)),
    change("/levels/1/max_error_m", one_more, By(C::LevelRecords)),
    change("/levels/1/geometric_error_m", little_more, By(C::LevelSums)),
    change("/levels/1/errors_m/count", one_more, By(C::LevelSums)),
    change("/levels/1/errors_m/min", |_| json!(0.0), By(C::LevelSums)),
    change(
        "/levels/1/errors_m/median",
        |value| json!(value.as_f64().unwrap() * 0.999_999_9),
        By(C::LevelSums),
    ),
    change(
        "/levels/1/errors_m/p95",
        |value| json!(value.as_f64().unwrap() * 0.999_999_9),
        By(C::LevelSums),
    ),
    change("/levels/1/errors_m/max", one_more, By(C::LevelSums)),
    change("/levels/1/tightness/count", one_more, By(C::Recorded)),
    change("/levels/1/tightness/min", |_| json!(0.9), By(C::Recorded)),
    // The sample's ratios are all 1: changing only the middle one gives no valid distribution.
    change("/levels/1/tightness/median", |_| json!(1.5), Refused),
    change("/levels/1/tightness/p95", |_| json!(1.5), Refused),
    change("/levels/1/tightness/max", one_more, By(C::Recorded)),
    change("/levels/0/least_class", |_| json!(0), By(C::LevelRecords)),
    change("/levels/1/simplify_tolerance_m", little_more, By(C::LevelRecords)),
    change("/levels/1/width_margin_m", little_more, By(C::LevelRecords)),
    change("/levels/1/tiles", one_more, By(C::LevelSums)),
    change("/levels/1/triangles", one_more, By(C::LevelSums)),
    change("/levels/1/vertices", one_more, By(C::LevelSums)),
    change("/levels/1/sample_error/on_tin", one_more, By(C::Samples)),
    change("/levels/1/sample_error/off_tin", one_more, By(C::Samples)),
    change("/levels/1/sample_error/max_m", one_more, By(C::Samples)),
    change("/levels/1/sample_error/rms_m", one_more, By(C::Samples)),
    change("/levels/1/sample_error/p99_m", one_more, By(C::Samples)),
    change("/levels/1/terrain_bytes", one_more, By(C::LevelSums)),
    change("/levels/1/relief_bytes", one_more, By(C::LevelSums)),
    change("/levels/1/uncovered_nodes", one_more, By(C::Uncovered)),
    change("/settings/max_error_m", one_more, By(C::LevelRecords)),
    change("/settings/fill_voids", |_| json!(0), By(C::DemCounts)),
    change("/settings/nodata", |_| json!([1234.5]), By(C::DemCounts)),
    change("/settings/height_range_m", |_| json!([0.0, 2000.0]), By(C::DemCounts)),
    change("/settings/dem_crs", |_| json!("EPSG:32633"), Unseen(NO_DEM_CRS)),
    change("/settings/dem_vertical_crs", |_| json!("EPSG:5773"), By(C::DemPlan)),
    change("/settings/vertical_crs", |_| json!("EPSG:5773"), OtherInput(Against::Dem)),
    change("/settings/vertical_shift_m", one_more, By(C::DemPlan)),
    change("/settings/crs", |_| json!("EPSG:32633"), By(C::DemPlan)),
    change("/settings/cell_m", |_| json!([20.0, 20.0]), By(C::DemPlan)),
    change("/settings/cell_every", |_| json!(2), By(C::DemPlan)),
    change("/settings/scale_latitude_deg", |_| json!(30.0), Unseen(NO_LATITUDE)),
    change("/settings/relief", |_| json!("finest"), By(C::ReliefThere)),
    change("/settings/frc_table", text, By(C::OsmInputs)),
    change("/settings/frc_table_sha256", text, OtherInput(Against::Osm)),
    change("/settings/class_labels/3", text, By(C::OsmInputs)),
    change("/settings/class_max_cell_m/5", |_| json!(70.0), By(C::LevelRecords)),
    change("/settings/simplify_cells", little_more, By(C::LevelRecords)),
    change("/settings_sha256", text, By(C::SettingsHash)),
    change("/inputs/0/kind", text, By(C::Texts)),
    change("/inputs/0/name", text, Unseen(RENAMED)),
    change("/inputs/0/bytes", one_more, By(C::DemInputs)),
    change("/inputs/1/bytes", one_more, By(C::OsmInputs)),
    change("/inputs/0/sha256", text, OtherInput(Against::Dem)),
    change("/inputs/1/sha256", text, OtherInput(Against::Osm)),
    change("/attribution/0", text, By(C::Texts)),
    change("/counts/samples/nodes", one_more, By(C::SampleSums)),
    change("/counts/samples/with_data", one_more, By(C::SampleSums)),
    change("/counts/samples/filled", one_more, By(C::SampleSums)),
    change("/counts/samples/void", one_more, By(C::SampleSums)),
    change("/counts/roads_in", one_more, By(C::RoadSums)),
    change("/counts/roads_in_um", one_more, By(C::RoadSums)),
    change("/counts/roads_kept", one_more, By(C::RoadSums)),
    change("/counts/roads_kept_um", one_more, By(C::RoadSums)),
    change("/counts/roads_lost/0/reason", text, By(C::Texts)),
    change("/counts/roads_lost/0/roads", one_more, By(C::RoadSums)),
    change("/counts/roads_lost/0/length_um", one_more, By(C::RoadSums)),
    change("/counts/defects/0/0", text, By(C::OsmCounts)),
    change("/counts/defects/0/1", one_more, By(C::OsmCounts)),
    change("/counts/unknown_highways/0/0", text, By(C::OsmCounts)),
    change("/counts/unknown_highways/0/1", one_more, By(C::OsmCounts)),
    change("/counts/tags_taken_otherwise", |_| json!([["layer=1000", 1]]), By(C::OsmCounts)),
    change("/counts/blobs_passed_over", one_more, By(C::OsmCounts)),
    change("/counts/highways_in", one_more, By(C::OsmCounts)),
    change("/counts/highways_left_out/0/0", text, By(C::OsmCounts)),
    change("/counts/highways_left_out/0/1", one_more, By(C::OsmCounts)),
    change("/counts/left_out/0/reason", text, By(C::OsmCounts)),
    change("/counts/left_out/0/highway", text, By(C::OsmCounts)),
    change("/counts/left_out/0/ways", one_more, By(C::OsmCounts)),
    change("/counts/left_out/0/length_um", one_more, By(C::OsmCounts)),
    change("/counts/classes/3/0", one_more, By(C::RoadSums)),
    change("/counts/classes/3/1", one_more, By(C::RoadSums)),
    change("/growth/1/level", one_more, By(C::Growth)),
    change("/growth/1/class", one_more, By(C::Growth)),
    change("/growth/1/source_vertices", one_more, By(C::Growth)),
    change("/growth/1/simplified_vertices", one_more, By(C::Growth)),
    change("/growth/1/geo_vertices", one_more, By(C::Growth)),
    change("/growth/1/sv_vertices", one_more, By(C::Growth)),
    change("/growth/1/source_bytes", one_more, By(C::Growth)),
    change("/growth/1/simplified_bytes", one_more, By(C::Growth)),
    change("/growth/1/geo_raw_bytes", one_more, By(C::Growth)),
    change("/growth/1/geo_stored_bytes", one_more, By(C::Growth)),
    change("/growth/1/sv_stored_bytes", one_more, By(C::Growth)),
    change("/sv_tails/0/0", |_| json!(0), By(C::SvTails)),
    change("/sv_tails/0/1", one_more, By(C::SvTails)),
    change("/sv_tails/0/2", one_more, By(C::SvTails)),
    change("/sv_tails/0/3", one_more, By(C::SvTails)),
];

/// Values of fields that the sample's manifest omits.
const LEFT_OUT: &[Change] = &[
    change("/datum_operations", |_| operation_of("EPSG:4267", "EPSG:4326"), By(C::Crs)),
    change("/datum_operations", |_| operation_of("EPSG:4267", "EPSG:32632"), By(C::DemPlan)),
    change("/settings/dem_band", |_| json!(2), Unseen(NO_OTHER_BAND)),
    change("/settings/vertical_unit", |_| json!("foot"), By(C::Nodes)),
];

fn operation_of(from: &str, to: &str) -> Value {
    json!([{ "from": from, "to": to, "operation": "NAD27 to WGS 84 (6)", "accuracy_m": 7.0 }])
}

/// Whether the positions in a list have different meanings, as in pairs and triples, rather than
/// being items of one kind.
fn is_tuple(list: &[Value]) -> bool {
    list.len() <= 4 && list.iter().any(Value::is_number)
}

fn step(list: &[Value], index: &str) -> String {
    if is_tuple(list) { format!(".{index}") } else { "[]".to_owned() }
}

/// The names of all leaves. An empty list is a leaf.
fn leaves(value: &Value, name: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (field, value) in fields {
                let dot = if name.is_empty() { "" } else { "." };
                leaves(value, &format!("{name}{dot}{field}"), found);
            }
        }
        Value::Array(list) if !list.is_empty() => {
            for (index, value) in list.iter().enumerate() {
                leaves(value, &format!("{name}{}", step(list, &index.to_string())), found);
            }
        }
        _ => found.push(name.to_owned()),
    }
}

/// The name of the leaf at a pointer.
fn name_of(manifest: &Value, at: &str) -> String {
    let mut name = String::new();
    let mut value = manifest;
    for part in at.split('/').skip(1) {
        name = match value {
            Value::Array(list) => format!("{name}{}", step(list, part)),
            _ if name.is_empty() => part.to_owned(),
            _ => format!("{name}.{part}"),
        };
        let next = if value.is_array() {
            value.get(part.parse::<usize>().unwrap())
        } else {
            value.get(part)
        };
        value = next.unwrap_or_else(|| panic!("there is no {at}"));
    }
    name
}

/// Every leaf of the manifest's JSON has a change here, and every change has the expected result
/// (in full mode; otherwise only some of the changes).
#[test]
fn every_field_of_the_manifest_is_seen_or_listed_as_unseen() {
    let sound = serde_json::to_value(&SOUND.parts.manifest).unwrap();
    let mut all = Vec::new();
    leaves(&sound, "", &mut all);
    all.sort_unstable();
    all.dedup();
    let mut listed: Vec<String> =
        MANIFEST.iter().map(|change| name_of(&sound, change.at)).collect();
    listed.sort_unstable();
    listed.dedup();
    assert_eq!(all, listed, "fields without a change in the list (or the other way round)");

    let document =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/promises.md"))
            .unwrap();
    let mut failed = Vec::new();
    for change in MANIFEST {
        let name = name_of(&sound, change.at);
        if let Unseen(reason) = change.seen {
            let line = format!("| `{name}` | {reason} |");
            assert!(document.contains(&line), "docs/promises.md has no line {line}");
        }
    }
    for change in some_of(MANIFEST, [16, 6, 1]) {
        let name = name_of(&sound, change.at);
        println!("{}", row(&name, change.seen));
        if let Err(found) = look_at(&sound, change) {
            failed.push(format!("{name}: expected {:?}, found {found}", change.seen));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Changes of optional fields are detected if the fields are present.
#[test]
fn fields_that_the_manifest_leaves_out_are_seen_once_they_are_there() {
    let sound = serde_json::to_value(&SOUND.parts.manifest).unwrap();
    for change in LEFT_OUT {
        let mut with_none = sound.clone();
        let (parent, field) = change.at.rsplit_once('/').unwrap();
        let object = with_none.pointer_mut(parent).unwrap().as_object_mut().unwrap();
        assert!(object.insert(field.to_owned(), Value::Null).is_none(), "{}", change.at);
        println!("{}", row(&change.at[1..].replace('/', "."), change.seen));
        look_at(&with_none, change).unwrap_or_else(|found| panic!("{}: {found}", change.at));
    }
}

fn look_at(sound: &Value, change: &Change) -> Result<(), String> {
    let mut changed = sound.clone();
    let leaf = changed.pointer_mut(change.at).unwrap();
    let new = (change.new)(leaf);
    assert_ne!(*leaf, new, "{} does not change", change.at);
    *leaf = new;
    let mut parts = Parts::sound();
    parts.manifest = match serde_json::from_value::<Manifest>(changed) {
        Ok(manifest) => manifest,
        Err(_) if change.seen == Refused => return Ok(()),
        Err(error) => return Err(format!("{error}")),
    };
    if change.at.starts_with("/settings/") {
        let json = serde_json::to_string(&parts.manifest.settings).unwrap();
        let digest = Sha256::digest(json);
        parts.manifest.settings_sha256 = digest.iter().fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        });
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.pmtiles");
    match parts.write(&path) {
        Err(_) if change.seen == Refused => Ok(()),
        Err(error) => Err(error),
        Ok(()) => check(&path, change.seen),
    }
}
