//! The window through the whole binary, on a virtual display (Xvfb), controlled by xdotool.
#![cfg(target_os = "linux")]

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{
    Display, Ran, binary, copy_pass, ended, lacks_adapter, send_signal,
    web_servers::{WebServer, direct},
    without_display,
};

/// A line of the trace that `--trace` writes, by the names of its columns.
#[derive(Debug, Clone)]
struct Line(Vec<(String, String)>);

impl Line {
    fn number(&self, name: &str) -> Option<f64> {
        self.0.iter().find(|(known, _)| known == name).and_then(|(_, cell)| cell.parse().ok())
    }

    fn vector<const N: usize>(&self, names: [&str; N]) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = self.number(name)?;
        }
        Some(numbers)
    }

    /// Whether the camera does not move, and no tile is missing or loading.
    fn is_settled(&self) -> bool {
        self.vector(["missing", "loading", "moving"]) == Some([0.0; 3])
            && self.number("tiles").is_some_and(|tiles| tiles > 0.0)
    }
}

fn last_line(trace: &Path) -> Option<Line> {
    let text = fs::read_to_string(trace).ok()?;
    // A line that is not yet complete has no end of line.
    let mut lines = text.split_inclusive('\n').filter_map(|line| line.strip_suffix('\n'));
    let names: Vec<String> = lines.next()?.split(',').map(str::to_owned).collect();
    let cells = lines.next_back()?.split(',').map(str::to_owned);
    Some(Line(names.into_iter().zip(cells).collect()))
}

/// A display, a window on it, and the files that the window writes. Dropping it ends all of them.
struct Desk {
    display: Display,
    window: Child,
    trace: PathBuf,
    pictures: PathBuf,
    _folder: tempfile::TempDir,
}

impl Drop for Desk {
    fn drop(&mut self) {
        // The program may already have ended.
        let _ = self.window.kill();
        let _ = self.window.wait();
    }
}

impl Desk {
    /// Returns `None`, with the reason printed, without Xvfb, xdotool or a GPU adapter.
    fn open(options: &[&str]) -> Option<Self> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let package = folder.path().join("pass.pmtiles");
        copy_pass(&package, &["--quiet"]);
        Self::open_place(folder, package.as_os_str(), options)
    }

    /// Opens the package at a path or a URL.
    fn open_place(folder: tempfile::TempDir, package: &OsStr, options: &[&str]) -> Option<Self> {
        let display = Display::start()?;
        let (trace, pictures) = (folder.path().join("trace.csv"), folder.path().join("pictures"));

        let mut command = direct();
        command
            .arg("view")
            .arg(package)
            .args(["--size", "640x480", "--motion", "prompt"])
            .arg("--folder")
            .arg(&pictures)
            .arg("--trace")
            .arg(&trace)
            .args(options)
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let window = display.lend(&mut command).spawn().expect("the binary starts");
        let mut desk = Self { display, window, trace, pictures, _folder: folder };
        desk.wait("a first picture", Line::is_settled).map(|_| desk)
    }

    /// Waits until the last line of the trace is as expected and no other follows. `None` if the
    /// window ended because there is no adapter.
    fn wait(&mut self, what: &str, is_right: impl Fn(&Line) -> bool) -> Option<Line> {
        let begun = Instant::now();
        let mut last: Option<(u64, Instant)> = None;
        loop {
            if self.window.try_wait().expect("the window is ours").is_some() {
                let ran = ended(&mut self.window);
                assert!(lacks_adapter(&ran), "no {what}: {}", ran.err);
                return None;
            }
            let length = fs::metadata(&self.trace).map_or(0, |metadata| metadata.len());
            match last {
                Some((known, since)) if known == length => {
                    if let Some(line) = last_line(&self.trace).filter(&is_right)
                        && since.elapsed() > Duration::from_millis(700)
                    {
                        return Some(line);
                    }
                }
                _ => last = Some((length, Instant::now())),
            }
            let line = last_line(&self.trace);
            assert!(begun.elapsed() < Duration::from_mins(2), "no {what}: {line:?}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    fn xdotool(&self, command: &str) -> String {
        self.display.xdotool(command)
    }

    /// The window's number. This also gives it the keyboard focus, because no window manager does.
    fn focus(&self) -> String {
        let id = self.display.window();
        self.xdotool(&format!("windowfocus {id}"));
        id
    }

    /// Suspends the window's program, or resumes it.
    fn signal(&self, name: &str) {
        assert!(send_signal(&self.window, name));
    }

    fn point_at(&mut self, x: i32, y: i32) -> Line {
        self.xdotool(&format!("mousemove {x} {y}"));
        let is_there = |line: &Line| {
            let at = line.vector(["cursor_x_px", "cursor_y_px"]);
            at == Some([f64::from(x), f64::from(y)]) && line.is_settled()
        };
        self.wait(&format!("cursor at {x}, {y}"), is_there).expect("the window is open")
    }

    /// The image that is saved when a key is pressed.
    fn picture(&self, key: &str, number: u32) -> image::RgbaImage {
        self.xdotool(&format!("key {key}"));
        self.saved(number)
    }

    /// Waits for the image with this number.
    fn saved(&self, number: u32) -> image::RgbaImage {
        let path = self.pictures.join(format!("corniche-{number:03}.png"));
        let begun = Instant::now();
        // The file exists before it is complete.
        loop {
            if let Ok(picture) = image::open(&path) {
                return picture.to_rgba8();
            }
            assert!(begun.elapsed() < Duration::from_mins(1), "no {}", path.display());
            thread::sleep(Duration::from_millis(50));
        }
    }
}

/// Whether a part of an image (left, top, right, bottom) has dark letters on a light background.
fn has_letters(picture: &image::RgbaImage, [left, top, right, bottom]: [u32; 4]) -> bool {
    let (mut light, mut dark) = (0, 0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        if (left..right).contains(&x) && (top..bottom).contains(&y) {
            light += u32::from(pixel.0[..3].iter().all(|channel| *channel > 205));
            dark += u32::from(pixel.0[..3].iter().all(|channel| *channel < 90));
        }
    }
    light > 200 && dark > 40
}

fn colors(picture: &image::RgbaImage) -> usize {
    picture.pixels().map(|pixel| pixel.0).collect::<std::collections::BTreeSet<_>>().len()
}

#[test]
fn without_a_display_it_says_what_needs_none() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let mut command = Command::new(binary());
    command.arg("view").arg(&package);
    let ran = Ran::from(without_display(&mut command).output().unwrap());
    assert_eq!(ran.code, 1, "{}", ran.err);
    for words in ["no display", "corniche render", "corniche serve"] {
        assert!(ran.err.contains(words), "{}", ran.err);
    }
    assert!(!ran.err.contains("panicked"), "{}", ran.err);
}

