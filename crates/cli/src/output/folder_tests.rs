//! An output folder appears when it is complete and is replaced as a whole, whenever the program is
//! killed.

use std::{fs, path::Path, thread, time::Duration};

use tempfile::TempDir;

use super::{FolderOutput, MARKER};
use crate::{exit::ExitCode, interrupt, output::Existing};

fn write(target: &Path, existing: Existing, text: &str) {
    let output = FolderOutput::create(target, existing, &[]).unwrap();
    fs::create_dir(output.path().join("0")).unwrap();
    fs::write(output.path().join("0/a"), text).unwrap();
    // The marker counts, too.
    assert!(output.place("a test").unwrap() > text.len() as u64);
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_folder_is_there_when_it_is_complete_and_replaced_as_a_whole() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("out");
    {
        let output = FolderOutput::create(&target, Existing::Keep, &[]).unwrap();
        fs::write(output.path().join("a"), "half").unwrap();
        assert!(!target.exists());
    }
    assert_eq!(names(folder.path()), [""; 0]);
    write(&target, Existing::Keep, "one");
    assert_eq!(names(folder.path()), ["out"]);
    assert_eq!(names(&target), ["0", MARKER]);
    fs::write(target.join("older"), "older").unwrap();
    let kept = FolderOutput::create(&target, Existing::Keep, &[]).unwrap_err();
    assert!(kept.to_string().contains("-O"), "{kept}");
    write(&target, Existing::Replace, "two");
    assert_eq!(fs::read(target.join("0/a")).unwrap(), b"two");
    assert_eq!(names(&target), ["0", MARKER]);
    assert_eq!(names(folder.path()), ["out"]);
}

#[test]
fn an_empty_folder_is_taken_and_any_other_is_left_alone() {
    let folder = TempDir::new().unwrap();
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    write(&empty, Existing::Keep, "one");
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("file"), "mine").unwrap();
    let missing = folder.path().join("no/out");
    let package = empty.join("p.pmtiles");
    fs::write(&package, "p").unwrap();
    for (target, used, word) in [
        (mine.as_path(), None, "other files"),
        (mine.join("file").as_path(), None, "it is a file"),
        (missing.as_path(), None, "its parent folder"),
        (empty.as_path(), Some(package.as_path()), "p.pmtiles\", which the command uses"),
    ] {
        let used: Vec<&Path> = used.into_iter().collect();
        let refused = FolderOutput::create(target, Existing::Replace, &used).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable);
        assert!(refused.to_string().contains(word), "{refused}");
    }
    assert_eq!(fs::read(mine.join("file")).unwrap(), b"mine");
    assert_eq!(fs::read(package).unwrap(), b"p");
}

/// Two processes at once would write into each other's folder.
#[test]
fn only_one_writes_at_a_time() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("out");
    let first = FolderOutput::create(&target, Existing::Keep, &[]).unwrap();
    let second = FolderOutput::create(&target, Existing::Keep, &[]).unwrap_err();
    assert!(second.to_string().contains("another program"), "{second}");
    drop(first);
    write(&target, Existing::Keep, "one");
}

const ID: &str = "0123456789abcdef";

/// Leftovers of a program that was killed while it wrote a folder: its claim, and some of the
/// claimed files.
fn left(folder: &Path, ends: &[&str]) {
    fs::write(folder.join(".out.unfinished"), format!("corniche unfinished {ID}\n")).unwrap();
    for end in ends {
        fs::create_dir(folder.join(format!(".out.{ID}.{end}"))).unwrap();
        fs::write(folder.join(format!(".out.{ID}.{end}/a")), "half").unwrap();
    }
}

