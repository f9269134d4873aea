//! Truncated extracts, flipped bits, and blocks that contradict themselves cause a clear error or a
//! result, never a panic.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use crate::common::{Extract, fixture, read, read_bytes, written};
use corniche_osm::ReadOsmError;
use corniche_testing::pbf::{
    BlockBuilder, deltas, field, file, frame, frame_with, number, packed_blob, plain_header, raw,
    varint, zigzags,
};

/// Returns the ends of blobs, from the framing alone: `BlobHeader` ends in field 3, the size of its
/// blob as a varint.
fn blob_ends(bytes: &[u8]) -> Vec<usize> {
    let (mut at, mut ends) = (0, Vec::new());
    while at < bytes.len() {
        let header_bytes = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let header = &bytes[at + 4..at + 4 + header_bytes];
        let type_bytes = usize::from(header[1]);
        let varint = &header[2 + type_bytes + 1..];
        let size = varint.iter().rev().fold(0, |size, byte| (size << 7) | usize::from(byte & 0x7f));
        at += 4 + header_bytes + size;
        ends.push(at);
    }
    ends
}

#[test]
fn an_extract_cut_off_anywhere_is_refused() {
    // One file has one block; the other has a block of nodes and a block of ways that need them.
    let mut ways = BlockBuilder::new();
    ways.track(7, &[1, 2, 3]);
    let nodes = BlockBuilder::with_row_of_nodes(3).bytes();
    let made = [plain_header(), raw(b"OSMData", &nodes), packed_blob(b"OSMData", &ways.bytes())];
    for whole in [fs::read(fixture("classes.osm.pbf")).unwrap(), made.concat()] {
        let ends = blob_ends(&whole);
        assert_eq!(ends.last(), Some(&whole.len()));
        for len in 1..whole.len() {
            match read_bytes(&whole[..len]) {
                // A file cut between two blobs looks complete.
                Ok(extract) => {
                    assert!(ends.contains(&len), "cut at {len} went unseen");
                    assert_eq!(extract.roads, []);
                }
                Err(error @ ReadOsmError::Truncated { .. }) => {
                    let words = error.to_string();
                    assert!(words.contains("made.osm.pbf") && words.contains("download it again"));
                    assert!(words.contains(&format!("the file ends at {len}")), "{words}");
                }
                Err(other) => panic!("cut at {len}: {other}"),
            }
        }
    }
}

#[test]
fn nodes_lost_by_a_cut_between_blobs_show_as_missing() {
    let mut ways = BlockBuilder::new();
    ways.track(7, &[1, 2, 3]);
    let nodes = BlockBuilder::with_row_of_nodes(3).bytes();
    let whole = [plain_header(), packed_blob(b"OSMData", &ways.bytes()), raw(b"OSMData", &nodes)];
    let extract = read_bytes(&whole[..2].concat()).unwrap();
    let summary = &extract.summary;
    assert_eq!((summary.nodes_missing, summary.left_out.without_line), (3, 1));
    assert_eq!(
        extract.reasons().into_iter().collect::<Vec<_>>(),
        [("missing nodes", 1), ("no line left", 1)]
    );
    assert_eq!(read_bytes(&whole.concat()).unwrap().roads.len(), 1);
}

/// Returns the parts of a reading that are equal in two readings if no roads were changed.
fn roads_and_losses(
    extract: &Extract,
) -> (&[corniche_roads::Road], &[corniche_osm::ExtractDefect]) {
    (&extract.roads, &extract.defects)
}

#[test]
fn a_flipped_bit_in_packed_blobs_is_seen_wherever_it_could_matter() {
    let whole = fs::read(fixture("classes.osm.pbf")).unwrap();
    let right = read_bytes(&whole).unwrap();
    for bit in 0..8 * whole.len() {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        match read_bytes(&flipped) {
            // The flipped bit is in the compression level, or in a size that is only promised.
            Ok(extract) if roads_and_losses(&extract) == roads_and_losses(&right) => {} // The type of a blob has no checksum: another one is passed over, as the format asks.
            Ok(extract) => {
                assert_eq!(extract.summary.blobs_passed_over, 1, "bit {bit}");
            }
            Err(error) => assert!(error.to_string().contains("made.osm.pbf"), "{error}"),
        }
    }
}

#[test]
fn a_flipped_bit_in_raw_blobs_never_brings_it_down() {
    for name in ["classes-plain-raw.osm.pbf", "classes-dense-raw.osm.pbf"] {
        let whole = fs::read(fixture(name)).unwrap();
        for bit in 0..8 * whole.len() {
            let mut flipped = whole.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            if let Err(error) = read_bytes(&flipped) {
                assert!(error.to_string().contains("made.osm.pbf"), "{error}");
            }
        }
    }
}

