//! Only the owner can read the temporary store.

use std::os::unix::fs::PermissionsExt as _;

use super::*;

#[test]
fn the_folder_is_its_owners_alone() {
    let mode = private_folder().unwrap().path().metadata().unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o700);
}
