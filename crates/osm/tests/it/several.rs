//! Several extracts are read as one: an object in two of them counts once, and of two versions the
//! newer one counts.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::common::{
    Extract, POOL, gather, gather_kept, kept, read_bytes, request, roads::read_roads, to_lattice,
};
use corniche_osm::{
    ExtractDefect, ExtractSummary, ReadOsmError, ReadRequest, Share, keep_nodes, keep_ways,
};
use corniche_store::MemoryStore;
use corniche_testing::MemoryScratch;
use corniche_testing::pbf::{BlockBuilder, field, number, plain_header, raw, zigzag};
use proptest::prelude::*;

/// An object's id and version; 0 means no version.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Object {
    id: i64,
    version: i64,
}

#[derive(Debug, Clone)]
struct Way {
    object: Object,
    highway: &'static str,
    more: Vec<(&'static str, &'static str)>,
    node_ids: Vec<i64>,
}

/// Id and version, latitude, longitude.
type Node = (Object, i64, i64);

fn info(version: i64) -> Vec<u8> {
    if version > 0 { field(4, &number(1, version)) } else { Vec::new() }
}

/// Returns a file of nodes and ways, `per_block` of them in a block.
fn file(nodes: &[Node], ways: &[Way], per_block: usize) -> Vec<u8> {
    let mut blobs = vec![plain_header()];
    for some in nodes.chunks(per_block) {
        let mut block = BlockBuilder::new();
        let key = |number: u8| vec![number << 3];
        let node = |&(Object { id, version }, lat, lon): &Node| {
            let places =
                [key(1), zigzag(id), info(version), key(8), zigzag(lat), key(9), zigzag(lon)];
            field(1, &places.concat())
        };
        block.groups.push(some.iter().flat_map(node).collect());
        blobs.push(raw(b"OSMData", &block.bytes()));
    }
    for some in ways.chunks(per_block) {
        let mut block = BlockBuilder::new();
        for way in some {
            let tags = [vec![("highway", way.highway)], way.more.clone()].concat();
            let tags = if way.highway.is_empty() { Vec::new() } else { tags };
            let mut message = block.way_message(way.object.id, &tags, &way.node_ids);
            message.extend(info(way.object.version));
            block.groups.push(field(3, &message));
        }
        blobs.push(raw(b"OSMData", &block.bytes()));
    }
    blobs.concat()
}

/// Writes the files to a folder, and returns their paths.
fn written(files: &[&[u8]]) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let write = |(index, bytes): (usize, &&[u8])| {
        let path = folder.path().join(format!("{index}.osm.pbf"));
        fs::write(&path, bytes).unwrap();
        path
    };
    let paths = files.iter().enumerate().map(write).collect();
    (folder, paths)
}

