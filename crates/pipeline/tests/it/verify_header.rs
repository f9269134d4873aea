//! Changes every byte of a package's header after the offsets of its parts, and every text next to
//! its manifest, in turn: which check detects the change.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use corniche_testing::some_of;
use std::{fs, io::Read as _, ops::Range, path::Path};

use crate::support::parts::{Against, SOUND, assert_broken, report_on, verify_against};
use corniche_testing::pmtiles::gzip;
use corniche_verify::{CheckId, VerifyError};
use flate2::read::GzDecoder;
use serde_json::{Value, json};

/// Offset and length of the metadata in the header.
const METADATA: Range<usize> = 24..40;
/// Counts of entries and contents, and the clustered flag.
const COUNTS: Range<usize> = 80..97;
/// The bytes from the levels to the end of the header.
const FOR_TOOLS: Range<usize> = 100..127;

fn in_a_file<T>(bytes: &[u8], look: impl FnOnce(&Path) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.pmtiles");
    fs::write(&path, bytes).unwrap();
    look(&path)
}

/// The bytes before these are the offsets of the parts, which checksums protect; readers reject
/// wrong counts of tiles, compressions and types.
#[test]
fn every_byte_of_the_header_behind_the_places_is_seen() {
    for at in some_of(72..FOR_TOOLS.end, [7, 3, 1]) {
        let mut bytes = SOUND.bytes.clone();
        bytes[at] ^= 1;
        in_a_file(&bytes, |path| {
            if COUNTS.contains(&at) || FOR_TOOLS.contains(&at) {
                assert_broken(report_on(path, Against::Itself), &[CheckId::Header]);
            } else {
                let found = verify_against(path, Against::Itself);
                assert!(matches!(found, Err(VerifyError::Open(_))), "byte {at}: {found:?}");
            }
        });
    }
}

/// The valid package with other metadata, appended after its last byte.
fn with_metadata(change: impl FnOnce(&mut Value)) -> Vec<u8> {
    let mut bytes = SOUND.bytes.clone();
    let number =
        |at: usize| usize::try_from(u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()));
    let (from, length) = (number(METADATA.start).unwrap(), number(METADATA.start + 8).unwrap());
    let mut text = String::new();
    GzDecoder::new(&bytes[from..from + length]).read_to_string(&mut text).unwrap();
    let mut metadata = serde_json::from_str(&text).unwrap();
    change(&mut metadata);
    let packed = gzip(metadata.to_string().as_bytes());
    let span = [bytes.len() as u64, packed.len() as u64];
    bytes[METADATA].copy_from_slice(&span.map(u64::to_le_bytes).concat());
    bytes.extend(packed);
    bytes
}

#[test]
fn every_text_beside_the_manifest_is_seen() {
    let mut names = Vec::new();
    let same = with_metadata(|metadata| {
        names = metadata.as_object().unwrap().keys().cloned().collect();
    });
    in_a_file(&same, |path| assert_broken(report_on(path, Against::Itself), &[]));
    names.retain(|name| name != "corniche");
    assert_eq!(names.len(), 3, "{names:?}");
    for name in names {
        let bytes = with_metadata(|metadata| metadata[&name] = json!("something else"));
        in_a_file(&bytes, |path| {
            assert_broken(report_on(path, Against::Itself), &[CheckId::Header]);
        });
    }
}
