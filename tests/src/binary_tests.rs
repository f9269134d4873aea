//! A program that is older than one of its sources is rejected.

use std::time::Duration;

use super::*;

#[test]
fn a_program_older_than_a_source_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    assert!(check_is_new(&at("program")).unwrap_err().ends_with("is missing"));
    for name in ["program", "a.rs", "b c.rs"] {
        fs::write(at(name), "").unwrap();
    }
    let said = check_is_new(&at("program")).unwrap_err();
    assert!(said.contains("program.d"), "{said}");
    let names = ["a.rs", "b c.rs"].map(|name| at(name).display().to_string().replace(' ', "\\ "));
    fs::write(at("program.d"), format!("program: {}\n", names.join(" "))).unwrap();
    let make_older = |name: &str, seconds| {
        let file = fs::File::options().write(true).open(at(name)).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(seconds)).unwrap();
    };
    make_older("program", 100);
    make_older("a.rs", 200);
    make_older("b c.rs", 50);
    assert!(check_is_new(&at("program")).unwrap_err().ends_with("b c.rs"));
    make_older("b c.rs", 150);
    assert_eq!(check_is_new(&at("program")), Ok(()));
    fs::remove_file(at("a.rs")).unwrap();
    assert!(check_is_new(&at("program")).unwrap_err().ends_with("a.rs"));
}
