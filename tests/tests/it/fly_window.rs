//! Flights and windows, on a virtual display (Xvfb): flights that a window shows while they are
//! drawn, and a flight that a window has recorded.
#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{
    Display, Ran, binary, copy_pass, draw, lacks_adapter, text, without_display, without_times,
};

/// A package, and a folder for the output.
struct FlightFolder {
    folder: tempfile::TempDir,
    package: PathBuf,
    out: PathBuf,
}

impl FlightFolder {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let package = folder.path().join("pass.pmtiles");
        copy_pass(&package, &["--quiet"]);
        let out = folder.path().join("out");
        fs::create_dir(&out).expect("a folder in it");
        Self { folder, package, out }
    }

    /// Runs `fly` in a window, with a table, a chart and images.
    fn fly(&self, options: &[&str]) -> Command {
        let mut command = Command::new(binary());
        command.arg("fly").arg(&self.package).args(["--window", "--size", "160x120"]);
        command.arg("-o").arg(self.out.join("fly.csv"));
        command.arg("--svg").arg(self.out.join("fly.svg"));
        command.arg("--png").arg(self.out.join("frames"));
        command.args(options).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn leavings(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.out).expect("the folder is there");
        let names = entries.map(|entry| entry.expect("it can be listed").file_name());
        names.map(|name| name.to_string_lossy().into_owned()).collect()
    }
}

/// Waits for the flight's window; `None` if the flight ended before because there is no adapter.
fn window_of(display: &Display, flight: &mut Child) -> Option<String> {
    let begun = Instant::now();
    loop {
        if let Some(id) = display.try_xdotool("search --onlyvisible --name Corniche") {
            return id.lines().last().map(str::to_owned);
        }
        if flight.try_wait().expect("it is ours").is_some() {
            return None;
        }
        assert!(begun.elapsed() < Duration::from_mins(1), "no window");
        thread::sleep(Duration::from_millis(20));
    }
}

/// The result of a flight of this many frames if its window is disturbed after some of them; `None`
/// without an adapter.
fn disturbed(
    place: &FlightFolder,
    display: &Display,
    frames: &str,
    disturb: &[&str],
) -> Option<Ran> {
    let mut flight =
        display.lend(&mut place.fly(&["--frames", frames])).spawn().expect("it starts");
    if let Some(id) = window_of(display, &mut flight) {
        // Not directly after the start.
        thread::sleep(Duration::from_millis(500));
        for command in disturb {
            display.xdotool(&command.replace("ID", &id));
        }
    }
    let ran = Ran::from(flight.wait_with_output().expect("it is ours"));
    (!lacks_adapter(&ran)).then_some(ran)
}

#[test]
fn what_is_shown_is_listed_as_if_it_were_not() {
    let Some(display) = Display::start() else { return };
    let place = FlightFolder::new();
    let ran = Ran::from(display.lend(&mut place.fly(&["--frames", "12"])).output().unwrap());
    if lacks_adapter(&ran) {
        return;
    }
    assert_eq!(ran.code, 0, "{}", ran.err);
    let alone = place.folder.path().join("alone.csv");
    let ran =
        draw("fly", &place.package, &alone, &["--frames", "12", "--size", "160x120"]).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(without_times(&place.out.join("fly.csv")), without_times(&alone));
    assert_eq!(fs::read_dir(place.out.join("frames")).unwrap().count(), 12);
    assert_eq!(place.leavings().len(), 3);
}

#[test]
fn closing_the_window_ends_the_flight_and_leaves_nothing() {
    let Some(display) = Display::start() else { return };
    let place = FlightFolder::new();
    // Without a window manager there is no button to close the window; the key does the same.
    let close = ["windowfocus ID", "sleep 1", "key ctrl+q"];
    let Some(ran) = disturbed(&place, &display, "5000", &close) else { return };
    assert_eq!(ran.code, 4, "{}", ran.err);
    assert!(ran.err.contains("closed before the flight ended"), "{}", ran.err);
    assert_eq!(place.leavings(), [""; 0]);
}

/// If the window is destroyed from outside, for example by a crash of the display's driver, no
/// results are lost.
#[test]
fn a_window_that_is_lost_is_no_loss() {
    let Some(display) = Display::start() else { return };
    let place = FlightFolder::new();
    let Some(ran) = disturbed(&place, &display, "80", &["windowclose ID"]) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("continues without it"), "{}", ran.err);
    assert_eq!(without_times(&place.out.join("fly.csv")).len(), 81);
    assert_eq!(fs::read_dir(place.out.join("frames")).unwrap().count(), 80);
}