#[test]
fn what_is_no_package_opens_no_window() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("none.pmtiles");
    fs::write(&file, b"PMTiles, or so it says").unwrap();
    let ran = e2e::corniche(["view".as_ref(), file.as_os_str()]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("none.pmtiles"), "{}", ran.err);
}

/// A package on a web server looks the same as the file.
#[test]
fn a_package_on_a_web_server_is_shown() {
    let map_of = |desk: &Desk| {
        // The keyboard events go to the window.
        desk.focus();
        desk.picture("p", 1)
    };
    let Some(desk) = Desk::open(&[]) else { return };
    let here = map_of(&desk);
    drop(desk);
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy_pass(&folder.path().join("pass.pmtiles"), &["--quiet"]);
    let Some(server) = WebServer::busybox(folder.path()) else { return };
    let url = server.url("pass.pmtiles");
    let Some(desk) = Desk::open_place(folder, url.as_ref(), &[]) else { return };
    assert!(colors(&here) > 100 && map_of(&desk) == here);
}

#[test]
fn the_ground_grabbed_stays_under_the_cursor() {
    let Some(mut desk) = Desk::open(&["--screen-space-error", "0.5"]) else { return };
    let ground = ["ground_x_m", "ground_y_m", "ground_height_m"];
    let press = desk.point_at(150, 200);
    let grabbed = press.vector(ground).expect("there is ground");
    desk.xdotool("mousedown 1");
    for step in 1..=6 {
        desk.xdotool(&format!("mousemove {} {}", 150 + 12 * step, 200 + 15 * step));
    }
    let dragged = desk.point_at(230, 300);
    desk.xdotool("mouseup 1");
    let released = desk.point_at(230, 300);
    for line in [dragged, released] {
        let here = line.vector(ground).expect("there is still ground");
        let pixel_m = line.number("pixel_m").expect("and it has a size");
        // On tilted ground a pixel covers more ground than this, so the true number of pixels is
        // smaller.
        let off_m = (0..3).map(|axis| (here[axis] - grabbed[axis]).powi(2)).sum::<f64>().sqrt();
        assert!(off_m / pixel_m <= 0.5, "{} px off: {press:?} {line:?}", off_m / pixel_m);
        let eye = ["eye_x_m", "eye_y_m"];
        let [from, to] = [&press, &line].map(|line| line.vector(eye).expect("an eye"));
        assert!((to[0] - from[0]).hypot(to[1] - from[1]) > 60.0 * pixel_m, "it was dragged");
    }
}