#[track_caller]
fn check_damaged(bytes: &[u8], words: &str) {
    let error = read_bytes(bytes).unwrap_err();
    assert!(
        matches!(error, ReadOsmError::Damaged { .. } | ReadOsmError::Truncated { .. }),
        "{error}"
    );
    let message = error.to_string();
    for word in [words, "made.osm.pbf", "download it again"] {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

#[test]
fn sizes_that_cannot_be_are_damage() {
    let kind = field(1, b"OSMData");
    let data = |header: Vec<u8>, blob: &[u8]| [plain_header(), frame_with(header, blob)].concat();
    let sized = |size: i64| data([kind.clone(), number(3, size)].concat(), b"");
    let header_of = |bytes: u32| [plain_header(), bytes.to_be_bytes().to_vec()].concat();
    check_damaged(&header_of(0), "the blob header has no type");
    check_damaged(&header_of(64 << 10), "the blob header claims to be 65536 bytes long");
    check_damaged(&header_of(u32::MAX), "the blob header claims to be 4294967295 bytes long");
    check_damaged(&header_of(100), "is truncated");
    check_damaged(&sized(-1), "the blob claims to be -1 bytes long");
    check_damaged(&sized(i64::from(i32::MIN)), "the blob claims to be -2147483648 bytes long");
    check_damaged(&sized((32 << 20) + 1), "the blob claims to be 33554433 bytes long");
    check_damaged(&sized(32 << 20), "is truncated");
    check_damaged(&sized(1), "is truncated");
    check_damaged(&sized(0), "the blob contains no data");
    check_damaged(&data(kind.clone(), b""), "the blob header has no size");
    check_damaged(&data(number(3, 0), b""), "the blob header has no type");

    let with_data = |blob: Vec<u8>| [plain_header(), frame(b"OSMData", &blob)].concat();
    let block = BlockBuilder::with_row_of_nodes(20).bytes();
    let packed = corniche_testing::pbf::zlib(&block);
    let len = block.len() as i64;
    for (promised, words) in [
        (len - 1, "the blob unpacks to more than"),
        (len + 1, "but unpacks to"),
        (-1, "-1 bytes long; the limit is 33554431"),
        (32 << 20, "33554432 bytes long; the limit is 33554431"),
        (i64::MAX, "the limit is 33554431"),
    ] {
        check_damaged(&with_data([number(2, promised), field(3, &packed)].concat()), words);
    }
    check_damaged(&with_data(field(3, &packed[..packed.len() / 2])), "is truncated");
    check_damaged(
        &with_data(field(3, &corniche_testing::pbf::zlib(&vec![0; 40 << 20]))),
        "more than 33554431",
    );
    check_damaged(&with_data(field(1, &vec![0; 32 << 20])), "bytes long");
}

/// Returns a block of some fields in one group.
fn group(fields: &[Vec<u8>]) -> BlockBuilder {
    let mut block = BlockBuilder::new();
    for text in ["highway", "track"] {
        block.text(text.as_bytes());
    }
    block.groups.push(fields.concat());
    block
}

fn dense(fields: &[Vec<u8>]) -> BlockBuilder {
    group(&[field(2, &fields.concat())])
}

/// Returns a way whose tag is `highway=track`, with further fields.
fn way(fields: &[Vec<u8>]) -> BlockBuilder {
    group(&[field(3, &[number(1, 7), field(2, &[1]), field(3, &[2]), fields.concat()].concat())])
}

#[test]
fn blocks_that_contradict_themselves_are_damage() {
    let check = |block: &BlockBuilder, words: &str| check_damaged(&file(block), words);
    // Parallel arrays must have the same length.
    let columns = |ids: &[i64], lats: &[i64], lons: &[i64]| {
        dense(&[field(1, &deltas(ids)), field(8, &deltas(lats)), field(9, &deltas(lons))])
    };
    check(
        &columns(&[1, 2], &[1], &[1, 2]),
        "the block lists 2 nodes, 1 latitudes and 2 longitudes",
    );
    check(&columns(&[1], &[1, 2], &[1]), "the block lists 1 nodes, 2 latitudes and 1 longitudes");
    check(&columns(&[1, 2], &[1, 2], &[]), "the block lists 2 nodes, 2 latitudes and 0 longitudes");
    check(&columns(&[], &[1], &[1]), "the block lists 0 nodes");
    check(&way(&[field(2, &[1])]), "way 7 has 2 keys and 1 values");
    check(&way(&[field(3, &[1])]), "way 7 has 1 keys and 2 values");
    let located = |nodes: i64, lats: i64, lons: i64| {
        let up_to = |count: i64| deltas(&(1..=count).collect::<Vec<_>>());
        way(&[field(8, &up_to(nodes)), field(9, &up_to(lats)), field(10, &up_to(lons))])
    };
    check(&located(2, 2, 1), "way 7 has 2 nodes, 2 latitudes and 1 longitudes");
    check(&located(2, 1, 1), "way 7 has 2 nodes, 1 latitudes and 1 longitudes");
    check(&located(1, 2, 2), "way 7 has 1 nodes, 2 latitudes and 2 longitudes");
    check(&located(2, 0, 2), "way 7 has 2 nodes, 0 latitudes and 2 longitudes");

    // Texts are not in the table: of a key, of a value, and of a way that is not a road at all.
    check(&way(&[field(2, &[3]), field(3, &[1])]), "a tag of way 7 refers to string 3 of 3");
    check(&way(&[field(2, &[1]), field(3, &varint(1 << 40))]), "refers to string 1099511627776 of");
    let building = [number(1, 8), field(2, &[0]), field(3, &[9])].concat();
    check(&group(&[field(3, &building)]), "a tag of way 8 refers to string 9 of 3");
    let many = vec![1; (1 << 16) + 1];
    check(&way(&[field(2, &many), field(3, &many)]), "way 7 has 65538 tags");

    // Numbers overflow when they are added up, or when positions are computed.
    let far = zigzags(&[i64::MAX, 1]);
    let back = zigzags(&[i64::MIN, -1]);
    let here = zigzags(&[0, 0]);
    for ids in [&far, &back] {
        check(
            &dense(&[field(1, ids), field(8, &here), field(9, &here)]),
            "ids of dense nodes overflow",
        );
        check(&way(&[field(8, ids)]), "the ids of a way's nodes overflow");
    }
    for places in [&far, &back, &zigzags(&[i64::MAX / 100, 1])] {
        let columns = |lats, lons| dense(&[field(1, &here), field(8, lats), field(9, lons)]);
        check(&columns(places, &here), "coordinates of nodes overflow");
        check(&columns(&here, places), "coordinates of nodes overflow");
        check(&way(&[field(8, &here), field(9, places), field(10, &here)]), "overflow");
    }
    let info = |number: u64, values: &[u8]| {
        let nodes = [field(1, &here), field(8, &here), field(9, &here)].concat();
        dense(&[nodes, field(5, &field(number, values))])
    };
    check(&info(2, &far), "versions or users of dense nodes overflow");
    check(&info(3, &back), "versions or users of dense nodes overflow");
    check(
        &info(4, &zigzags(&[i64::from(i32::MAX), 1])),
        "versions or users of dense nodes overflow",
    );
    check(
        &info(5, &zigzags(&[i64::from(i32::MIN), -1])),
        "versions or users of dense nodes overflow",
    );
    let mut plain = BlockBuilder::new();
    plain.plain(&[(5, i64::MAX, 0)]);
    check(&plain, "the coordinates of node 5 overflow");

    // Granularity and offsets are invalid.
    let framed = |fields: &[Vec<u8>]| {
        let mut block = BlockBuilder::with_row_of_nodes(2);
        block.frame = fields.concat();
        block
    };
    for granularity in [0, -1, i64::from(i32::MAX) + 1, i64::MIN] {
        check(
            &framed(&[number(17, granularity)]),
            &format!("the granularity of the block is {granularity}"),
        );
    }
    check(&framed(&[number(19, i64::MAX)]), "coordinates of nodes overflow");
    check(&framed(&[number(20, i64::MAX - 8_000_000_000)]), "coordinates of nodes overflow");

    // Fields that may occur once occur twice.
    let nodes = field(2, &[field(1, &here), field(8, &here), field(9, &here)].concat());
    check(&group(&[nodes.clone(), nodes]), "two lists of dense nodes in one group");
    check(&framed(&[field(1, &field(1, b""))]), "the block has 2 string tables");
    let once = field(5, &field(1, &[1, 1]));
    check(&dense(&[once.clone(), once]), "two metadata lists for its nodes");

    // The bytes are not a message, or are another message.
    check(&group(&[number(2, 5)]), "has the wrong wire type");
    check(&group(&[number(3, 5)]), "has the wrong wire type");
    check(&group(&[field(3, b"\x08")]), "a number is truncated");
    check(&group(&[field(3, b"\x08\x07\x42\x05\x01")]), "a field extends beyond its message");
    check(&group(&[field(3, &field(8, b"\x02\x80"))]), "a number is truncated");
    check(&group(&[vec![0x1b]]), "a field has an unknown wire type");
    check(&dense(&[field(10, b"\x80")]), "a number is truncated");
    check_damaged(&[plain_header(), raw(b"OSMData", b"")].concat(), "missing required fields");
    check(&group(&[field(3, b"")]), "missing required fields");
}

#[test]
fn blocks_that_would_fill_the_memory_are_damage() {
    let check = |block: &BlockBuilder, words: &str| {
        let bytes = [plain_header(), packed_blob(b"OSMData", &block.bytes())].concat();
        assert!(bytes.len() < 1 << 20, "{} bytes", bytes.len());
        check_damaged(&bytes, words);
    };
    let full = "decoding the block takes more memory than allowed";
    let times = |count: usize, field: &[u8]| field.repeat(count);
    check(&group(&[times(2 << 20, &field(1, &[8, 0, 64, 0, 72, 0]))]), full);
    check(&group(&[times(2 << 20, &field(3, &[8, 0]))]), full);
    check(&group(&[times(2 << 20, &field(4, &[8, 0]))]), full);
    check(&group(&[times(3 << 20, &number(99, 0))]), full);
    check(&group(&[field(3, &[number(1, 7), times(3 << 20, &number(99, 0))].concat())]), full);
    let mut block = BlockBuilder::new();
    block.groups = vec![Vec::new(); 2 << 20];
    check(&block, full);
    let mut block = BlockBuilder::new();
    block.texts = vec![Vec::new(); 9 << 20];
    check(&block, full);
    // Each of many roads has a name, which takes memory for each of them.
    let mut block = BlockBuilder::new();
    let name = "x".repeat(2000);
    let message = block.way_message(
        1,
        &[("highway", "track"), ("name", &name), ("ref", &name), ("surface", &name)],
        &[1, 2],
    );
    block.groups.push(times(400_000, &field(3, &message)));
    check(&block, "the contents of the block take more memory than allowed");
}

#[test]
fn an_extract_that_unpacks_to_more_than_its_size_can_mean_is_refused() {
    let mut block = BlockBuilder::new();
    let ids = vec![1; 1 << 20];
    block.way(1, &[("highway", "track")], &[]);
    let message =
        [block.way_message(1, &[("highway", "track")], &[]), field(8, &zigzags(&ids))].concat();
    block.groups.push(field(3, &message));
    let blob = packed_blob(b"OSMData", &block.bytes());
    let bytes = [plain_header(), blob.repeat(6)].concat();
    assert!(bytes.len() < 20_000, "{}", bytes.len());
    let error = read_bytes(&bytes).unwrap_err();
    assert!(matches!(error, ReadOsmError::TooMuch { .. }), "{error}");
    assert!(error.to_string().contains("pbf_compression=none"), "{error}");
    // The same applies if the block is as large as it claims to be.
    let bytes = [plain_header(), raw(b"OSMData", &block.bytes()).repeat(6)].concat();
    assert_eq!(read_bytes(&bytes).unwrap().summary.highway_ways, 12);
}

#[test]
fn fields_that_are_not_known_are_passed_over() {
    let mut block = BlockBuilder::with_row_of_nodes(2);
    let message = block.way_message(7, &[("highway", "track")], &[1, 2]);
    let later =
        [number(77, 5), field(78, b"later"), varint(79 << 3 | 5), b"....".to_vec()].concat();
    block.groups.push([field(3, &[message, later.clone()].concat()), later.clone()].concat());
    block.frame = later;
    let extract = read_bytes(&file(&block)).unwrap();
    assert_eq!((extract.roads.len(), extract.defects.len()), (1, 0));
}

#[test]
fn numbers_may_stand_one_by_one() {
    let one_by_one = |field: u64, values: &[u8]| {
        values
            .iter()
            .flat_map(|&value| [varint(field << 3), vec![value]].concat())
            .collect::<Vec<_>>()
    };
    let mut block = group(&[]);
    block.groups = vec![
        [field(
            2,
            &[one_by_one(1, &[2, 2]), one_by_one(8, &[0, 0]), field(9, &zigzags(&[0, 5]))].concat(),
        )]
        .concat(),
        field(3, &[number(1, 7), number(2, 1), number(3, 2), one_by_one(8, &[2, 2])].concat()),
    ];
    let extract = read_bytes(&file(&block)).unwrap();
    let points: Vec<_> = extract.roads[0].line.points().iter().map(|p| (p.u, p.v)).collect();
    assert_eq!(points, [(0, 0), (5, 0)]);
}

#[test]
fn a_file_reads_as_its_bytes_do() {
    let path = fixture("defects.osm.pbf");
    let bytes = fs::read(&path).unwrap();
    assert_eq!(read(&path).unwrap(), read_bytes(&bytes).unwrap());
    let (_folder, path) = written("copy.osm.pbf", &bytes);
    assert_eq!(read(&path).unwrap(), read_bytes(&bytes).unwrap());
}
