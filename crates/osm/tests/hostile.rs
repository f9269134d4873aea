//! Files that are no extracts, cut-off extracts, and extracts with changed bytes: a clear error or an answer, never a panic.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod common;

use std::{fs, panic, path::PathBuf, sync::Once};

use common::{fixture, read};
use corniche_osm::{Defect, ReadOsmError};

/// Keeps the decoder's own panics, which the reader turns into errors, from filling the test's output.
fn quiet_decoder() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !panic.location().is_some_and(|location| location.file().contains("osmpbf")) {
                usual(panic);
            }
        }));
    });
}

fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

#[test]
fn says_what_a_file_is_when_it_is_no_extract() {
    for (bytes, found) in [
        (&b"<?xml version='1.0'?><osm version=\"0.6\"/>"[..], "XML"),
        (b"\xef\xbb\xbf\n<osm version=\"0.6\"/>", "XML"),
        (b"\x1f\x8b\x08\0\0\0\0\0", "packed with gzip"),
        (b"BZh91AY&SY", "packed with bzip2"),
        (b"PK\x03\x04........", "a zip archive"),
        (b"\xff\xe0\x04o5m2", "o5m"),
        (b"{\"type\":\"FeatureCollection\"}", "JSON"),
        (b"II*\0\x08\0\0\0", "a TIFF"),
        (b"x", "a file of some other kind"),
        (&[0; 100], "a file of some other kind"),
        (&[255; 100], "a file of some other kind"),
    ] {
        let (_folder, path) = written("extract.osm.pbf", bytes);
        match read(&path) {
            Err(ReadOsmError::NotPbf { found: said, .. }) => assert_eq!(said, found),
            other => panic!("{found}: {other:?}"),
        }
    }
}

#[test]
fn a_file_that_is_missing_empty_or_a_folder_is_named() {
    let (folder, path) = written("empty.osm.pbf", b"");
    assert!(matches!(read(&path), Err(ReadOsmError::Empty { .. })));
    let missing = folder.path().join("missing.osm.pbf");
    let error = read(&missing).unwrap_err();
    assert!(matches!(error, ReadOsmError::Open { .. }), "{error}");
    assert!(error.to_string().contains("missing.osm.pbf"), "{error}");
    assert!(matches!(
        read(folder.path()),
        Err(ReadOsmError::Open { .. } | ReadOsmError::Read { .. })
    ));
}

#[test]
fn an_extract_cut_off_anywhere_is_refused() {
    let whole = fs::read(fixture("classes.osm.pbf")).unwrap();
    let mut ends = blob_ends(&whole);
    assert_eq!(ends.pop(), Some(whole.len()));
    for len in 1..whole.len() {
        let (_folder, path) = written("cut.osm.pbf", &whole[..len]);
        match read(&path) {
            // Between two blobs nothing tells that there was more.
            Ok(_) => assert!(ends.contains(&len), "cut at {len} went unseen"),
            Err(ReadOsmError::Truncated { .. } | ReadOsmError::NotPbf { .. }) => {}
            Err(other) => panic!("cut at {len}: {other}"),
        }
    }
}