#[test]
fn pictures_show_the_map_and_its_credits_with_the_panel_and_without() {
    let Some(desk) = Desk::open(&[]) else { return };
    desk.focus();
    let map = desk.picture("p", 1);
    assert_eq!(map.dimensions(), (640, 480));
    assert!(colors(&map) > 500, "{} colours", colors(&map));
    assert!(has_letters(&map, [300, 455, 640, 480]), "credits in the map's corner");

    let window = desk.picture("shift+p", 2);
    assert_eq!(window.dimensions(), (640, 480));
    assert!(has_letters(&window, [0, 400, 350, 480]), "credits beside the panel");
    assert!(shows_panel(&window) && !shows_panel(&map));
    desk.xdotool("key Tab");
    let hidden = desk.picture("shift+p", 3);
    assert!(!shows_panel(&hidden), "Tab hides the panel");
    assert!(has_letters(&hidden, [300, 400, 640, 480]), "and not the credits");
}

/// Whether much of the right side is as dark as the panel; no map is that dark.
fn shows_panel(picture: &image::RgbaImage) -> bool {
    let dark = picture.enumerate_pixels().filter(|(x, _, pixel)| *x > 360 && pixel.0[0] < 60);
    dark.count() > 20_000
}

#[test]
fn a_key_held_when_the_keyboard_comes_to_the_window_is_pressed_once() {
    let Some(desk) = Desk::open(&[]) else { return };
    let id = desk.display.window();
    // A window that gets the focus late is told that the key is already down, and then also gets
    // the event of its press.
    desk.signal("STOP");
    desk.xdotool(&format!("windowfocus {id}"));
    desk.xdotool("keydown p");
    desk.signal("CONT");
    assert!(!shows_panel(&desk.saved(1)), "of the map");
    desk.xdotool("keyup p");
    assert!(shows_panel(&desk.picture("shift+p", 2)), "of the window, and no other before it");
}

/// If Ctrl Q is held down a little too long in one window, it must not close the next one, too;
/// pressed there it does, and the image that was requested just before is not lost.
#[test]
fn control_q_ends_the_window_that_it_was_pressed_in() {
    let Some(mut desk) = Desk::open(&[]) else { return };
    desk.xdotool("keydown ctrl");
    desk.xdotool("keydown q");
    // The display begins to repeat the key.
    thread::sleep(Duration::from_secs(1));
    desk.focus();
    thread::sleep(Duration::from_secs(1));
    desk.xdotool("keyup q");
    desk.xdotool("keyup ctrl");
    desk.point_at(120, 200);

    // Both keys are pressed before the next frame.
    desk.signal("STOP");
    desk.xdotool("key p");
    desk.xdotool("key ctrl+q");
    desk.signal("CONT");
    assert_eq!(ended(&mut desk.window).code, 0);
    assert_eq!(desk.saved(1).dimensions(), (640, 480));
}

#[test]
fn a_style_that_changes_is_shown_and_a_broken_one_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let style = folder.path().join("mine.toml");
    let preset = |name: &str| {
        fs::read_to_string(e2e::root().join("config/styles").join(name)).expect("it comes along")
    };
    fs::write(&style, preset("dark.toml")).unwrap();
    let Some(desk) = Desk::open(&["--style", style.to_str().expect("paths are UTF-8")]) else {
        return;
    };
    desk.focus();
    let mean = |picture: &image::RgbaImage| {
        let sum: u64 = picture.pixels().map(|pixel| u64::from(pixel.0[1])).sum();
        sum / u64::from(picture.width() * picture.height())
    };
    let dark = mean(&desk.picture("p", 1));
    fs::write(&style, preset("road-atlas.toml")).unwrap();
    // The program checks the file at intervals, and a frame may take long.
    let mut number = 1;
    let light = loop {
        thread::sleep(Duration::from_secs(1));
        number += 1;
        let light = mean(&desk.picture("p", number));
        if light > dark + 50 {
            break light;
        }
        assert!(number < 30, "{dark} became {light}");
    };
    fs::write(&style, "outline_px = high").unwrap();
    thread::sleep(Duration::from_secs(3));
    assert_eq!(mean(&desk.picture("p", number + 1)), light, "the old one stays");
}

