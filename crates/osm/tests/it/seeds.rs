//! Generates the seeds of the fuzz target `osm` (`fuzz/corpus/osm`). `CORNICHE_WRITE_SEEDS=1`
//! writes them again.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs, path::PathBuf};

use crate::common::fixture;
use corniche_testing::pbf::{
    BlockBuilder, deltas, field, file, frame, header, number, packed_blob, plain_header, raw,
};

/// Returns whole files, and single blocks, which the target wraps itself.
fn seeds() -> BTreeMap<&'static str, Vec<u8>> {
    let mut row = BlockBuilder::with_row_of_nodes(5);
    row.track(7, &[1, 2, 3, 2, 5]);
    row.way(8, &[("highway", "motorway"), ("name", "A 13"), ("oneway", "yes")], &[5, 4]);
    let mut broken = BlockBuilder::with_row_of_nodes(3);
    broken.track(7, &[1, 1, 99, 2, 3]);
    broken.track(7, &[1]);
    broken.track(-8, &[]);
    broken.way(9, &[("highway", "goat_trail")], &[1, 2]);
    broken.way(10, &[("highway", "track"), ("area", "yes")], &[1, 2]);
    broken.way(11, &[("building", "yes")], &[1, 2, 3, 1]);
    let mut plain = BlockBuilder::new();
    plain.plain(&[(i64::MIN, 0, 0), (2, 900_000_000, 1_800_000_000), (3, -1, 2_000_000_000)]);
    plain.track(1, &[i64::MIN, 2]);
    plain.frame = [number(17, 100), number(19, 5), number(20, -5)].concat();
    let mut located = BlockBuilder::new();
    let message = located.way_message(7, &[("highway", "track")], &[1, 2]);
    let places = [field(9, &deltas(&[0, 5])), field(10, &deltas(&[1, 7]))].concat();
    located.groups.push(field(3, &[message, places].concat()));
    let mut relation = BlockBuilder::new();
    let members = [number(1, 5), field(8, &[0]), field(9, &[2]), field(10, &[1])].concat();
    relation.groups.push(field(4, &members));
    let mut info = BlockBuilder::new();
    let ids = deltas(&[1, 2]);
    let known: Vec<u8> = (1..=6).flat_map(|number| field(number, &[1, 0])).collect();
    let nodes =
        [field(1, &ids), field(5, &known), field(8, &ids), field(9, &ids), field(10, &[0, 0])];
    info.groups.push(field(2, &nodes.concat()));

    let mut seeds = BTreeMap::from([
        ("file-raw", file(&row)),
        ("file-packed", [plain_header(), packed_blob(b"OSMData", &row.bytes())].concat()),
        ("file-two-blobs", [file(&broken), raw(b"OSMData", &row.bytes())].concat()),
        ("file-header-only", header(&["OsmSchema-V0.6", "LocationsOnWays"])),
        ("file-history", header(&["HistoricalInformation"])),
        ("file-other-blob", [plain_header(), frame(b"_index", b"x")].concat()),
        ("file-twice", [plain_header(), plain_header()].concat()),
        ("file-lz4", [plain_header(), frame(b"OSMData", &field(6, b"...."))].concat()),
        ("text", b"<?xml version='1.0'?><osmChange/>".to_vec()),
        ("empty", Vec::new()),
    ]);
    for (name, block) in [
        ("block-row", &row),
        ("block-broken", &broken),
        ("block-plain", &plain),
        ("block-located", &located),
        ("block-relation", &relation),
        ("block-info", &info),
    ] {
        seeds.insert(name, block.bytes());
    }
    for (name, path) in [
        ("file-classes", "classes.osm.pbf"),
        ("file-classes-raw", "classes-dense-raw.osm.pbf"),
        ("file-defects", "defects.osm.pbf"),
    ] {
        seeds.insert(name, fs::read(fixture(path)).unwrap());
    }
    seeds
}

#[test]
fn the_seeds_of_the_fuzz_target_are_as_the_writer_makes_them() {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/osm"));
    for (name, bytes) in seeds() {
        assert!(bytes.len() <= 4096, "{name}: {} bytes", bytes.len());
        let path = folder.join(name);
        if std::env::var_os("CORNICHE_WRITE_SEEDS").is_some() {
            fs::create_dir_all(&folder).unwrap();
            fs::write(&path, &bytes).unwrap();
        }
        assert_eq!(fs::read(&path).unwrap(), bytes, "{name}");
    }
}
