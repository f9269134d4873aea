//! Every field of a package, changed in turn and put together again with checksums that fit: which check sees it.
//!
//! The fields of the manifest are the leaves of its JSON; those of a payload are listed by patterns that name every
//! field, so that a new one does not compile. A field that is in neither list below fails the test.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

mod support;

use std::{collections::BTreeMap, fmt::Write as _, path::Path};

use corniche_drape::{DrapedLine, DrapedVertex, SvLine};
use corniche_geom::LatticePoint;
use corniche_pipeline::{CheckId, Needs, VerifyError};
use corniche_roads::{Form, FunctionalRoadClass, Oneway, RoadAttributes, Structure};
use corniche_tileset::{GeoRoad, Manifest, RoadRecord, SvRoad, Terrain, TilePayload};
use corniche_tin::{Tin, TinVertex};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use support::parts::{Against, Parts, SOUND, verify_against};

/// What becomes of a package with one field changed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Seen {
    /// The check with this id is broken.
    By(CheckId),
    /// It cannot be made, or cannot be opened: readers and writers refuse the value.
    Refused,
    /// It is told that these are not the files that the package was made from.
    OtherInput(Against),
    /// No check can see it, for this reason; so it stands in docs/promises.md.
    Unseen(&'static str),
}

use CheckId as C;
use Seen::{By, OtherInput, Refused, Unseen};

/// A leaf of the manifest, another value of it, and what sees that.
struct Change {
    /// JSON pointer.
    at: &'static str,
    new: fn(&Value) -> Value,
    seen: Seen,
}

const fn change(at: &'static str, new: fn(&Value) -> Value, seen: Seen) -> Change {
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

const FREE_TEXT: &str = "a text for people; nothing else tells it";
const RENAMED: &str = "files may be renamed, and are known by their content";
const NO_DEM_CRS: &str = "no effect on files that name a CRS; the settings' hash alone tells it";
const NO_LATITUDE: &str =
    "no effect on a CRS that is true to scale; the settings' hash alone tells it";

/// Other values of every leaf of the manifest.
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
    change("/frame/cell_m/0", |_| json!(11.25), By(C::Grid)),
    change("/frame/cell_m/1", |_| json!(20.0), By(C::Grid)),
    change("/frame/root_corner/i", |i| json!(i.as_i64().unwrap() + 256), By(C::Grid)),
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
    change("/vertical/range_m/0", |low| json!(low.as_f64().unwrap() - 1.0), By(C::DemCounts)),
    change("/vertical/range_m/1", one_more, By(C::DemCounts)),
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
    // The sample's ratios are all 1: another one in the middle alone is no distribution.
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
    change("/settings/frc_table", text, By(C::OsmInputs)),
    change("/settings/frc_table_sha256", text, OtherInput(Against::Osm)),
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
];

/// Whether the places in a list mean different things: pairs and triples, not lists of one kind of thing.
fn is_tuple(list: &[Value]) -> bool {
    list.len() <= 4 && list.iter().any(Value::is_number)
}

fn step(list: &[Value], index: &str) -> String {
    if is_tuple(list) { format!(".{index}") } else { "[]".to_owned() }
}

/// The names of all leaves. An empty list is one.
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

/// A row of the table that the tests print.
fn row(name: &str, seen: Seen) -> String {
    let by = match seen {
        By(check) => format!("{} ({})", check.id(), check.needs().text()),
        Refused => "refused".to_owned(),
        OtherInput(Against::Dem) => "refused as other files (`--dem`)".to_owned(),
        OtherInput(_) => "refused as another file (`--osm`)".to_owned(),
        Unseen(reason) => format!("nothing: {reason}"),
    };
    format!("| {name} | {by} |")
}