/// A kill between any two steps of a replacement loses nothing, and the next run removes the
/// leftovers.
#[test]
fn what_a_kill_leaves_is_put_right() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("out");
    write(&target, Existing::Keep, "one");
    // Before the first rename.
    left(folder.path(), &["unfinished"]);
    let kept = FolderOutput::create(&target, Existing::Keep, &[]).unwrap_err();
    assert!(kept.to_string().contains("already exists"), "{kept}");
    assert!(folder.path().join(format!(".out.{ID}.unfinished/a")).exists(), "it was removed");
    // Between the two renames.
    fs::rename(&target, folder.path().join(format!(".out.{ID}.replaced"))).unwrap();
    let kept = FolderOutput::create(&target, Existing::Keep, &[]).unwrap_err();
    assert!(kept.to_string().contains("already exists"), "{kept}");
    assert_eq!(fs::read(target.join("0/a")).unwrap(), b"one");
    write(&target, Existing::Replace, "two");
    assert_eq!(names(folder.path()), ["out"]);
    // After the second rename, only the old folder is a leftover.
    left(folder.path(), &["replaced"]);
    write(&target, Existing::Replace, "three");
    assert_eq!(names(folder.path()), ["out"]);
    assert_eq!(fs::read(target.join("0/a")).unwrap(), b"three");
}

/// The program removes temporary files half a second after a signal, while the run may be about to
/// replace an export.
#[test]
fn an_early_end_removes_nothing_of_a_folder_that_takes_its_place() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("out");
    write(&target, Existing::Keep, "one");
    let output = FolderOutput::create(&target, Existing::Replace, &[]).unwrap();
    let claim = folder.path().canonicalize().unwrap().join(".out.unfinished");
    let made = output.path().to_path_buf();
    fs::write(made.join("a"), "two").unwrap();
    let at_end = interrupt::temporary();
    assert!(at_end.contains(&claim) && at_end.contains(&made), "{at_end:?}");
    // The removal has begun: the run waits.
    let placing = thread::spawn(move || output.place("a test"));
    thread::sleep(Duration::from_millis(200));
    assert!(!placing.is_finished(), "it was placed while it was removed");
    assert_eq!(fs::read(target.join("0/a")).unwrap(), b"one");
    assert!(claim.exists());
    // The removal has not begun, so it would not find the files any more.
    drop(at_end);
    placing.join().unwrap().unwrap();
    let at_end = interrupt::temporary();
    assert!(!at_end.contains(&claim) && !at_end.contains(&made), "{at_end:?}");
    assert_eq!(fs::read(target.join("a")).unwrap(), b"two");
    assert_eq!(names(folder.path()), ["out"]);
}

/// Folders are not recognized as ours by their names, nor by a marker that is empty or a link.
#[test]
fn folders_of_others_beside_a_target_stay() {
    let folder = TempDir::new().unwrap();
    let target = folder.path().join("out");
    let others = [".out.unfinished.files", ".out.replaced", ".out.0123456789abcdef.replaced"];
    for name in others {
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join(MARKER), "").unwrap();
        fs::write(folder.path().join(name).join("thesis"), "mine").unwrap();
    }
    write(&target, Existing::Keep, "one");
    write(&target, Existing::Replace, "two");
    for name in others {
        assert_eq!(fs::read(folder.path().join(name).join("thesis")).unwrap(), b"mine");
    }
    let marker = fs::read(target.join(MARKER)).unwrap();
    fs::write(folder.path().join("marker"), marker).unwrap();
    let mine = folder.path().join("mine");
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("thesis"), "mine").unwrap();
    let check = |what: &str| {
        let refused = FolderOutput::create(&mine, Existing::Replace, &[]).unwrap_err();
        assert!(refused.to_string().contains("other files"), "{what}: {refused}");
        assert_eq!(fs::read(mine.join("thesis")).unwrap(), b"mine", "{what}");
    };
    fs::write(mine.join(MARKER), "").unwrap();
    check("an empty marker");
    #[cfg(unix)]
    {
        fs::remove_file(mine.join(MARKER)).unwrap();
        std::os::unix::fs::symlink("../marker", mine.join(MARKER)).unwrap();
        check("a linked marker");
    }
}