fn with<T>(paths: &[PathBuf], memory_bytes: u64, use_it: impl FnOnce(&ReadRequest<'_>) -> T) -> T {
    let scratch = MemoryScratch::default();
    let (path, others): (&Path, _) = (&paths[0], &paths[1..]);
    use_it(&ReadRequest { others, memory_bytes, ..request(path, &POOL, &to_lattice, &scratch) })
}

fn read_files(paths: &[PathBuf], memory_bytes: u64) -> Result<Extract, ReadOsmError> {
    with(paths, memory_bytes, |request| {
        gather(|sink, on_defect| read_roads(request, sink, on_defect, &|| false))
    })
}

/// Reads through shares, the last share first.
fn read_shares(paths: &[PathBuf], of: u16, memory_bytes: u64) -> Result<Extract, ReadOsmError> {
    let store = MemoryStore::default();
    let kept = kept(&store);
    with(paths, memory_bytes, |request| {
        let shares: Vec<Share> = Share::all(of).collect();
        for &share in shares.iter().rev() {
            keep_ways(request, share, kept, &|| false)?;
        }
        for &share in shares.iter().rev() {
            keep_nodes(request, share, kept, &|| false)?;
        }
        gather_kept(request, of, &store)
    })
}

/// Reads files at once and in shares, with much memory and with little; the result is always the
/// same.
#[track_caller]
fn read(files: &[&[u8]]) -> Result<Extract, String> {
    let (_folder, paths) = written(files);
    let words = |read: Result<Extract, ReadOsmError>| read.map_err(|error| error.to_string());
    let found = words(read_files(&paths, 1 << 30));
    assert_eq!(words(read_files(&paths, 3000)), found);
    for of in [1, 2, 3, 7] {
        for memory_bytes in [1 << 30, 100_000] {
            assert_eq!(words(read_shares(&paths, of, memory_bytes)), found, "{of} shares");
        }
    }
    found
}

/// Returns the parts of an extract that do not depend on repeated objects or on the order in which
/// defects are reported.
fn apart_from_repeats(mut extract: Extract) -> Extract {
    extract.defects.sort_by_key(|defect| format!("{defect:?}"));
    extract.summary = ExtractSummary { nodes_seen: 0, ways_seen: 0, ..extract.summary };
    extract
}

/// Ways and nodes with the files that contain them, as bits, and the number of them in a block.
type Parts = (Vec<(Way, u8)>, Vec<(Node, u8)>, usize);

/// Generates ways of all kinds with different ids, each in the first file, the second or both, and
/// nodes likewise.
fn parts() -> impl Strategy<Value = Parts> {
    let highways = vec!["track", "residential", "footway", "goat_trail", "proposed", ""];
    let more = prop::sample::subsequence(
        vec![("name", "Bé"), ("area", "yes"), ("layer", "1000"), ("tunnel", "culvert")],
        0..3,
    );
    let way = (
        prop::sample::select(highways),
        more,
        prop::collection::vec(-20_i64..60, 0..9),
        0_i64..3,
        1_u8..4,
    );
    let node = (0_i64..50, 0_i64..50, 0_i64..3, 1_u8..4, prop::bool::weighted(0.9));
    let ways = prop::collection::vec(way, 0..40).prop_map(|ways| {
        let made = |(id, (highway, more, node_ids, version, place))| {
            (Way { object: Object { id, version }, highway, more, node_ids }, place)
        };
        (1_i64..).zip(ways).map(made).collect()
    });
    let nodes = prop::collection::vec(node, 80).prop_map(|nodes| {
        let there = (-20_i64..).zip(nodes).filter(|(_, (.., is_there))| *is_there);
        there
            .map(|(id, (lat, lon, version, place, _))| ((Object { id, version }, lat, lon), place))
            .collect()
    });
    (ways, nodes, 1_usize..20)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// An extract that is cut into two overlapping parts gives the same result as the whole, in
    /// either order.
    #[test]
    fn two_parts_give_the_whole((ways, nodes, per_block) in parts()) {
        let part = |place: u8| {
            let ways: Vec<Way> = ways.iter().filter(|(_, own)| own & place != 0).map(|(way, _)| way.clone()).collect();
            let nodes: Vec<Node> = nodes.iter().filter(|(_, own)| own & place != 0).map(|(node, _)| *node).collect();
            file(&nodes, &ways, per_block)
        };
        let (whole, first, second) = (part(3), part(1), part(2));
        let whole = apart_from_repeats(read_bytes(&whole).unwrap());
        for files in [[&first[..], &second], [&second[..], &first]] {
            let found = apart_from_repeats(read(&files).unwrap());
            prop_assert_eq!(&found, &whole);
        }
        // A file that is given twice changes nothing.
        let found = apart_from_repeats(read(&[&first, &second, &first]).unwrap());
        prop_assert_eq!(&found, &whole);
    }

    /// Whatever the files contain, their order matters at most for the content of equal versions.
    #[test]
    fn the_order_of_files_does_not_matter_for_versions(
        (ways, nodes, per_block) in parts(),
        (others, moved, _) in parts(),
    ) {
        // The second file has the same ids with other content and newer versions.
        let ways: Vec<Way> = ways.into_iter().map(|(way, _)| way).collect();
        let nodes: Vec<Node> = nodes.into_iter().map(|(node, _)| node).collect();
        let newer = |mut object: Object| { object.version += 5; object };
        let others: Vec<Way> = others.into_iter().map(|(way, _)| Way { object: newer(way.object), ..way }).collect();
        let moved: Vec<Node> = moved.into_iter().map(|((object, lat, lon), _)| (newer(object), lat, lon)).collect();
        let (old, new) = (file(&nodes, &ways, per_block), file(&moved, &others, per_block));
        let (one, other) = (read(&[&old, &new]).unwrap(), read(&[&new, &old]).unwrap());
        let [one, other] = [one, other].map(apart_from_repeats);
        prop_assert_eq!(one, other);
    }
}

fn road(id: i64, version: i64, highway: &'static str, node_ids: &[i64]) -> Way {
    Way { object: Object { id, version }, highway, more: Vec::new(), node_ids: node_ids.to_vec() }
}

/// Returns nodes 1 to 9 in a row.
fn row(version: i64) -> Vec<Node> {
    (1..10).map(|id| (Object { id, version }, 470_000_000, 90_000_000 + 1000 * id)).collect()
}

#[test]
fn of_two_versions_of_a_way_the_newer_one_counts() {
    let old = file(&row(1), &[road(5, 1, "track", &[1, 2]), road(6, 1, "track", &[2, 3])], 20);
    let new = file(&row(1), &[road(5, 2, "footway", &[1, 2, 3]), road(6, 1, "track", &[2, 3])], 20);
    for files in [[&old[..], &new], [&new[..], &old]] {
        let found = read(&files).unwrap();
        assert_eq!(found.defects, [ExtractDefect::ConflictingWay { way_id: 5 }]);
        let ids: Vec<i64> = found.roads.iter().map(|road| road.way_id).collect();
        assert_eq!((ids, found.summary.left_out.class_off), (vec![6], 1));
        assert_eq!(found.summary.highway_ways, 2);
    }
}

#[test]
fn of_two_contents_of_one_version_the_first_counts() {
    for version in [0, 3] {
        let one = file(&row(0), &[road(5, version, "track", &[1, 2])], 20);
        let other = file(&row(0), &[road(5, version, "track", &[1, 2, 3])], 20);
        for (files, points) in [([&one[..], &other], 2), ([&other[..], &one], 3)] {
            let found = read(&files).unwrap();
            assert_eq!(found.defects, [ExtractDefect::ConflictingWay { way_id: 5 }]);
            assert_eq!(found.roads[0].line.points().len(), points);
        }
    }
}

#[test]
fn of_two_places_of_a_node_that_of_the_newer_version_counts() {
    let way = [road(5, 1, "track", &[1, 2])];
    let old = file(&row(1), &way, 20);
    let mut moved = row(1);
    moved[0] = (Object { id: 1, version: 2 }, 470_005_000, 90_000_000);
    let new = file(&moved, &way, 20);
    for files in [[&old[..], &new], [&new[..], &old]] {
        let found = read(&files).unwrap();
        assert_eq!(found.defects, [ExtractDefect::ConflictingNode { node_id: 1 }]);
        assert_eq!(found.roads[0].line.points()[0].v, 470_005_000);
    }
    // The same position in another version is not a contradiction.
    let touched = file(&row(7), &way, 20);
    assert_eq!(read(&[&old, &touched]).unwrap().defects, []);
}

#[test]
fn each_extract_for_itself_must_be_of_one_point_in_time() {
    // Versions may differ between files, even if one ends with the way with which the next begins.
    let old = file(&row(1), &[road(5, 1, "track", &[1, 2])], 20);
    let new = file(&[], &[road(5, 2, "track", &[1, 2])], 20);
    assert_eq!(read(&[&old, &new]).unwrap().roads.len(), 1);
    // Versions may not differ within a file.
    let history = file(&row(1), &[road(5, 1, "track", &[1, 2]), road(5, 2, "track", &[1, 2])], 20);
    for (number, files) in [[&history[..], &old], [&old[..], &history]].iter().enumerate() {
        let said = read(files).unwrap_err();
        assert!(said.contains("the file contains way 5 in versions"), "{said}");
        assert!(said.contains(&format!("{number}.osm.pbf")), "{said}");
    }
}

#[test]
fn duplicates_within_one_extract_are_told_as_ever() {
    let twice = file(&row(1), &[road(5, 1, "track", &[1, 2]), road(5, 1, "track", &[1, 2])], 20);
    let once = file(&row(1), &[road(5, 1, "track", &[1, 2])], 20);
    let alone = read(&[&twice]).unwrap();
    assert_eq!(alone.defects, [ExtractDefect::DuplicateWay { way_id: 5 }]);
    let found = read(&[&twice, &once]).unwrap();
    assert_eq!(apart_from_repeats(found), apart_from_repeats(alone));
    // The duplicates of the counting extract are reported; those of the other are not checked.
    assert_eq!(read(&[&once, &twice]).unwrap().defects, []);
}
