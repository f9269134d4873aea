//! Names that are too long for the file system are rejected before anything is created.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]
#![cfg(unix)]

use corniche_store::{Claim, TargetError, file_target};

/// Names of files have at most 255 bytes on every usual file system; files are written next to
/// their target under a longer name.
#[test]
fn a_name_is_too_long_with_what_is_added_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let named = |bytes: usize| folder.path().join("n".repeat(bytes));
    let is_long = |bytes: usize| match file_target(&named(bytes)) {
        Ok(_) => false,
        Err(TargetError::LongName { .. }) => true,
        Err(other) => panic!("{bytes}: {other}"),
    };
    let longest = (1..300).find(|&bytes| is_long(bytes)).unwrap() - 1;
    assert!((200..255).contains(&longest), "{longest}");
    assert!((longest + 1..5000).step_by(97).all(is_long));
    // The longest accepted name can be written.
    let claim = Claim::take(&named(longest)).unwrap();
    drop(claim.begin_file(corniche_store::Existing::Keep).unwrap());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let said = file_target(&named(longest + 1)).unwrap_err().to_string();
    assert!(said.contains("too long for this file system"), "{said}");
}
