//! Files that are not extracts, or extracts that cannot be used: the message says what the file is
//! and what to do.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap and says what it skips"
)]

use std::{fs, path::Path, process::Command};

use crate::common::{fixture, read, read_bytes, written};
use corniche_osm::ReadOsmError;
use corniche_testing::pbf::{
    BlockBuilder, field, frame, header, number, packed_blob, plain_header, raw, zlib,
};

/// Checks that the message names the file and contains all these words.
#[track_caller]
fn check(name: &str, bytes: &[u8], words: &[&str]) {
    let (_folder, path) = written(name, bytes);
    check_refused(&path, words);
}

#[track_caller]
fn check_refused(path: &Path, words: &[&str]) {
    let error = read(path).unwrap_err().to_string();
    let name = path.file_name().unwrap().to_str().unwrap();
    for word in words.iter().chain(&[name]) {
        assert!(error.contains(word), "{word:?} is not in: {error}");
    }
}

fn utf16_le(text: &str) -> Vec<u8> {
    [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
}

fn utf16_be(text: &str) -> Vec<u8> {
    [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect()
}

#[test]
fn a_file_of_another_format_is_named_with_the_way_to_convert_it() {
    const CONVERT: &str = "osmium cat IN -o OUT.osm.pbf";
    const CHANGES: &str = "osmium apply-changes IN.osm.pbf CHANGES -o OUT.osm.pbf";
    const HISTORY: &str = "osmium time-filter IN 2026-01-01T00:00:00Z -o OUT.osm.pbf";
    const OTHER: &str = "pass an OpenStreetMap extract";
    for (name, bytes, found, advice) in [
        ("a.osm", &b"<?xml version='1.0'?>\n<osm version=\"0.6\"/>"[..], "is XML, ", CONVERT),
        ("a.osm", b"\xef\xbb\xbf\n<osm version=\"0.6\"/>", "is XML, ", CONVERT),
        (
            "a.osm",
            b"<?xml version='1.0'?><!-- <html> --><osm version=\"0.6\"/>",
            "is XML, ",
            CONVERT,
        ),
        ("a.osm", b"<?xml version='1.0'?>", "is XML, ", CONVERT),
        ("a.osh", b"<?xml version='1.0'?><osm version=\"0.6\"/>", "is XML, ", HISTORY),
        ("a.osc", b"<?xml version='1.0'?>\n<osmChange version=\"0.6\"/>", "change file", CHANGES),
        ("a.gpx", b"<?xml version='1.0'?><gpx/>", "without OpenStreetMap data", OTHER),
        ("a.osm.pbf", b"<!DOCTYPE html><html>404 Not Found</html>", "an HTML page", "download"),
        ("a.osm.pbf", b"\n<HTML><body>busy</body></HTML>", "an HTML page", "download"),
        (
            "a.osm.pbf",
            b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n",
            "a Git LFS pointer",
            "git lfs pull",
        ),
        ("a.osm.gz", b"\x1f\x8b\x08\0\0\0\0\0", "compressed with gzip", CONVERT),
        ("a.osc.gz", b"\x1f\x8b\x08\0\0\0\0\0", "compressed with gzip", CHANGES),
        ("a.osm.bz2", b"BZh91AY&SY", "compressed with bzip2", CONVERT),
        ("a.osh.bz2", b"BZh91AY&SY", "compressed with bzip2", HISTORY),
        ("a.zip", b"PK\x03\x04........", "a zip archive", "unpack it"),
        ("a.osm.zst", b"\x28\xb5\x2f\xfd........", "compressed with zstd", "unpack it"),
        ("a.osm.xz", b"\xfd7zXZ\0........", "compressed with xz", "unpack it"),
        ("a.osm.lz4", b"\x04\x22\x4d\x18........", "compressed with LZ4", "unpack it"),
        ("a.7z", b"7z\xbc\xaf\x27\x1c........", "a 7-Zip archive", "unpack it"),
        ("a.o5m", b"\xff\xe0\x04o5m2", "o5m", CONVERT),
        ("a.o5c", b"\xff\xe0\x04o5c2", "change file (o5c)", CHANGES),
        ("a.opl", b"n1 v1 dV c0 t i0 u T x9.5 y47.1\n", "OPL", CONVERT),
        ("a.opl", b"w-10 v1 dV\n", "OPL", CONVERT),
        ("a.geojson", b"{\"type\":\"FeatureCollection\"}", "JSON", OTHER),
        ("a.geojsonl", b"[{}]", "JSON", OTHER),
        ("a.pmtiles", b"PMTiles\x03........", "a tile package", OTHER),
        ("a.gpkg", b"SQLite format 3\0....", "an SQLite database", OTHER),
        ("a.shp", b"\0\0\x27\x0a\0\0\0\0\0\0\0\0", "a shapefile", OTHER),
        ("a.tif", b"II*\0\x08\0\0\0", "a TIFF", OTHER),
        ("a.tif", b"MM\0*\0\0\0\x08", "a TIFF", OTHER),
        ("a.tif", b"II+\0\x08\0\0\0", "a BigTIFF", OTHER),
        ("a.txt", b"x", "is text", OTHER),
        ("a.txt", "né à Vaduz".as_bytes(), "is text", OTHER),
        ("a.osm", &utf16_le("<?xml version='1.0'?>\n<osm version='0.6'/>"), "is XML, ", CONVERT),
        ("a.osm", &utf16_be("\n<osm version='0.6'/>"), "is XML, ", CONVERT),
        ("a.osc", &utf16_be("<osmChange version='0.6'/>"), "change file", CHANGES),
        ("a.osm.pbf", &utf16_le("<!DOCTYPE html><html>404</html>"), "an HTML page", "download"),
        ("a.txt", &utf16_le("né à Vaduz \u{1f6e3}"), "is text in UTF-16", OTHER),
        ("a.txt", &utf16_be("né à Vaduz \u{1f6e3}"), "is text in UTF-16", OTHER),
        ("a.txt", &utf16_le(&"é".repeat(5000)), "is text in UTF-16", OTHER),
        // Nobody can tell that this is UTF-32.
        ("a.txt", b"\xff\xfe\0\0x\0\0\0", "unknown format", OTHER),
        ("a.osm.pbf", &[0; 100], "unknown format", OTHER),
        ("a.osm.pbf", &[255, 0, 255, 0], "unknown format", OTHER),
        ("a.osm.pbf", b"\0\0\0\x0d\x0a\x09OSM\x01eader\x18\x01", "unknown format", OTHER),
    ] {
        check(name, bytes, &[found, advice, "not .osm.pbf"]);
    }
}

#[test]
fn a_way_that_begins_like_an_object_of_opl_is_only_text() {
    for bytes in [&b"nothing"[..], b"n", b"n- v1", b"w1x v1", b"relation"] {
        check("a.txt", bytes, &["is text"]);
    }
}

#[test]
fn a_path_that_is_no_file_is_refused_and_nothing_waits() {
    let (folder, path) = written("empty.osm.pbf", b"");
    check_refused(&path, &["is empty (0 bytes)", "download it again"]);
    let missing = folder.path().join("missing.osm.pbf");
    check_refused(&missing, &["cannot open"]);
    let nested = folder.path().join("empty.osm.pbf/x.osm.pbf");
    check_refused(&nested, &["cannot open"]);
    let directory = folder.path().join("roads.osm.pbf");
    fs::create_dir(&directory).unwrap();
    check_refused(&directory, &["is a folder, not a file"]);
    if cfg!(unix) {
        let pipe = folder.path().join("pipe.osm.pbf");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        check_refused(&pipe, &["is a pipe or a device, not a file"]);
        let link = folder.path().join("link.osm.pbf");
        std::os::unix::fs::symlink(&missing, &link).unwrap();
        check_refused(&link, &["cannot open"]);
    }
}

#[cfg(unix)]
#[test]
fn a_file_that_may_not_be_read_is_said_to_be_so() {
    use std::os::unix::fs::PermissionsExt;
    let (_folder, path) = written("locked.osm.pbf", b"x");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).unwrap();
    if fs::File::open(&path).is_ok() {
        corniche_testing::skip("this user may read everything");
        return;
    }
    check_refused(&path, &["cannot open"]);
}

#[test]
fn a_compression_that_is_not_supported_is_named() {
    let check = |number: u64, method: &str| {
        let block = BlockBuilder::new().bytes();
        for bytes in [
            [frame(b"OSMHeader", &field(number, b"....")), raw(b"OSMData", &block)].concat(),
            [plain_header(), frame(b"OSMData", &field(number, b"...."))].concat(),
        ] {
            let error = read_bytes(&bytes).unwrap_err();
            assert!(
                matches!(error, ReadOsmError::Compression { method: said, .. } if said == method)
            );
            assert!(error.to_string().contains("osmium cat IN.osm.pbf -o OUT.osm.pbf"), "{error}");
        }
    };
    for (number, method) in [(4, "LZMA"), (5, "bzip2"), (6, "LZ4"), (7, "zstd")] {
        check(number, method);
    }
    let error = read(&fixture("classes-lz4.osm.pbf")).unwrap_err();
    assert!(matches!(error, ReadOsmError::Compression { method: "LZ4", .. }), "{error}");
}

#[test]
fn what_a_file_asks_of_its_readers_is_granted_or_named() {
    #[track_caller]
    fn check(features: &[&str], expected: Result<(), &str>) {
        match (read_bytes(&header(features)), expected) {
            (Ok(extract), Ok(())) => assert_eq!(extract.summary.ways_seen, 0),
            (Err(error), Err(words)) => assert!(error.to_string().contains(words), "{error}"),
            (found, _) => panic!("{features:?}: {found:?}"),
        }
    }
    check(&[], Ok(()));
    check(&["OsmSchema-V0.6", "DenseNodes"], Ok(()));
    check(&["OsmSchema-V0.6", "LocationsOnWays"], Ok(()));
    check(&["OsmSchema-V0.7"], Err("\"OsmSchema-V0.7\", which is not supported"));
    check(&["OsmSchema-V0.6", "HistoricalInformation"], Err("osmium time-filter IN.osh.pbf"));
    check(&["HistoricalInformation"], Err("osmium apply-changes IN.osm.pbf"));
    check(&["DenseNodes", ""], Err("\"\", which is not supported"));
    let error = read(&fixture("history.osh.pbf")).unwrap_err();
    assert!(matches!(error, ReadOsmError::History { .. }), "{error}");
}

#[test]
fn a_file_begins_with_its_header() {
    #[track_caller]
    fn check(blobs: &[&[u8]], expected: Result<(), &str>) {
        match (read_bytes(&blobs.concat()), expected) {
            (Ok(_), Ok(())) => {}
            (Err(error), Err(words)) => assert!(error.to_string().contains(words), "{error}"),
            (found, _) => panic!("{found:?}"),
        }
    }
    let block = BlockBuilder::new().bytes();
    let data = raw(b"OSMData", &block);
    let other = frame(b"_thumbnail", b"\xff\xff");
    check(&[&plain_header()], Ok(()));
    check(&[&plain_header(), &data], Ok(()));
    check(&[&packed_blob(b"OSMHeader", b""), &packed_blob(b"OSMData", &block)], Ok(()));
    // Blobs of unknown types are skipped without being read.
    check(&[&other, &plain_header(), &other, &data, &other], Ok(()));
    check(&[&data], Err("data comes before the file's header"));
    check(&[&data, &plain_header()], Err("data comes before the file's header"));
    check(&[&other], Err("the file has no header"));
    check(&[&frame(b"OSMHeader", b"")], Err("the blob contains no data"));
    let flood = [number(2, 2 << 20), field(3, &zlib(&vec![0; 2 << 20]))].concat();
    check(&[&frame(b"OSMHeader", &flood)], Err("2097152 bytes long; the limit is 1048575"));
}

#[test]
fn several_files_in_a_row_are_one_and_have_no_box() {
    let header = |west: i64| {
        let side = |number: u8, value: i64| {
            [vec![number << 3], corniche_testing::pbf::zigzag(value * 1_000_000_000)].concat()
        };
        let bbox = [side(1, west), side(2, 10), side(3, 48), side(4, 47)].concat();
        raw(b"OSMHeader", &[field(1, &bbox), field(16, b"test")].concat())
    };
    let one = read_bytes(&header(9)).unwrap().summary;
    assert_eq!(
        (one.header_bounds_deg, one.generator.as_deref()),
        (Some([9.0, 47.0, 10.0, 48.0]), Some("test"))
    );
    let mut blocks = [BlockBuilder::with_row_of_nodes(2), BlockBuilder::new()];
    blocks[0].track(1, &[1, 2]);
    blocks[1].track(2, &[2, 1]);
    let [a, b] = blocks.map(|block| raw(b"OSMData", &block.bytes()));
    let extract = read_bytes(&[header(9), a, header(8), b].concat()).unwrap();
    assert_eq!((extract.roads.len(), extract.summary.nodes_missing), (2, 0));
    assert_eq!((extract.summary.header_bounds_deg, extract.summary.generator), (None, None));
    let nowhere = read_bytes(&header(-181)).unwrap().summary;
    assert_eq!(nowhere.header_bounds_deg, None);
}
