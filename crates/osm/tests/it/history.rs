//! Files that contain more than one point in time are rejected, whether their header says so or
//! not.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use crate::common::{fixture, read, read_bytes};
use corniche_osm::{ExtractDefect, ReadOsmError};
use corniche_testing::pbf::{BlockBuilder, deltas, field, file, number, plain_header, raw};
use proptest::prelude::*;

/// Returns the metadata of an object: its version, and whether it is visible.
fn info(version: Option<i64>, is_visible: Option<bool>) -> Vec<u8> {
    let version = version.map(|version| number(1, version));
    let is_visible = is_visible.map(|is_visible| number(6, i64::from(is_visible)));
    [version, is_visible].into_iter().flatten().flatten().collect()
}

fn way(block: &mut BlockBuilder, id: i64, highway: &str, info: Option<Vec<u8>>) {
    let tags = [("highway", highway)];
    let tags = if highway.is_empty() { &[][..] } else { &tags };
    let message = block.way_message(id, tags, &[1, 2]);
    block.groups.push(field(3, &[message, info.map_or(vec![], |info| field(4, &info))].concat()));
}

/// Returns ways by id, `highway` value (empty: no such tag) and version (0: none), in blocks.
fn of_ways(blocks: &[&[(i64, &str, i64)]]) -> Vec<u8> {
    let mut blobs =
        vec![plain_header(), raw(b"OSMData", &BlockBuilder::with_row_of_nodes(2).bytes())];
    for ways in blocks {
        let mut block = BlockBuilder::new();
        for &(id, highway, version) in *ways {
            way(&mut block, id, highway, (version != 0).then(|| info(Some(version), None)));
        }
        blobs.push(raw(b"OSMData", &block.bytes()));
    }
    blobs.concat()
}

/// Checks the number of duplicate ways, or the words of the rejection.
#[track_caller]
fn check(bytes: &[u8], expected: Result<usize, &str>) {
    match (read_bytes(bytes), expected) {
        (Ok(extract), Ok(duplicates)) => {
            assert_eq!(extract.summary.left_out.duplicate, duplicates as u64);
            let is_duplicate =
                |defect: &&ExtractDefect| matches!(defect, ExtractDefect::DuplicateWay { .. });
            assert_eq!(extract.defects.iter().filter(is_duplicate).count(), duplicates);
        }
        (Err(error @ ReadOsmError::History { .. }), Err(words)) => {
            let message = error.to_string();
            for word in [words, "made.osm.pbf", "osmium time-filter"] {
                assert!(message.contains(word), "{word:?} is not in: {message}");
            }
        }
        (found, _) => panic!("{found:?}"),
    }
}

#[test]
fn a_history_without_its_mark_is_refused() {
    let error = read(&fixture("versions.osm.pbf")).unwrap_err();
    assert!(matches!(error, ReadOsmError::History { .. }), "{error}");
    assert!(error.to_string().contains("the file contains way 5 in versions 1 and 2"), "{error}");
}

#[test]
fn ways_in_several_versions_are_a_history() {
    let two = "the file contains way 5 in versions 1 and 2";
    check(&of_ways(&[&[(5, "track", 1), (5, "track", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "track", 1)], &[(5, "track", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "track", 1)], &[], &[(5, "", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "", 1), (5, "track", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "", 1), (5, "", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "track", 1), (5, "track", 0), (5, "track", 2)]]), Err(two));
    check(&of_ways(&[&[(5, "track", 0), (5, "track", 1), (5, "track", 2)]]), Err(two));
    // If they are not adjacent, they are noticed only if both are roads.
    let apart: [&[_]; 2] = [&[(5, "track", 1), (6, "track", 1)], &[(5, "track", 2)]];
    check(&of_ways(&apart), Err(two));
    let apart: [&[_]; 1] = [&[(5, "track", 2), (6, "track", 1), (5, "track", 0), (5, "track", 1)]];
    check(&of_ways(&apart), Err("the file contains way 5 in versions 2 and 1"));
}

#[test]
fn ways_of_one_version_or_of_none_that_is_known_are_duplicates() {
    check(&of_ways(&[&[(5, "track", 1), (6, "track", 2), (7, "track", 9)]]), Ok(0));
    check(&of_ways(&[&[(5, "track", 0), (6, "track", 0), (7, "track", 0)]]), Ok(0));
    check(&of_ways(&[&[(5, "track", 3), (5, "track", 3)]]), Ok(1));
    check(&of_ways(&[&[(5, "track", 3)], &[(6, "track", 1), (5, "track", 3)]]), Ok(1));
    check(&of_ways(&[&[(5, "track", 0), (5, "track", 0), (5, "", 0)]]), Ok(1));
    check(&of_ways(&[&[(5, "track", 3), (5, "track", 0)]]), Ok(1));
    // Programs write this for an unknown version.
    check(&of_ways(&[&[(5, "track", 3), (5, "track", -1)]]), Ok(1));
    // A node, a way and a relation may share a number.
    let mut block = BlockBuilder::with_row_of_nodes(2);
    way(&mut block, 2, "track", Some(info(Some(7), Some(true))));
    let known = field(4, &info(Some(3), Some(true)));
    block.groups.push(field(4, &[number(1, 2), known].concat()));
    check(&file(&block), Ok(0));
}