/// Verifies what lies at `path`, and says what is wrong if it is not seen as expected.
fn check(path: &Path, seen: Seen) -> Result<(), String> {
    let broken = |against| match verify_against(path, against) {
        Ok(report) => Ok(report
            .checks
            .iter()
            .filter(|check| !check.holds())
            .map(|check| check.id)
            .collect::<Vec<_>>()),
        Err(error) => Err(error),
    };
    let needed = |check: CheckId| match check.needs() {
        Needs::Package => Against::Itself,
        Needs::Dem => Against::Dem,
        Needs::Osm => Against::Osm,
    };
    let found = match seen {
        By(check) => match broken(needed(check)) {
            Ok(ids) if ids.contains(&check) => return Ok(()),
            found => format!("{found:?}"),
        },
        OtherInput(against) => match broken(against) {
            Err(
                VerifyError::OtherDem { .. }
                | VerifyError::OtherOsm { .. }
                | VerifyError::OtherTable { .. },
            ) => return Ok(()),
            // The options that are recorded do not go with these files.
            Err(VerifyError::Dem(_)) if against == Against::Dem => return Ok(()),
            found => format!("{found:?}"),
        },
        Refused => match broken(Against::Itself) {
            Err(VerifyError::Open(_)) => return Ok(()),
            found => format!("{found:?}"),
        },
        Unseen(_) => {
            let all = [Against::Itself, Against::Dem, Against::Osm].map(broken);
            if all.iter().all(|found| matches!(found, Ok(ids) if ids.is_empty())) {
                return Ok(());
            }
            format!("{all:?}")
        }
    };
    Err(found)
}