#[test]
fn it_survives_other_sizes_and_being_hidden_and_ends_well() {
    let Some(mut desk) = Desk::open(&[]) else { return };
    let id = desk.focus();
    desk.xdotool(&format!("windowsize {id} 500 401"));
    let is_small = |line: &Line| {
        line.vector(["width_px", "height_px"]) == Some([500.0, 401.0]) && line.is_settled()
    };
    desk.wait("smaller picture", is_small).expect("the window is open");
    desk.xdotool(&format!("windowunmap {id}"));
    thread::sleep(Duration::from_millis(300));
    desk.xdotool(&format!("windowmap {id}"));
    thread::sleep(Duration::from_millis(300));
    desk.focus();
    desk.point_at(120, 200);
    desk.point_at(140, 210);
    assert_eq!(desk.picture("p", 1).dimensions(), (500, 401));

    desk.xdotool("key ctrl+q");
    assert_eq!(ended(&mut desk.window).code, 0);
}

/// The points of all lines of a GeoJSON file.
fn lines_of(path: &Path) -> Vec<Vec<Vec<f64>>> {
    let text = fs::read_to_string(path).expect("it is saved");
    let document: serde_json::Value = serde_json::from_str(&text).expect("as JSON");
    let features = document["features"].as_array().expect("a collection");
    let line = |feature: &serde_json::Value| {
        serde_json::from_value(feature["geometry"]["coordinates"].clone()).expect("a line")
    };
    features.iter().map(line).collect()
}

impl Desk {
    fn click(&mut self, x: i32, y: i32) {
        self.point_at(x, y);
        self.xdotool("click 1");
    }

    /// The lines as they are saved now.
    fn saved_lines(
        &self,
        path: &Path,
        is_right: impl Fn(&[Vec<Vec<f64>>]) -> bool,
    ) -> Vec<Vec<Vec<f64>>> {
        self.xdotool("key ctrl+s");
        let begun = Instant::now();
        loop {
            if path.exists() {
                let lines = lines_of(path);
                if is_right(&lines) {
                    return lines;
                }
                assert!(begun.elapsed() < Duration::from_mins(1), "{lines:?}");
            }
            assert!(begun.elapsed() < Duration::from_mins(1), "nothing is saved");
            thread::sleep(Duration::from_millis(100));
        }
    }
}

/// The number of pixels with the yellow of drawn lines.
fn yellow(picture: &image::RgbaImage) -> usize {
    let is_yellow = |pixel: &&image::Rgba<u8>| {
        let [red, green, blue, _] = pixel.0;
        red > 230 && green > 200 && blue < 60
    };
    picture.pixels().filter(is_yellow).count()
}

