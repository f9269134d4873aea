//! Hostile directories are rejected.

use corniche_testing::pmtiles::gzip;

use super::*;

#[test]
fn hostile_directories_are_refused() {
    assert!(Directory::parse(&gzip(&[0])).is_some_and(|directory| directory.entries.is_empty()));
    assert!(Directory::parse(&gzip(&[1, 5, 1, 29, 1])).is_some());
    assert!(Directory::parse(&gzip(&[2, 5, 1, 1, 1, 29, 29, 1, 30])).is_some());
    for bytes in [
        &[][..],
        // A count of 2^63 entries, with one entry.
        &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f, 0, 1, 1, 1],
        // A length below a payload's; the first offset "after the one before"; a byte too many; the
        // same tile twice; a run of two tiles; two tiles that share a byte; an empty leaf.
        &[1, 5, 1, 19, 1],
        &[1, 5, 1, 29, 0],
        &[1, 5, 1, 29, 1, 0],
        &[2, 5, 0, 1, 1, 29, 29, 1, 0],
        &[1, 5, 2, 29, 1],
        &[2, 5, 1, 1, 1, 29, 29, 1, 29],
        &[1, 5, 0, 0, 1],
    ] {
        assert_eq!(Directory::parse(&gzip(bytes)), None, "{bytes:?}");
    }
    assert_eq!(Directory::parse(b"no gzip"), None);
}
