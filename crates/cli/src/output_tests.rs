//! Output files appear when they are complete, and no existing file is lost by mistake.

use std::fs;

use super::*;

#[test]
fn nothing_stands_at_the_target_before_the_file_is_complete() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("list.csv");
    let mut output = Output::create(&target, Existing::Keep, &[]).unwrap();
    output.write_all(b"half").unwrap();
    assert!(!target.exists());
    drop(output);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "litter");
    Output::create(&target, Existing::Keep, &[]).unwrap().write_whole(b"whole").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"whole");
}

#[test]
fn what_is_there_is_kept_unless_said_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("list.csv");
    let late = Output::create(&target, Existing::Keep, &[]).unwrap();
    fs::write(&target, b"precious").unwrap();
    let kept = [late.write_whole(b"new"), Output::create(&target, Existing::Keep, &[]).map(drop)];
    for refused in kept {
        assert_eq!(refused.unwrap_err().code(), ExitCode::Exists);
    }
    assert_eq!(fs::read(&target).unwrap(), b"precious");
    Output::create(&target, Existing::Replace, &[]).unwrap().write_whole(b"new").unwrap();
    assert_eq!(fs::read(&target).unwrap(), b"new");
}

#[test]
fn names_that_mean_no_file_are_refused_with_a_way_out() {
    for (name, word) in
        [("-", "./-"), ("s3://bucket/a.svg", "corniche merge"), ("http://a/b", "URL")]
    {
        let refused = Output::create(Path::new(name), Existing::Replace, &[]).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable, "{name}");
        let said = refused.to_string();
        assert!(said.contains(word) && said.contains(name), "{name}: {said}");
    }
}

#[test]
fn pictures_and_charts_are_called_so() {
    use names::{CHART, Format, PICTURE};

    let known = |format: Format, name: &str| format.refuse_others(Path::new(name));
    for (format, name) in
        [(PICTURE, "a.png"), (PICTURE, "a.PNG"), (CHART, "a.svg"), (CHART, "old.png.SVG")]
    {
        assert!(known(format, name).is_ok(), "{name}");
    }
    for (format, name, ending) in [
        (PICTURE, "a.jpg", ".png"),
        (PICTURE, "a.svg", ".png"),
        (CHART, "a.png", ".svg"),
        (CHART, "a", ".svg"),
    ] {
        let refused = known(format, name).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable, "{name}");
        let said = refused.to_string();
        assert!(said.contains(&format!("cannot write {name:?}: ")), "{said}");
        assert!(said.ends_with(&format!("a name with the extension {ending}")), "{said}");
    }
}

#[test]
fn a_package_is_called_so() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.pmtiles", "b.PMTiles", "c.old.pmtiles"] {
        assert!(writable_package(&folder.path().join(name)).is_ok(), "{name}");
    }
    for (name, whole) in [
        ("a", "a.pmtiles"),
        ("a.mbtiles", "a.pmtiles"),
        ("pmtiles", "pmtiles.pmtiles"),
        ("a.pmtiles.bak", "a.pmtiles.bak.pmtiles"),
        (".pmtiles", ".pmtiles.pmtiles"),
    ] {
        let refused = writable_package(&folder.path().join(name)).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable, "{name}");
        let said = refused.to_string();
        assert!(said.ends_with(&format!("/{whole}\"")), "{name}: {said}");
    }
}

#[test]
fn files_that_belong_together_are_all_written_before_one_takes_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let targets = ["a.csv", "b.svg"].map(|name| folder.path().join(name));
    let complete = targets
        .each_ref()
        .map(|target| Output::create(target, Existing::Keep, &[]).unwrap().fill(b"whole").unwrap());
    assert!(targets.iter().all(|target| !target.exists()));
    for file in complete {
        file.place().unwrap();
    }
    assert!(targets.iter().all(|target| fs::read(target).unwrap() == b"whole"));
}

#[test]
fn a_place_where_no_file_can_be_is_wrong_usage() {
    let folder = tempfile::tempdir().unwrap();
    for place in [folder.path().to_path_buf(), folder.path().join("missing/list.csv")] {
        let refused = Output::create(&place, Existing::Replace, &[]).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable);
        assert!(refused.to_string().contains(&place.display().to_string()));
    }
}

#[test]
fn a_command_does_not_replace_what_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("a.pmtiles");
    fs::write(&package, b"precious").unwrap();
    let other_name = folder.path().join(".").join("a.pmtiles");
    let refused = Output::create(&other_name, Existing::Replace, &[&package]).unwrap_err();
    assert_eq!(refused.code(), ExitCode::Unusable);
    assert_eq!(fs::read(&package).unwrap(), b"precious");
}

#[test]
fn what_a_command_will_write_is_the_same_file_by_any_path() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("new.pmtiles");
    fs::create_dir(folder.path().join("sub")).unwrap();
    for way in [".", "sub/.."] {
        let list = folder.path().join(way).join("new.pmtiles");
        let refused = Output::create(&list, Existing::Replace, &[&package]).unwrap_err();
        assert_eq!(refused.code(), ExitCode::Unusable, "{way}");
    }
    let other = folder.path().join("other.csv");
    assert!(Output::create(&other, Existing::Replace, &[&package]).is_ok());
}
