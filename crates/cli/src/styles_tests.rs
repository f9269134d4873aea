//! A style is reloaded when its file changes, and an invalid one is reported once.

use std::{
    fs,
    time::{Duration, SystemTime},
};

use super::*;

#[test]
fn what_is_no_style_is_refused_by_its_name() {
    let message = style("no-such-style").unwrap_err().to_string();
    for word in ["no-such-style", "road-atlas, dark", "No such file"] {
        assert!(message.contains(word), "{word}: {message}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, "outline_px = high").unwrap();
    let message = style(path.to_str().unwrap()).unwrap_err().to_string();
    assert!(message.contains("mine.toml") && message.contains("line 1"), "{message}");
}

/// A check detects every change, including those that no time stamp shows.
#[test]
fn a_style_is_read_again_when_its_file_changes_and_only_then() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let write = |text: &str| {
        fs::write(&path, text).unwrap();
        let file = fs::File::options().write(true).open(&path).unwrap();
        file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(1000)).unwrap();
    };
    let [atlas, dark] = ["road-atlas", "dark"].map(|name| style_preset(name).unwrap());
    write(atlas);
    let mut file = StyleFile::find(path.to_str().unwrap()).unwrap();
    assert!(file.reload_if_changed().is_none());
    write(dark);
    assert_eq!(file.reload_if_changed().unwrap().unwrap(), style("dark").unwrap());
    assert!(file.reload_if_changed().is_none());
    let as_long = dark.replace("hillshade = 0.75", "hillshade = 0.25");
    assert!(as_long != dark && as_long.len() == dark.len());
    write(&as_long);
    assert!(file.reload_if_changed().unwrap().is_ok());
    assert!(StyleFile::find("dark").is_none());
}

#[test]
fn what_is_no_style_is_told_once_and_not_while_it_may_still_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let [atlas, dark] = ["road-atlas", "dark"].map(|name| style_preset(name).unwrap());
    fs::write(&path, atlas).unwrap();
    let mut file = StyleFile::find(path.to_str().unwrap()).unwrap();
    // First the file is truncated, then incomplete, then complete.
    for part in [0, dark.len() / 2] {
        fs::write(&path, &dark[..part]).unwrap();
        assert!(file.reload_if_changed().is_none(), "{part} bytes of it");
    }
    fs::write(&path, dark).unwrap();
    assert_eq!(file.reload_if_changed().unwrap().unwrap(), style("dark").unwrap());

    for broken in [&b"outline_px = high"[..], b"\xff\xfe"] {
        fs::write(&path, broken).unwrap();
        assert!(file.reload_if_changed().is_none(), "perhaps it is being written");
        let message = file.reload_if_changed().unwrap().unwrap_err().to_string();
        assert!(message.contains("mine.toml"), "{message}");
        assert!(file.reload_if_changed().is_none(), "an error is said once");
    }
    fs::remove_file(&path).unwrap();
    assert!(file.reload_if_changed().is_none());
    fs::write(&path, dark).unwrap();
    assert!(file.reload_if_changed().unwrap().is_ok(), "what was right before is right again");
}

#[test]
fn a_style_whose_file_is_gone_is_told_once_and_read_again_when_it_is_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let dark = style_preset("dark").unwrap();
    fs::write(&path, dark).unwrap();
    let mut file = StyleFile::find(path.to_str().unwrap()).unwrap();
    fs::remove_file(&path).unwrap();
    assert!(file.reload_if_changed().is_none(), "perhaps an editor is replacing it");
    fs::write(&path, dark).unwrap();
    assert!(file.reload_if_changed().is_none(), "an editor has replaced it by the same");
    fs::remove_file(&path).unwrap();
    assert!(file.reload_if_changed().is_none(), "the doubt begins anew");
    let message = file.reload_if_changed().unwrap().unwrap_err().to_string();
    assert!(message.contains("mine.toml") && message.contains("missing"), "{message}");
    assert!(file.reload_if_changed().is_none(), "it is told once");
    fs::write(&path, dark).unwrap();
    assert_eq!(file.reload_if_changed().unwrap().unwrap(), style("dark").unwrap());
}
