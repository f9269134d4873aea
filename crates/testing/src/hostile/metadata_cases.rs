//! Metadata that are too large or nested too deeply, or have invalid numbers.

use serde_json::{Value, json};

use crate::pmtiles::gzip;

use super::{
    case::{Case, ReadOutcome, refused},
    parts::{PackageParts, metadata},
};

fn with_metadata(text: &[u8]) -> Vec<u8> {
    PackageParts { metadata: gzip(text), ..PackageParts::good() }.assemble()
}

/// The good manifest with another value at a JSON pointer.
fn with_value(pointer: &str, value: Value) -> Vec<u8> {
    let mut metadata = metadata();
    *metadata.pointer_mut(&format!("/corniche{pointer}")).unwrap() = value;
    with_metadata(metadata.to_string().as_bytes())
}

/// The good manifest for a part of its data, with these corners.
fn with_clip(nodes: [[i64; 2]; 2], north: f64) -> Vec<u8> {
    let mut metadata = metadata();
    let degrees = json!({ "min_x": 9, "min_y": 47, "max_x": 10, "max_y": north });
    metadata["corniche"]["clip"] = json!({
        "nodes": nodes.map(|[i, j]| json!({ "i": i, "j": j })),
        "whole_data_bounds": metadata["corniche"]["data_bounds"],
        "whole_wgs84_bounds": degrees,
    });
    with_metadata(metadata.to_string().as_bytes())
}

/// The good metadata with raw text as the value of `attribution`.
fn with_attribution(text: &str) -> Vec<u8> {
    let mut metadata = metadata();
    metadata["corniche"]["attribution"] = json!("HERE");
    with_metadata(metadata.to_string().replace("\"HERE\"", text).as_bytes())
}