#[test]
fn a_deleted_object_of_any_kind_marks_a_history_or_changes() {
    let mut block = BlockBuilder::with_row_of_nodes(2);
    way(&mut block, 6, "", Some(info(Some(2), Some(false))));
    check(&file(&block), Err("the file marks way 6 as deleted"));
    let mut block = BlockBuilder::with_row_of_nodes(2);
    way(&mut block, 6, "track", Some(info(None, Some(false))));
    check(&file(&block), Err("the file marks way 6 as deleted"));
    for (kind, number_of_group, id) in [("node", 1, 18), ("relation", 4, 9)] {
        let mut block = BlockBuilder::with_row_of_nodes(2);
        let place = [number(8, 0), number(9, 0)].concat();
        let place = if kind == "node" { place } else { vec![] };
        let of = |version| [number(1, id), field(4, &info(version, Some(false))), place.clone()];
        block.groups.push(field(number_of_group, &of(Some(1)).concat()));
        check(&file(&block), Err(&format!("the file marks {kind} 9 as deleted")));
        let of = |version| [number(1, id), field(4, &info(Some(version), None)), place.clone()];
        block.groups.pop();
        block.groups.push([of(4), of(5)].map(|of| field(number_of_group, &of.concat())).concat());
        check(&file(&block), Err(&format!("the file contains {kind} 9 in versions 4 and 5")));
    }
}

/// Returns dense nodes with versions and marks, in any number of each.
fn dense(ids: &[i64], versions: &[u8], visible: &[u8]) -> Vec<u8> {
    let zeros = vec![0; ids.len()];
    // There are no times and users, as `add_metadata=version` writes them.
    let known = [field(1, versions), field(6, visible)].concat();
    let nodes = [
        field(1, &deltas(ids)),
        field(5, &known),
        field(8, &deltas(&zeros)),
        field(9, &deltas(&zeros)),
    ];
    let mut block = BlockBuilder::new();
    block.groups.push(field(2, &nodes.concat()));
    block.track(7, &[1, 2]);
    block.bytes()
}

#[test]
fn dense_nodes_are_looked_at_too() {
    let of = |block: Vec<u8>| [plain_header(), raw(b"OSMData", &block)].concat();
    check(&of(dense(&[1, 2, 3], &[4, 5, 6], &[1, 1, 1])), Ok(0));
    check(&of(dense(&[1, 2, 2], &[4, 5, 5], &[])), Ok(0));
    check(&of(dense(&[1, 2, 2], &[4, 5], &[])), Ok(0));
    check(
        &of(dense(&[1, 2, 2], &[4, 5, 6], &[])),
        Err("the file contains node 2 in versions 5 and 6"),
    );
    check(&of(dense(&[1, 2, 3], &[4, 5, 6], &[1, 0, 1])), Err("the file marks node 2 as deleted"));
    check(&of(dense(&[1, 2, 3], &[], &[1, 1, 0])), Err("the file marks node 3 as deleted"));
    let blocks = [dense(&[1, 2], &[1, 1], &[]), dense(&[2, 3], &[2, 1], &[])];
    let blobs = blocks.map(|block| raw(b"OSMData", &block)).concat();
    check(&[plain_header(), blobs].concat(), Err("the file contains node 2 in versions 1 and 2"));
}

/// Returns eight blobs of two nodes each, 1 to 16, then a way along all of them. The nodes' blobs
/// are read after the way: the reader finds out that all blobs before it contain nodes by
/// inspecting some of them, here numbers 0, 4, 6, 7 and 8, and not the others.
fn nodes_then_way() -> Vec<BlockBuilder> {
    let nodes = (0..8).map(|blob| {
        let mut block = BlockBuilder::new();
        block
            .dense(&[1, 2].map(|k| (2 * blob + k, 470_000_000, 90_000_000 + 200 * blob + 100 * k)));
        block
    });
    let mut block = BlockBuilder::new();
    block.track(5, &(1..=16).collect::<Vec<_>>());
    nodes.chain([block]).collect()
}

