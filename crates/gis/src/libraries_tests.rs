//! A released program is recognised by its own tables of PROJ, which have precedence over those of
//! another PROJ.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use super::*;

#[test]
fn a_released_program_is_one_with_its_own_tables_of_proj() {
    let place = tempfile::tempdir().unwrap();
    let program = place.path().join("bin/corniche");
    fs::create_dir_all(program.parent().unwrap()).unwrap();
    assert_eq!(libraries_beside(&program), None);
    // Another package may keep its own files there.
    fs::create_dir_all(place.path().join("lib/corniche")).unwrap();
    assert_eq!(libraries_beside(&program), None);
    fs::create_dir_all(place.path().join("lib/corniche/share/proj")).unwrap();
    let folder = libraries_beside(&program).unwrap();
    assert_eq!(
        folder.canonicalize().unwrap(),
        place.path().join("lib/corniche").canonicalize().unwrap()
    );
}

#[test]
fn the_own_tables_of_proj_come_first_and_folders_of_the_user_after_them() {
    let search = |of_user: Option<&str>, named: Option<&str>| {
        proj_search(Path::new("/l"), of_user.map(PathBuf::from), named.map(OsString::from))
    };
    let own = PathBuf::from("/l/share/proj");
    assert_eq!(search(None, None), vec![own.clone()]);
    assert_eq!(search(Some("/h"), Some("")), [own.clone(), "/h".into()]);
    let named = env::join_paths(["/usr/share/proj", "", "/grids"]).unwrap();
    assert_eq!(
        search(Some("/h"), named.to_str()),
        [own, "/h".into(), "/usr/share/proj".into(), "/grids".into()]
    );
}