pub(crate) fn all() -> Vec<Case> {
    let huge = u64::MAX;
    let growth = |key: &str, value: u64| {
        let mut row = metadata()["corniche"]["growth"][0].clone();
        row[key] = json!(value);
        row
    };
    let values = [
        ("no levels", "/levels", json!([]), "the number of levels is 0"),
        ("levels in disorder", "/levels/1/level", json!(2), "levels.level is 2"),
        ("a finest level of 255", "/frame/max_level", json!(255), "too many for one package"),
        ("a finest level of 22", "/frame/max_level", json!(22), "the number of levels is 3"),
        ("a cell of nothing", "/frame/cell_m", json!([0, 1]), "a cell of 0 × 1 m"),
        ("a cell that is no number", "/frame/cell_m", json!([null, 1]), "damaged"),
        (
            "a cell off the lattice",
            "/frame/cell_m",
            json!([10.000_1, 10]),
            "does not fit the lattice",
        ),
        ("an origin beyond the stars", "/frame/origin_m/0", json!(1e300), "frame.origin_m"),
        ("a corner between tiles", "/frame/root_corner/i", json!(3), "not a multiple"),
        ("a corner at 2^63", "/frame/root_corner/j", json!(i64::MIN), "too many"),
        ("a quantum of a third", "/vertical/quantum_m", json!(0.3), "vertical.quantum_m"),
        ("a quantum of 1e308", "/vertical/quantum_m", json!(1e308), "vertical.quantum_m"),
        ("a negative quantum", "/vertical/quantum_m", json!(-0.25), "vertical.quantum_m"),
        ("a denormal quantum", "/vertical/quantum_m", json!(5e-324), "vertical.quantum_m"),
        ("a height range upside down", "/vertical/range_m", json!([1, 0]), "vertical.range_m"),
        ("a scale of nothing", "/point_scale", json!(0), "point_scale is 0.0"),
        ("a negative margin", "/levels/0/width_margin_m", json!(-1), "width_margin_m"),
        ("an error of 1e308", "/levels/0/geometric_error_m", json!(1e308), "geometric_error_m"),
        ("a class of 9", "/levels/0/least_class", json!(9), "levels.least_class is 9"),
        ("2^64 - 1 tiles", "/levels/0/tiles", json!(huge), "add up"),
        ("bounds inside out", "/data_bounds/min_x", json!(1e9), "data_bounds"),
        ("a latitude of 95", "/wgs84_bounds/max_y", json!(95), "wgs84_bounds"),
        ("a coordinate table of 10^9 a side", "/coordinates/size", json!(1_000_000_000), "damaged"),
        ("a coordinate table of 2^64 - 1 a side", "/coordinates/size", json!(huge), "damaged"),
        ("a coordinate table without samples", "/coordinates/samples_deg", json!([]), "damaged"),
        ("a coordinate table of no width", "/coordinates/bounds/max_x", json!(-1e9), "damaged"),
        ("2^64 - 1 roads", "/counts/roads_in", json!(huge), "add up"),
        ("2^64 - 1 samples", "/counts/samples/void", json!(huge), "add up"),
        (
            "losses that overflow",
            "/counts/roads_lost",
            json!([{ "reason": "a", "roads": huge, "length_um": 0 }, { "reason": "b", "roads": 1, "length_um": 0 }]),
            "add up",
        ),
        ("lengths of 2^64 - 1", "/counts/roads_kept_um", json!(huge), "add up"),
        ("ten classes", "/counts/classes", json!(vec![(1, 1); 10]), "counts.classes is 10"),
        ("growth of a level that is not", "/growth/0/level", json!(3), "growth.level is 3"),
        ("growth of class 9", "/growth/0/class", json!(9), "growth.class is 9"),
        (
            "growth that overflows",
            "/growth",
            json!([growth("source_bytes", huge / 2), growth("source_bytes", huge / 2)]),
            "add up",
        ),
        ("growth of 28 rows", "/growth", json!(vec![growth("level", 0); 28]), "growth rows is 28"),
        ("another version", "/format_version", json!(7), "format version 7 is not supported"),
        ("the version before", "/format_version", json!(1), "format version 1 is not supported"),
        ("a version that is a text", "/format_version", json!("0"), "manifest is damaged"),
    ];
    let mut cases: Vec<Case> = values
        .into_iter()
        .map(|(name, pointer, value, reason)| refused(name, with_value(pointer, value), reason))
        .collect();
    cases.extend([
        refused("a part at 2^63", with_clip([[0, 0], [i64::MAX, 9]], 48.0), "clip.nodes"),
        refused("a part at -2^63", with_clip([[0, i64::MIN], [9, 9]], 48.0), "clip.nodes"),
        refused("a part inside out", with_clip([[9, 0], [0, 9]], 48.0), "clip.nodes"),
        refused(
            "a part of a latitude of 95",
            with_clip([[0, 0], [9, 9]], 95.0),
            "clip.whole_wgs84",
        ),
        refused("no JSON", with_metadata(b"terrain"), "manifest is damaged"),
        refused("JSON that ends early", with_metadata(b"{\"corniche\":{"), "manifest is damaged"),
        refused("an ordinary file's", with_metadata(b"{\"name\":\"x\"}"), "ordinary PMTiles"),
        refused(
            "no gzip",
            PackageParts { metadata: vec![3; 99], ..PackageParts::good() }.assemble(),
            "the metadata",
        ),
        refused(
            "a flipped byte",
            {
                let mut parts = PackageParts::good();
                let middle = parts.metadata.len() / 2;
                parts.metadata[middle] ^= 0x55;
                parts.assemble()
            },
            "the metadata",
        ),
        refused(
            "a million brackets in the manifest",
            with_attribution(&"[".repeat(1_000_000)),
            "damaged",
        ),
        refused(
            "a key twice",
            {
                let text = metadata().to_string().replacen("\"crs\":", "\"crs\":\"x\",\"crs\":", 1);
                with_metadata(text.as_bytes())
            },
            "duplicate field",
        ),
    ]);
    let limited = |limit_mib, case: Case| Case { limit_mib, ..case };
    // The limit is twice the decompressed size, because a buffer grows, plus the memory of gzip.
    cases.push(limited(
        52,
        refused("256 MiB of blanks", with_metadata(&vec![b' '; 256 << 20]), "the metadata"),
    ));
    let mut deep = metadata().to_string();
    deep.truncate(deep.len() - 1);
    let (open, close) = ("[".repeat(1_000_000), "]".repeat(1_000_000));
    deep = format!("{deep},\"other\":{open}{close}}}");
    let read = |name, bytes, limit_mib| Case { name, bytes, outcome: ReadOutcome::Read, limit_mib };
    cases.push(read("a million brackets under a foreign key", with_metadata(deep.as_bytes()), 16));
    let texts = format!("[\"\"{}]", ",\"\"".repeat(5_500_000));
    cases.push(limited(
        320,
        refused("five million empty texts", with_attribution(&texts), "bytes of attribution"),
    ));
    let mut long = metadata();
    long["corniche"]["point_scale"] = json!("HERE");
    let long = long.to_string().replace("\"HERE\"", &format!("0.{}", "7".repeat(8_000_000)));
    cases.push(read("a number of eight million digits", with_metadata(long.as_bytes()), 64));
    cases
}
