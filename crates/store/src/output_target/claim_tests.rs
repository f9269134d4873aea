//! Leftovers of a killed program are recognised by their id, only one of two programs gets a claim,
//! and no foreign file is touched.

use super::*;

const ID: &str = "0123456789abcdef";

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Creates a folder with a target's name, and leftovers of a killed program next to it.
fn left(files: &[&str], folders: &[&str]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(".x.csv.unfinished"), format!("{MARK}{ID}\n")).unwrap();
    for name in files {
        fs::write(folder.path().join(name), "half of it").unwrap();
    }
    for name in folders {
        fs::create_dir(folder.path().join(name)).unwrap();
        fs::write(folder.path().join(name).join("a"), "half of it").unwrap();
    }
    let target = folder.path().join("x.csv");
    (folder, target)
}

#[test]
fn what_a_killed_program_left_is_taken_over_at_each_of_its_steps() {
    let (unfinished, replaced) =
        (format!(".x.csv.{ID}.unfinished"), format!(".x.csv.{ID}.replaced"));
    let (unfinished, replaced) = (unfinished.as_str(), replaced.as_str());
    let steps: [(&[&str], &[&str]); 5] = [
        (&[], &[]),
        (&[unfinished], &[]),
        (&[], &[unfinished]),
        (&[], &[unfinished, replaced]),
        (&[], &[replaced]),
    ];
    for (files, folders) in steps {
        let (folder, target) = left(files, folders);
        // A program that is rejected leaves everything unchanged.
        let before = names(folder.path());
        drop(Claim::take(&target).unwrap());
        if !files.is_empty() || !folders.is_empty() {
            assert_eq!(names(folder.path()), before, "{files:?} {folders:?}");
        }
        let claim = Claim::take(&target).unwrap();
        let made = claim.begin_folder().unwrap();
        assert_eq!(fs::read_dir(made.path()).unwrap().count(), 0);
        drop(made);
        assert_eq!(names(folder.path()), [""; 0], "{files:?} {folders:?}");
    }
    let (folder, target) = left(&[unfinished], &[]);
    let claim = Claim::take(&target).unwrap();
    let file = claim.begin_file(Existing::Keep).unwrap();
    assert_eq!(file.path().metadata().unwrap().len(), 0);
    file.place().unwrap();
    assert_eq!(names(folder.path()), ["x.csv"]);
}

#[test]
fn of_two_programs_one_is_refused_and_the_other_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("x.csv");
    let first = Claim::take(&target).unwrap();
    assert_eq!(Claim::take(&target).unwrap_err().kind(), io::ErrorKind::ResourceBusy);
    first.begin_file(Existing::Keep).unwrap().place().unwrap();
    // A finished file is no longer a leftover, and is not touched.
    fs::write(&target, "all of it").unwrap();
    drop(Claim::take(&target).unwrap().begin_file(Existing::Keep).unwrap());
    assert_eq!(names(folder.path()), ["x.csv"]);
    assert_eq!(fs::read(&target).unwrap(), b"all of it");
}

/// A kill, or a full disk, between creating the claim and the end of its line.
#[test]
fn a_claim_that_was_only_begun_proves_nothing_and_is_used() {
    let line = format!("{MARK}{ID}\n");
    for end in [0, 1, "corniche unf".len(), MARK.len(), MARK.len() + 10, line.len() - 1] {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("x.csv");
        let of_others = [".x.csv..replaced", ".x.csv..unfinished"];
        for name in of_others {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let there = folder.path().join(".x.csv.unfinished");
        fs::write(&there, &line[..end]).unwrap();
        let claim = Claim::take(&target).unwrap();
        assert_eq!(fs::read_to_string(&there).unwrap(), format!("{MARK}{}\n", claim.id));
        drop(claim.begin_file(Existing::Keep).unwrap());
        assert_eq!(names(folder.path()), of_others, "{end}");
    }
}

#[test]
fn what_others_have_put_there_is_refused_by_name_and_left() {
    let claim = format!("{MARK}{ID}\n");
    let texts = [
        "half of it",
        "corniche unfinished ../../victim\n",
        "corniche unfinished \n",
        "corniche unfinished 0123 and more",
        &format!("{claim}more"),
    ];
    for text in texts {
        let folder = tempfile::tempdir().unwrap();
        let there = folder.path().join(".x.csv.unfinished");
        fs::write(&there, text).unwrap();
        let error = Claim::take(&folder.path().join("x.csv")).unwrap_err();
        let told = error.to_string();
        assert!(told.contains(".x.csv.unfinished\" is in the way"), "{told}");
        assert_eq!(fs::read_to_string(&there).unwrap(), text);
    }
}
