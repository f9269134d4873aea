//! "Disk full" is reported for a full disk, and for nothing else.

use super::*;

#[test]
fn an_error_of_another_kind_is_no_lack_of_room() {
    use io::ErrorKind::{
        FileTooLarge, InvalidInput, Other, PermissionDenied, QuotaExceeded, StorageFull,
    };
    for kind in [StorageFull, QuotaExceeded] {
        assert_eq!(LackOfRoom::from_io_error(&kind.into()), Some(LackOfRoom::Disk), "{kind}");
    }
    assert_eq!(LackOfRoom::from_io_error(&FileTooLarge.into()), Some(LackOfRoom::FileSize));
    for kind in [InvalidInput, Other, PermissionDenied] {
        assert_eq!(LackOfRoom::from_io_error(&kind.into()), None, "{kind}");
    }
    assert_eq!(LackOfRoom::advice(None), "");
    assert!(LackOfRoom::advice(Some(LackOfRoom::Disk)).contains("disk is full"));
    assert!(!LackOfRoom::FileSize.to_string().contains("full"));
}

/// A folder of tests has some free space, and tests run without a limit.
#[test]
fn a_file_with_room_around_it_lacks_none() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(LackOfRoom::at(&folder.path().join("roads.gpkg")), None);
}

/// Linux has a device that is always full.
#[cfg(target_os = "linux")]
#[test]
fn the_device_that_is_full_is_full() {
    let full = fs::write("/dev/full", [0]).unwrap_err();
    assert_eq!(LackOfRoom::from_io_error(&full), Some(LackOfRoom::Disk));
}