#[test]
fn a_line_is_drawn_changed_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines.geojson");
    let draw = path.to_str().expect("paths are UTF-8").to_owned();
    let near = ["--look-at", "9.53,46.88", "--distance", "5000", "--draw", &draw];
    let Some(mut desk) = Desk::open(&near) else { return };
    desk.focus();
    // Without the panel there is space next to the notices.
    desk.xdotool("key Tab");
    let bare = yellow(&desk.picture("p", 1));
    desk.xdotool("key l");
    for (x, y) in [(300, 260), (380, 330), (450, 260)] {
        desk.click(x, y);
    }
    desk.xdotool("key Return");
    let drawn = yellow(&desk.picture("p", 2));
    assert!(drawn > bare + 100, "{bare} and {drawn} yellow pixels");
    let three = desk.saved_lines(&path, |lines| lines.len() == 1);
    assert_eq!(three[0].len(), 3);

    // Another line, whose last point is removed.
    for (x, y) in [(320, 200), (400, 215), (440, 200)] {
        desk.click(x, y);
    }
    desk.xdotool("key Delete");
    let two = desk.saved_lines(&path, |lines| lines.len() == 2);
    assert_eq!(two[0], three[0], "to the last bit");
    assert_eq!(two[1].len(), 2);

    // The middle of the first line is dragged; that is one change, which is undone and redone.
    desk.point_at(380, 330);
    desk.xdotool("mousedown 1");
    for step in 1..=5 {
        desk.xdotool(&format!("mousemove {} {}", 380 + 3 * step, 330 + 3 * step));
    }
    desk.point_at(395, 345);
    desk.xdotool("mouseup 1");
    let dragged = desk.saved_lines(&path, |lines| lines[0] != three[0]);
    assert_eq!((&dragged[0][0], &dragged[0][2]), (&three[0][0], &three[0][2]));
    assert_ne!(dragged[0][1], three[0][1]);
    desk.xdotool("key ctrl+z");
    desk.saved_lines(&path, |lines| lines == two);
    desk.xdotool("key ctrl+y");
    desk.saved_lines(&path, |lines| lines == dragged);

    // Unsaved changes are saved when the window closes.
    desk.click(350, 300);
    desk.xdotool("key Return");
    desk.xdotool("key ctrl+z");
    desk.xdotool("key ctrl+z");
    desk.xdotool("key ctrl+q");
    assert_eq!(ended(&mut desk.window).code, 0);
    assert_eq!(lines_of(&path), two, "two changes were taken back: the point and the drag");

    // An image of the same file, by another command.
    let package = desk.trace.with_file_name("pass.pmtiles");
    let picture = folder.path().join("lines.png");
    let words = ["render", e2e::text(&package), "-o", e2e::text(&picture), "--overlay", &draw];
    let ran = e2e::corniche(words);
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Geometries of a GeoJSON file: their types, and the numbers of positions of their first line.
fn geometries(path: &Path) -> Vec<(String, usize)> {
    let text = fs::read_to_string(path).expect("it is saved");
    let document: serde_json::Value = serde_json::from_str(&text).expect("as JSON");
    let features = document["features"].as_array().expect("a collection");
    let geometry = |feature: &serde_json::Value| {
        let geometry = &feature["geometry"];
        let kind = geometry["type"].as_str().expect("a word").to_owned();
        let coordinates = geometry["coordinates"].as_array().expect("a list");
        let count = match kind.as_str() {
            "Polygon" => coordinates[0].as_array().expect("a ring").len(),
            _ => coordinates.len(),
        };
        (kind, count)
    };
    features.iter().map(geometry).collect()
}

#[test]
fn an_area_is_drawn_from_above_and_its_corners_are_rounded() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("areas.geojson");
    let draw = path.to_str().expect("paths are UTF-8").to_owned();
    let near = ["--look-at", "9.53,46.88", "--distance", "5000", "--draw", &draw];
    let Some(mut desk) = Desk::open(&near) else { return };
    desk.focus();
    desk.xdotool("key Tab");
    desk.xdotool("key t");
    let bare = desk.picture("p", 1);
    desk.xdotool("key l");
    for (x, y) in [(300, 200), (420, 210), (410, 330), (310, 320)] {
        desk.click(x, y);
    }
    desk.xdotool("key g");
    let drawn = desk.picture("p", 2);
    // Inside, well away from the outline, every pixel is more yellow than the bare map, and outside
    // none is.
    let is_tinted = |x: u32, y: u32| {
        let [red, green, blue] = [0, 1, 2].map(|channel| {
            i32::from(drawn.get_pixel(x, y)[channel]) - i32::from(bare.get_pixel(x, y)[channel])
        });
        red.min(green) - blue > 20
    };
    let count = |columns: std::ops::Range<u32>, rows: std::ops::Range<u32>| {
        columns
            .flat_map(|x| rows.clone().map(move |y| (x, y)))
            .filter(|&(x, y)| is_tinted(x, y))
            .count()
    };
    assert_eq!(count(330..400, 225..310), 70 * 85, "inside");
    assert_eq!(count(200..285, 225..310), 0, "beside");

    let saved = |kind: &str, positions: usize| {
        desk.xdotool("key ctrl+s");
        let begun = Instant::now();
        loop {
            let found = if path.exists() { geometries(&path) } else { Vec::new() };
            if found == [(kind.to_owned(), positions)] {
                return;
            }
            assert!(begun.elapsed() < Duration::from_mins(1), "{found:?}");
            thread::sleep(Duration::from_millis(100));
        }
    };
    saved("Polygon", 5);
    // Four sides in eight pieces each.
    desk.xdotool("key m");
    saved("Polygon", 33);
    desk.xdotool("key ctrl+z");
    desk.xdotool("key ctrl+z");
    saved("LineString", 4);
    desk.xdotool("key ctrl+q");
    assert_eq!(ended(&mut desk.window).code, 0);
}