/// Every leaf of the manifest's JSON has a change here, and every change is seen as it says.
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
        println!("{}", row(&name, change.seen));
        if let Unseen(reason) = change.seen {
            let line = format!("| `{name}` | {reason} |");
            assert!(document.contains(&line), "docs/promises.md has no line {line}");
        }
        if let Err(found) = look_at(&sound, change) {
            failed.push(format!("{name}: expected {:?}, found {found}", change.seen));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
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

/// Lists fields of types by patterns that name all of them: one that is added does not compile until it is named.
macro_rules! fields {
    ($($type:ident { $($field:ident),* $(,)? })*) => {
        const PAYLOAD: &[&str] = &[$($(concat!(stringify!($type), ".", stringify!($field)),)*)*];
        $(const _: fn($type) = |$type { $($field: _),* }| ();)*
    };
}

fields! {
    TilePayload { id, terrain, roads_geo, roads_sv, attributes }
    Terrain { tin, normals, geometric_error_m, height_range_m, uncovered_nodes }
    TinVertex { row, column, height_q }
    GeoRoad { way_id, part, class, line }
    DrapedLine { lead_in, vertices, lead_out }
    SvRoad { way_id, part, class, line }
    SvLine { points, ground_range_m }
    LatticePoint { u, v }
    RoadRecord { way_id, attributes }
    RoadAttributes { form, structure, layer, oneway, name, reference, surface }
}

/// The same of the variants of a vertex, and of what has no open fields.
const VARIANTS: &[&str] = &[
    "Source.point",
    "Source.triangle",
    "Crossing.a",
    "Crossing.b",
    "Vertex.vertex",
    "Tin.triangles",
];
const _: fn(DrapedVertex) = |vertex| match vertex {
    DrapedVertex::Source { point: _, triangle: _ }
    | DrapedVertex::Crossing { a: _, b: _ }
    | DrapedVertex::Vertex { vertex: _ } => (),
};

/// A field of a payload, a change to it, and what sees that.
type PayloadChange = (&'static str, fn(&mut Parts), Seen);

const CHANGES: &[PayloadChange] = &[
    ("TilePayload.terrain", |parts| bare(parts).terrain = None, By(C::LevelSums)),
    ("TilePayload.roads_geo", |parts| drop(busy(parts).roads_geo.remove(0)), By(C::Methods)),
    ("TilePayload.roads_sv", without_sv, By(C::Methods)),
    ("TilePayload.attributes", |parts| drop(busy(parts).attributes.pop()), By(C::Attributes)),
    ("Terrain.tin", without_ground, By(C::LevelSums)),
    ("Tin.triangles", flip, By(C::Bound)),
    ("TinVertex.row", |parts| move_vertex(parts, |v| v.row += 1), By(C::Nodes)),
    ("TinVertex.column", |parts| move_vertex(parts, |v| v.column += 1), By(C::Nodes)),
    ("TinVertex.height_q", |parts| move_vertex(parts, |v| v.height_q += 1), By(C::Nodes)),
    ("Terrain.normals", |parts| ground(parts).normals[40][1] += 1, By(C::Normals)),
    ("Terrain.geometric_error_m", |parts| ground(parts).geometric_error_m *= 0.999, By(C::Bound)),
    ("Terrain.height_range_m", |parts| ground(parts).height_range_m[0] -= 0.001, By(C::Ranges)),
    ("Terrain.uncovered_nodes", |parts| ground(parts).uncovered_nodes += 1, By(C::Uncovered)),
    ("GeoRoad.way_id", |parts| geo(parts, |road| road.way_id += 1 << 40), By(C::Methods)),
    ("GeoRoad.part", |parts| geo(parts, |road| road.part += 1), By(C::Order)),
    (
        "GeoRoad.class",
        |parts| geo(parts, |road| road.class = other_class(road.class)),
        By(C::Classes),
    ),
    ("GeoRoad.line", |parts| geo(parts, |road| reverse(&mut road.line)), By(C::OsmGeo)),
    ("DrapedLine.lead_in", |parts| lead(parts, |line| &mut line.lead_in), By(C::Methods)),
    ("DrapedLine.lead_out", |parts| lead(parts, |line| &mut line.lead_out), By(C::Methods)),
    ("DrapedLine.vertices", skip_crossing, By(C::OnTin)),
    ("Source.point", move_source, By(C::Methods)),
    ("Source.triangle", |parts| vertex(parts, is_source, other_triangle), Refused),
    ("Crossing.a", |parts| vertex(parts, is_crossing, |v| crossing(v, 0)), By(C::OnTin)),
    ("Crossing.b", |parts| vertex(parts, is_crossing, |v| crossing(v, 1)), By(C::OnTin)),
    ("Vertex.vertex", |parts| vertex(parts, is_crossing, as_vertex), By(C::OnTin)),
    ("SvRoad.way_id", |parts| sv(parts, |road| road.way_id += 1 << 40), By(C::Methods)),
    ("SvRoad.part", |parts| sv(parts, |road| road.part += 1), By(C::Order)),
    (
        "SvRoad.class",
        |parts| sv(parts, |road| road.class = other_class(road.class)),
        By(C::Classes),
    ),
    ("SvRoad.line", |parts| sv(parts, |road| reverse_sv(&mut road.line)), By(C::OsmSv)),
    ("SvLine.points", |parts| sv(parts, |road| road.line.points[1].u += 40), By(C::Methods)),
    ("SvLine.ground_range_m", |parts| range(parts, 0, 1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 0, -1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 1, 1.0), By(C::SvRange)),
    ("SvLine.ground_range_m", |parts| range(parts, 1, -1.0), By(C::SvRange)),
    ("LatticePoint.u", |parts| sv(parts, |road| road.line.points[1].u += 1), By(C::OsmSv)),
    ("LatticePoint.v", |parts| sv(parts, |road| road.line.points[1].v += 1), By(C::OsmSv)),
    ("RoadRecord.way_id", |parts| busy(parts).attributes[0].way_id -= 1, By(C::Attributes)),
    ("RoadRecord.attributes", |parts| record(parts, |a| a.name.push('x')), By(C::Attributes)),
    (
        "RoadAttributes.form",
        |parts| everywhere(parts, |a| a.form = Form::Roundabout),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.structure",
        |parts| everywhere(parts, |a| a.structure = Structure::Tunnel),
        By(C::OsmAttributes),
    ),
    ("RoadAttributes.layer", |parts| everywhere(parts, |a| a.layer += 1), By(C::OsmAttributes)),
    (
        "RoadAttributes.oneway",
        |parts| everywhere(parts, |a| a.oneway = Oneway::Backward),
        By(C::OsmAttributes),
    ),
    ("RoadAttributes.name", |parts| everywhere(parts, |a| a.name.push('x')), By(C::OsmAttributes)),
    (
        "RoadAttributes.reference",
        |parts| everywhere(parts, |a| a.reference.push('x')),
        By(C::OsmAttributes),
    ),
    (
        "RoadAttributes.surface",
        |parts| everywhere(parts, |a| a.surface.push('x')),
        By(C::OsmAttributes),
    ),
];

/// The finest tile with the most roads.
fn busy(parts: &mut Parts) -> &mut TilePayload {
    let id = parts.tiles_above(0).max_by_key(|tile| tile.roads_geo.len()).unwrap().id;
    let index = parts.index_of(id).unwrap();
    &mut parts.tiles[index]
}

/// A finest tile without roads.
fn bare(parts: &mut Parts) -> &mut TilePayload {
    let id = parts.finest_without_roads();
    let index = parts.index_of(id).unwrap();
    &mut parts.tiles[index]
}

fn ground(parts: &mut Parts) -> &mut Terrain {
    bare(parts).terrain.as_mut().unwrap()
}

/// Changes the GEO road with the most vertices of the busiest tile, and sorts them again.
fn geo(parts: &mut Parts, change: impl Fn(&mut GeoRoad)) {
    let tile = busy(parts);
    let longest =
        (0..tile.roads_geo.len()).max_by_key(|&at| tile.roads_geo[at].line.vertices.len());
    change(&mut tile.roads_geo[longest.unwrap()]);
    tile.roads_geo.sort_by_key(|road| (road.class, road.way_id, road.part));
}

/// Changes the SV road of the same kind.
fn sv(parts: &mut Parts, change: impl Fn(&mut SvRoad)) {
    let frame = *parts.frame();
    let tile = busy(parts);
    let bounds = frame.tile_lattice_bounds(tile.id);
    let inside = |road: &SvRoad| {
        let points = &road.line.points;
        if points.len() > 2 && bounds.contains(points[1]) { points.len() } else { 0 }
    };
    let longest = (0..tile.roads_sv.len()).max_by_key(|&at| inside(&tile.roads_sv[at]));
    change(&mut tile.roads_sv[longest.unwrap()]);
    tile.roads_sv.sort_by_key(|road| (road.class, road.way_id, road.part));
}

fn range(parts: &mut Parts, end: usize, steps: f64) {
    let quantum_m = parts.manifest.vertical.quantum_m;
    sv(parts, |road| road.line.ground_range_m[0][end] += steps * quantum_m);
}

/// Ground without a triangle.
fn without_ground(parts: &mut Parts) {
    let ground = ground(parts);
    (ground.tin, ground.normals) = (Tin::default(), Vec::new());
}

/// Takes a way's SV lines away, its GEO lines stay.
fn without_sv(parts: &mut Parts) {
    let tile = busy(parts);
    let way_id = tile.roads_geo[0].way_id;
    tile.roads_sv.retain(|road| road.way_id != way_id);
}

fn other_class(class: FunctionalRoadClass) -> FunctionalRoadClass {
    FunctionalRoadClass::new((class.number() + 8) % 9).unwrap()
}

fn reverse(line: &mut DrapedLine) {
    line.vertices.reverse();
    std::mem::swap(&mut line.lead_in, &mut line.lead_out);
}

fn reverse_sv(line: &mut SvLine) {
    line.points.reverse();
    line.ground_range_m.reverse();
}

fn is_source(vertex: &DrapedVertex) -> bool {
    matches!(vertex, DrapedVertex::Source { .. })
}

fn is_crossing(vertex: &DrapedVertex) -> bool {
    matches!(vertex, DrapedVertex::Crossing { .. })
}

/// Changes an inner vertex of the busiest tile's longest line.
fn vertex(parts: &mut Parts, wanted: fn(&DrapedVertex) -> bool, change: fn(&mut DrapedVertex)) {
    geo(parts, |road| {
        let inner = road.line.vertices.iter_mut().skip(1).find(|vertex| wanted(vertex));
        change(inner.unwrap());
    });
}

fn other_triangle(vertex: &mut DrapedVertex) {
    if let DrapedVertex::Source { triangle, .. } = vertex {
        *triangle = triangle.wrapping_sub(1).min(40);
    }
}

fn crossing(vertex: &mut DrapedVertex, end: usize) {
    if let DrapedVertex::Crossing { a, b } = vertex {
        let end = if end == 0 { a } else { b };
        *end = if *end > 0 { *end - 1 } else { 1 };
    }
}

fn as_vertex(vertex: &mut DrapedVertex) {
    if let DrapedVertex::Crossing { a, .. } = *vertex {
        *vertex = DrapedVertex::Vertex { vertex: a };
    }
}

fn skip_crossing(parts: &mut Parts) {
    geo(parts, |road| {
        let at = road.line.vertices.iter().position(is_crossing).unwrap();
        road.line.vertices.remove(at);
    });
}

/// Moves a source point a few millimetres, so that it stays in its triangle.
fn move_source(parts: &mut Parts) {
    vertex(parts, is_source, |vertex| {
        if let DrapedVertex::Source { point, .. } = vertex {
            point.v += 40;
        }
    });
}

/// Moves the point that a line without a source point at its end comes from or leads to, a little.
fn lead(parts: &mut Parts, end: fn(&mut DrapedLine) -> &mut Option<LatticePoint>) {
    let mut roads = parts.tiles.iter_mut().flat_map(|tile| &mut tile.roads_geo);
    let point = roads.find_map(|road| end(&mut road.line).as_mut()).expect("a line with a lead");
    point.u += 60;
    point.v += 60;
}

/// Changes a vertex inside the ground of a tile without roads.
fn move_vertex(parts: &mut Parts, change: fn(&mut TinVertex)) {
    let tin = &mut ground(parts).tin;
    let is_inner = |v: &TinVertex| (8..248).contains(&v.row) && (8..248).contains(&v.column);
    for at in 0..tin.vertices().len() {
        let mut vertices = tin.vertices().to_vec();
        change(&mut vertices[at]);
        if is_inner(&vertices[at])
            && let Ok(moved) = Tin::from_canonical(vertices, tin.triangles().to_vec())
        {
            *tin = moved;
            return;
        }
    }
    panic!("no vertex can be moved");
}

/// Turns the edge between two triangles over, where that makes the most of a difference.
fn flip(parts: &mut Parts) {
    let tin = &mut ground(parts).tin;
    let at = |v: u32| tin.vertices()[v as usize];
    let triangles = tin.triangles();
    let mut opposite: BTreeMap<(u32, u32), (usize, u32)> = BTreeMap::new();
    for (index, &[a, b, c]) in triangles.iter().enumerate() {
        for (from, to, other) in [(a, b, c), (b, c, a), (c, a, b)] {
            opposite.insert((from, to), (index, other));
        }
    }
    let area = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(at).map(|v| [i64::from(v.column), -i64::from(v.row)]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut best: Option<(i64, Tin)> = None;
    for (&(a, b), &(left, c)) in &opposite {
        let Some(&(right, d)) = opposite.get(&(b, a)) else { continue };
        // a–b becomes d–c.
        if a > b || area(a, d, c) <= 0 || area(d, b, c) <= 0 {
            continue;
        }
        let height = |v: u32| i64::from(at(v).height_q);
        let bend = (height(a) + height(b) - height(c) - height(d)).abs();
        if best.as_ref().is_some_and(|(most, _)| *most >= bend) {
            continue;
        }
        let mut others: Vec<[u32; 3]> = triangles.to_vec();
        (others[left], others[right]) = ([a, d, c], [d, b, c]);
        best = Some((bend, Tin::new(tin.vertices().to_vec(), &others).unwrap()));
    }
    *tin = best.unwrap().1;
}

/// Changes a way's attributes in one tile.
fn record(parts: &mut Parts, change: fn(&mut RoadAttributes)) {
    // A way that other tiles have too: the busiest tile's first one of its parent.
    let parent = busy(parts).id.parent().unwrap();
    let above = parts.index_of(parent).unwrap();
    change(&mut parts.tiles[above].attributes[0].attributes);
}

/// Changes a way's attributes wherever it is.
fn everywhere(parts: &mut Parts, change: fn(&mut RoadAttributes)) {
    let way_id = busy(parts).attributes[0].way_id;
    let records = parts.tiles.iter_mut().flat_map(|tile| &mut tile.attributes);
    for record in records.filter(|record| record.way_id == way_id) {
        change(&mut record.attributes);
    }
}

/// Every field of a payload has a change here, and every change is seen as it says.
#[test]
fn every_field_of_a_payload_is_seen() {
    let mut all: Vec<&str> = PAYLOAD.iter().chain(VARIANTS).copied().collect();
    all.sort_unstable();
    // Written apart: a payload with another tile's name.
    let mut listed: Vec<&str> = CHANGES.iter().map(|&(name, ..)| name).collect();
    listed.push("TilePayload.id");
    listed.sort_unstable();
    listed.dedup();
    assert_eq!(all, listed, "fields without a change in the list (or the other way round)");

    let mut failed = Vec::new();
    println!("{}", row("TilePayload.id", By(C::Whole)));
    for &(name, change, seen) in CHANGES {
        println!("{}", row(name, seen));
        let mut parts = Parts::sound();
        change(&mut parts);
        assert!(parts.tiles != SOUND.parts.tiles, "{name} does not change");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("changed.pmtiles");
        let found = match parts.write(&path) {
            Err(_) if seen == Refused => Ok(()),
            Err(error) => Err(format!("cannot be encoded: {error:?}")),
            Ok(()) => check(&path, seen),
        };
        if let Err(found) = found {
            failed.push(format!("{name}: expected {seen:?}, found {found}"));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A payload says which tile it is; in another's place it is not taken.
#[test]
fn a_payload_in_another_tiles_place_is_seen() {
    let mut tiles = SOUND.encoded.clone();
    let (last, other) = (tiles.len() - 1, tiles.len() - 2);
    let bytes = std::mem::take(&mut tiles[last].1);
    tiles[last].1 = std::mem::replace(&mut tiles[other].1, bytes);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.pmtiles");
    support::parts::write(&path, &SOUND.parts.manifest, &tiles).unwrap();
    assert_eq!(check(&path, By(C::Whole)), Ok(()));
}
