//! The images of a flight appear together or not at all.

use super::*;
use crate::exit::ExitCode;

#[test]
fn pictures_take_their_place_together_or_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("frames");
    let pictures = Pictures::create(&target, &[]).unwrap();
    fs::write(pictures.folder.path().join("a.png"), b"a").unwrap();
    assert!(!target.exists());
    drop(pictures);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "litter");
    let pictures = Pictures::create(&target, &[]).unwrap();
    fs::write(pictures.folder.path().join("a.png"), b"a").unwrap();
    pictures.finish().unwrap();
    assert_eq!(fs::read(target.join("a.png")).unwrap(), b"a");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "litter");
    let refused = Pictures::create(&target, &[]).err().unwrap();
    assert_eq!(refused.code(), ExitCode::Exists);
    let list = folder.path().join("list.csv");
    assert_eq!(Pictures::create(&list, &[&list]).err().unwrap().code(), ExitCode::Unusable);
}