/// Where blobs end, by the framing alone: `BlobHeader` ends in field 3, its blob's size as a varint.
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
fn changed_bytes_never_bring_it_down() {
    quiet_decoder();
    // Raw blobs: behind zlib most changes would end at its checksum.
    for name in ["classes-plain-raw.osm.pbf", "classes-dense-raw.osm.pbf"] {
        let whole = fs::read(fixture(name)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("changed.osm.pbf");
        for at in 0..whole.len() {
            for value in [0, 0xff, whole[at] ^ 0x10] {
                let mut bytes = whole.clone();
                bytes[at] = value;
                fs::write(&path, &bytes).unwrap();
                if let Err(error) = read(&path) {
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
}

#[test]
fn numbers_that_overflow_are_damage() {
    quiet_decoder();
    // Ids are zigzag varints, each the difference to the one before: twice the largest of them is beyond i64.
    let largest = [0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01];
    let id = [largest, largest].concat();
    let dense = [field(1, &id), field(8, &[0, 0]), field(9, &[0, 0])].concat();
    let block = [field(1, &field(1, b"")), field(2, &field(2, &dense))].concat();
    let way = [&[0x08, 1], &field(2, &[1])[..], &field(3, &[2]), &field(8, &id)].concat();
    let table = [field(1, b""), field(1, b"highway"), field(1, b"track")].concat();
    let ways = [field(1, &table), field(2, &field(3, &way))].concat();
    let header = [field(4, b"OsmSchema-V0.6"), field(4, b"DenseNodes")].concat();
    for data in [vec![&ways], vec![&block, &ways]] {
        let data: Vec<u8> = data.into_iter().flat_map(|block| blob(b"OSMData", block)).collect();
        let (_folder, path) =
            written("overflow.osm.pbf", &[blob(b"OSMHeader", &header), data].concat());
        // Where the build checks for overflow this is damage; elsewhere the ids wrap and no node has them.
        match read(&path) {
            Ok(extract) => assert_eq!(extract.roads, []),
            Err(error) => assert!(matches!(error, ReadOsmError::Damaged { .. }), "{error}"),
        }
    }
}

#[test]
fn a_tag_outside_the_table_of_strings_is_damage() {
    let way =
        [&[0x08, 1], &field(2, &[1, 99])[..], &field(3, &[2, 2]), &field(8, &[2, 2])].concat();
    let table = [field(1, b""), field(1, b"highway"), field(1, b"track")].concat();
    let block = [field(1, &table), field(2, &field(3, &way))].concat();
    let bytes =
        [blob(b"OSMHeader", &field(4, b"OsmSchema-V0.6")), blob(b"OSMData", &block)].concat();
    let (_folder, path) = written("strings.osm.pbf", &bytes);
    let error = read(&path).unwrap_err();
    assert!(error.to_string().contains("string 99 of a table of 3"), "{error}");
}

#[test]
fn a_feature_that_it_does_not_know_is_named() {
    let bytes = blob(b"OSMHeader", &field(4, b"OsmSchema-V0.7"));
    let (_folder, path) = written("feature.osm.pbf", &bytes);
    let error = read(&path).unwrap_err();
    assert!(matches!(&error, ReadOsmError::Feature { feature, .. } if feature == "OsmSchema-V0.7"));
}

#[test]
fn nodes_with_two_places_or_none_on_earth_are_defects() {
    // Node 2 is given twice, 1e-6 degrees apart; node 3 lies at latitude 1000.
    let ids = deltas(&[1, 2, 2, 3]);
    let (lats, lons) = (deltas(&[0, 0, 0, 10_000_000_000]), deltas(&[0, 50, 60, 70]));
    let dense = [field(1, &ids), field(8, &lats), field(9, &lons)].concat();
    let refs = field(8, &deltas(&[1, 2, 3]));
    let way = [&[0x08, 7], &field(2, &[1])[..], &field(3, &[2]), &refs].concat();
    let table = [field(1, b""), field(1, b"highway"), field(1, b"track")].concat();
    let block = [field(1, &table), field(2, &field(2, &dense)), field(2, &field(3, &way))].concat();
    let bytes = [blob(b"OSMHeader", &field(4, b"DenseNodes")), blob(b"OSMData", &block)].concat();
    let (_folder, path) = written("nodes.osm.pbf", &bytes);
    let extract = read(&path).unwrap();
    assert_eq!(
        extract.defects,
        [Defect::ConflictingNode { node_id: 2 }, Defect::OutOfRange { way_id: 7, points: 1 }]
    );
    let points: Vec<(i64, i64)> =
        extract.roads[0].line.points().iter().map(|p| (p.u, p.v)).collect();
    assert_eq!(points, [(0, 0), (50, 0)]);
}

/// Differences of neighbours as zigzag varints.
fn deltas(values: &[i64]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut previous = 0;
    for value in values {
        let delta = value - previous;
        let mut rest = ((delta << 1) ^ (delta >> 63)) as u64;
        while rest > 127 {
            bytes.push(rest as u8 | 0x80);
            rest >>= 7;
        }
        bytes.push(rest as u8);
        previous = *value;
    }
    bytes
}

/// A length-delimited protobuf field of less than 128 bytes.
fn field(number: u8, content: &[u8]) -> Vec<u8> {
    assert!(content.len() < 128);
    [&[number << 3 | 2, content.len() as u8], content].concat()
}

/// A raw blob with its header and frame.
fn blob(kind: &[u8], block: &[u8]) -> Vec<u8> {
    let blob = field(1, block);
    assert!(blob.len() < 128);
    let header = [&field(1, kind)[..], &[0x18, blob.len() as u8]].concat();
    [&(header.len() as u32).to_be_bytes()[..], &header, &blob].concat()
}
