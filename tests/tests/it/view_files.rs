//! The files that `corniche view` writes: they overwrite no other file, and none is lost.
#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{
    Display, Ran, binary, copy_pass, ended, lacks_adapter, send_signal, text, without_display,
};

/// A folder with a package.
fn package() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    (folder, package)
}

/// Runs `corniche view` without a display. An error must come before the attempt to open a window.
fn refused(package: &Path, options: &[&str]) -> Ran {
    let mut command = Command::new(binary());
    without_display(command.arg("view").arg(package).args(options))
        .output()
        .expect("the binary starts")
        .into()
}

#[test]
fn a_trace_replaces_neither_the_package_nor_the_style_nor_another_file() {
    let (folder, package) = package();
    let style = folder.path().join("mine.toml");
    fs::copy(e2e::root().join("config/styles/dark.toml"), &style).unwrap();
    let precious = folder.path().join("precious.csv");
    fs::write(&precious, b"precious").unwrap();
    let before = [&package, &style, &precious].map(|path| fs::read(path).unwrap());

    let same_package = folder.path().join(".").join("pass.pmtiles");
    for (options, code) in [
        (["--trace", text(&same_package), "--style", "dark"], 2),
        (["--trace", text(&style), "--style", text(&style)], 2),
        (["--trace", text(&precious), "--style", "dark"], 3),
    ] {
        let ran = refused(&package, &options);
        assert_eq!(ran.code, code, "{options:?}: {}", ran.err);
        assert!(ran.err.contains(options[1]), "{}", ran.err);
    }
    let after = [&package, &style, &precious].map(|path| fs::read(path).unwrap());
    assert!(before == after);

    let new = folder.path().join("new.csv");
    assert_eq!(refused(&package, &["--trace", text(&new)]).code, 1, "no display");
    assert!(!new.exists(), "without a window there is nothing to tell of");
}

#[test]
fn what_is_to_hold_pictures_must_not_be_a_file() {
    let (folder, package) = package();
    let file = folder.path().join("pictures");
    fs::write(&file, b"precious").unwrap();
    let ran = refused(&package, &["--folder", text(&file)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--folder"), "{}", ran.err);
    assert_eq!(fs::read(&file).unwrap(), b"precious");
}

#[test]
fn a_package_that_does_not_fit_the_memory_allowed_opens_no_window() {
    let (_folder, package) = package();
    let ran = refused(&package, &["--gpu-memory", "1K"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--gpu-memory"), "{}", ran.err);
}

/// A window that records its flight, and its number; `None` without a GPU adapter.
fn recording(
    display: &Display,
    package: &Path,
    pictures: &Path,
    trace: &Path,
) -> Option<(Child, String)> {
    let mut command = Command::new(binary());
    command.arg("view").arg(package).args(["--size", "320x240", "--folder"]);
    command.arg(pictures).arg("--trace").arg(trace);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    let mut window = display.lend(&mut command).spawn().expect("the binary starts");
    // The first frames are drawn.
    let begun = Instant::now();
    while fs::read_to_string(trace).map_or(0, |text| text.lines().count()) < 3 {
        if window.try_wait().expect("it is ours").is_some() {
            let ran = ended(&mut window);
            assert!(lacks_adapter(&ran), "{}", ran.err);
            return None;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "no first frames");
        thread::sleep(Duration::from_millis(50));
    }
    let id = display.window();
    display.xdotool(&format!("windowfocus {id}"));
    // The window gets the keyboard focus a little later.
    thread::sleep(Duration::from_secs(1));
    display.xdotool("key c");
    thread::sleep(Duration::from_secs(2));
    Some((window, id))
}

#[test]
fn a_recording_is_saved_however_the_window_ends() {
    let Some(display) = Display::start() else { return };
    let (folder, package) = package();
    // If the window is destroyed from outside, the program may fail before it gets the event.
    let ends: [(&str, &[i32]); 3] =
        [("key ctrl+q", &[0]), ("signal", &[4]), ("windowclose", &[0, 1])];
    for (number, (end, codes)) in (1..).zip(ends) {
        let trace = folder.path().join(format!("trace-{number}.csv"));
        let opened = recording(&display, &package, folder.path(), &trace);
        let Some((mut window, id)) = opened else { return };
        match end {
            "signal" => assert!(send_signal(&window, "TERM")),
            "windowclose" => {
                display.xdotool(&format!("windowclose {id}"));
            }
            key => {
                display.xdotool(key);
            }
        }
        let ran = ended(&mut window);
        assert!(codes.contains(&ran.code), "{end} gave {}: {}", ran.code, ran.err);
        let flight = format!("flight-{number:03}.toml");
        assert!(ran.err.contains(&flight), "{end}: {}", ran.err);
        let flight = fs::read_to_string(folder.path().join(flight)).unwrap();
        assert!(flight.matches("time_s").count() >= 2, "{end}: {flight}");
    }
}

#[test]
fn a_recording_that_cannot_be_saved_is_told_and_fails() {
    let Some(display) = Display::start() else { return };
    let (folder, package) = package();
    let pictures = folder.path().join("pictures");
    let opened = recording(&display, &package, &pictures, &folder.path().join("trace.csv"));
    let Some((mut window, _)) = opened else { return };
    // Meanwhile, a file takes the place of the folder for the recording.
    fs::write(&pictures, b"precious").unwrap();
    display.xdotool("key ctrl+q");
    let ran = ended(&mut window);
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("cannot save to"), "{}", ran.err);
    assert!(ran.err.contains(text(&pictures)), "{}", ran.err);
    assert_eq!(fs::read(&pictures).unwrap(), b"precious");
}