fn of_blocks(blocks: &[BlockBuilder]) -> Vec<u8> {
    let blobs = blocks.iter().map(|block| raw(b"OSMData", &block.bytes()));
    [plain_header()].into_iter().chain(blobs).collect::<Vec<_>>().concat()
}

/// Returns a relation in its own group.
fn relation(id: i64, info: &[u8]) -> Vec<u8> {
    field(4, &[number(1, id), field(4, info)].concat())
}

#[test]
fn a_deleted_object_among_nodes_that_are_read_last_marks_a_history() {
    let deleted = info(Some(2), Some(false));
    for blob in 0..8 {
        let mut blocks = nodes_then_way();
        let place = [number(8, 0), number(9, 0)].concat();
        let node = [number(1, 40), field(4, &deleted), place].concat();
        blocks[blob].groups.push(field(1, &node));
        check(&of_blocks(&blocks), Err("the file marks node 20 as deleted"));

        let mut blocks = nodes_then_way();
        blocks[blob].groups.push(relation(9, &deleted));
        check(&of_blocks(&blocks), Err("the file marks relation 9 as deleted"));

        let mut blocks = nodes_then_way();
        let mut block = BlockBuilder::new();
        way(&mut block, 6, "track", Some(deleted.clone()));
        blocks.insert(blob, block);
        check(&of_blocks(&blocks), Err("the file marks way 6 as deleted"));
    }
}

/// One version is the last of the nodes, which are read last; the other is in the blob with the
/// way, which is read first.
#[test]
fn versions_on_both_sides_of_where_reading_begins_are_a_history() {
    let node = |version| {
        let place = [number(8, 0), number(9, 0)].concat();
        field(1, &[number(1, 40), field(4, &info(Some(version), None)), place].concat())
    };
    let of = |versions: [i64; 2]| {
        let mut blocks = nodes_then_way();
        blocks[7].groups.push(node(versions[0]));
        blocks[8].groups.insert(0, node(versions[1]));
        of_blocks(&blocks)
    };
    check(&of([1, 2]), Err("the file contains node 20 in versions 1 and 2"));
    check(&of([2, 2]), Ok(0));
}

#[test]
fn relations_among_nodes_that_are_read_last_change_nothing() {
    let expected = read_bytes(&of_blocks(&nodes_then_way())).unwrap();
    assert_eq!((expected.roads.len(), expected.summary.nodes_seen), (1, 16));
    let known = info(Some(3), Some(true));
    for blob in 0..8 {
        // The relation is in a blob of nodes, and then in its own blob.
        let mut beside = nodes_then_way();
        beside[blob].groups.push(relation(9, &known));
        let mut alone = nodes_then_way();
        let mut block = BlockBuilder::new();
        block.groups.push(relation(9, &known));
        alone.insert(blob, block);
        for blocks in [beside, alone] {
            assert_eq!(read_bytes(&of_blocks(&blocks)).unwrap(), expected, "blob {blob}");
        }
        // A way behind the relation is a road, and the nodes of both are found.
        let mut with_way = nodes_then_way();
        with_way[blob].groups.push(relation(9, &known));
        with_way[blob].track(4, &[3, 14]);
        let found = read_bytes(&of_blocks(&with_way)).unwrap();
        let ids: Vec<i64> = found.roads.iter().map(|road| road.way_id).collect();
        assert_eq!((ids, found.defects, found.summary.nodes_seen), (vec![4, 5], vec![], 16));
        assert_eq!(found.roads[1].line, expected.roads[0].line);
    }
}

proptest! {
    /// In a file sorted by id, however it is cut into blocks, two versions of a way are always
    /// noticed, and nothing else is mistaken for them.
    #[test]
    fn a_sorted_file_is_a_history_when_a_way_has_two_versions(
        mut ways in prop::collection::vec((0_i64..12, 0_i64..3, any::<bool>()), 0..14),
        per_block in 1_usize..6,
    ) {
        ways.sort_by_key(|way| way.0);
        let is_history = ways.iter().any(|a| {
            ways.iter().any(|b| a.0 == b.0 && a.1 != b.1 && a.1 != 0 && b.1 != 0)
        });
        let ways: Vec<_> = ways
            .into_iter()
            .map(|(id, version, is_road)| (id, if is_road { "track" } else { "" }, version))
            .collect();
        let blocks: Vec<_> = ways.chunks(per_block).collect();
        let found = read_bytes(&of_ways(&blocks));
        let is_refused = matches!(found, Err(ReadOsmError::History { .. }));
        prop_assert!(is_refused || found.is_ok());
        prop_assert_eq!(is_refused, is_history);
    }
}
