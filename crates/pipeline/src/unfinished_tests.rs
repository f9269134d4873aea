//! What a killed program left is taken over, and of two programs one is refused.

use super::*;

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn what_a_killed_program_left_is_taken_over() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("list.csv");
    fs::write(folder.path().join(".list.csv.unfinished"), "half of it").unwrap();
    let file = unfinished_file(&target).unwrap();
    assert_eq!(names(folder.path()), [".list.csv.unfinished"]);
    assert_eq!(file.as_file().metadata().unwrap().len(), 0);
    file.persist(&target).unwrap();
    assert_eq!(names(folder.path()), ["list.csv"]);
}

#[test]
fn of_two_programs_one_is_refused_and_the_other_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("list.csv");
    let first = unfinished_file(&target).unwrap();
    assert_eq!(unfinished_file(&target).unwrap_err().kind(), io::ErrorKind::ResourceBusy);
    first.persist(&target).unwrap();
    // A finished one is nobody's any more, and is not touched.
    fs::write(&target, "all of it").unwrap();
    drop(unfinished_file(&target).unwrap());
    assert_eq!(names(folder.path()), ["list.csv"]);
    assert_eq!(fs::read(&target).unwrap(), b"all of it");
}

#[cfg(unix)]
#[test]
fn a_link_of_that_name_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let precious = folder.path().join("precious");
    fs::write(&precious, "mine").unwrap();
    std::os::unix::fs::symlink(&precious, folder.path().join(".list.csv.unfinished")).unwrap();
    let error = unfinished_file(&folder.path().join("list.csv")).unwrap_err();
    assert!(error.to_string().contains("in the way"), "{error}");
    assert_eq!(fs::read(&precious).unwrap(), b"mine");
}