#[test]
fn without_a_display_there_is_no_flight() {
    let place = FlightFolder::new();
    let begun = Instant::now();
    let ran = Ran::from(without_display(&mut place.fly(&["--frames", "5000"])).output().unwrap());
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("no display"), "{}", ran.err);
    assert!(begun.elapsed() < Duration::from_secs(30), "{:?}", begun.elapsed());
    assert_eq!(place.leavings(), [""; 0]);
    // Nor anywhere else.
    assert_eq!(fs::read_dir(place.folder.path()).unwrap().count(), 2, "{}", text(&place.out));
}

/// Whether the camera did not move for a second and no tile was missing or loading, by the trace of
/// a window. (While a window records, it draws all the time.)
fn is_at_rest(trace: &Path) -> bool {
    let last = || {
        let list = fs::read_to_string(trace).unwrap_or_default();
        let names: Vec<String> = list.lines().next()?.split(',').map(str::to_owned).collect();
        let cells = list.lines().next_back()?.split(',').map(str::to_owned);
        let line = names.into_iter().zip(cells).filter(|(name, _)| name != "frame");
        let line: Vec<(String, String)> = line.collect();
        let is_zero = |name: &str| line.iter().any(|(known, cell)| known == name && cell == "0");
        ["missing", "loading", "moving"].into_iter().all(is_zero).then_some(line)
    };
    let before = last();
    thread::sleep(Duration::from_secs(1));
    before.is_some() && before == last()
}

/// Zooming in from afar to the ground at the cursor changes haze and near plane; the flight
/// reproduces this.
#[test]
fn a_recorded_flight_ends_with_the_picture_that_the_window_showed() {
    let Some(display) = Display::start() else { return };
    let place = FlightFolder::new();
    let drawing = ["--size", "320x240", "--supersampling", "1", "--roads", "sv"];
    let trace = place.folder.path().join("trace.csv");
    let mut command = Command::new(binary());
    command.arg("view").arg(&place.package).args(drawing).args(["--motion", "prompt"]);
    command.arg("--folder").arg(&place.out).arg("--trace").arg(&trace);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    let mut window = display.lend(&mut command).spawn().unwrap();
    let Some(id) = window_of(&display, &mut window) else {
        let ran = Ran::from(window.wait_with_output().unwrap());
        assert!(lacks_adapter(&ran), "{}", ran.err);
        return;
    };
    let settle = || {
        let begun = Instant::now();
        while !is_at_rest(&trace) {
            let last = || fs::read_to_string(&trace).unwrap_or_default();
            let is_late = begun.elapsed() > Duration::from_mins(2);
            assert!(!is_late, "it does not come to rest: {:?}", last().lines().next_back());
        }
    };
    let begins = |name: &str| {
        let (path, begun) = (place.out.join(name), Instant::now());
        while !path.exists() {
            assert!(begun.elapsed() < Duration::from_mins(2), "no {}", path.display());
            thread::sleep(Duration::from_millis(50));
        }
        path
    };
    display.xdotool(&format!("windowfocus {id}"));
    settle();
    display.xdotool("key c");
    display.xdotool("mousemove 100 120");
    for _ in 0..9 {
        display.xdotool("click 4");
        thread::sleep(Duration::from_millis(60));
    }
    settle();
    display.xdotool("key c");
    let flight = begins("flight-001.toml");
    display.xdotool("key p");
    let shown = begins("corniche-001.png");
    // Files that are being written are completed before the window closes.
    display.xdotool("key ctrl+q");
    assert_eq!(Ran::from(window.wait_with_output().unwrap()).code, 0);
    let shown = image::open(shown).unwrap().to_rgb8();

    let (csv, png) = (place.folder.path().join("fly.csv"), place.folder.path().join("frames"));
    // Slowly enough that no tile is missing in the last frame.
    let options = ["--frames", "40", "--path", text(&flight), "--png", text(&png)];
    let ran = draw("fly", &place.package, &csv, &[&drawing[..], &options[..]].concat()).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    let flown = image::open(png.join("lod-sv-00039.png")).unwrap().to_rgb8();
    assert_eq!(flown.dimensions(), shown.dimensions());
    // The window knows the ground beneath the camera from coarser tiles, so the haze differs very
    // slightly.
    let differs = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
    };
    let different = flown.pixels().zip(shown.pixels()).filter(|pair| differs(*pair)).count();
    assert!(different < 320 * 240 / 200, "{different} pixels differ");
}
