//! Flights over a package through the whole binary: a repeated flight gives the same output, and
//! the output is complete or absent.

use std::{fs, path::Path};

use e2e::{Ran, copy_pass, draw, lacks_adapter, send_signal, text, without_times};

/// Runs `fly` with a small image size; `None` if there is no adapter.
fn fly(package: &Path, csv: &Path, options: &[&str]) -> Option<Ran> {
    draw("fly", package, csv, &[&["--size", "160x120"], options].concat())
}

#[test]
fn the_same_flight_gives_the_same_list_and_the_same_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let at = |name: &str| folder.path().join(name);
    let mut flights = Vec::new();
    for turn in ["first", "second"] {
        let (csv, png) = (at(&format!("{turn}.csv")), at(turn));
        let options = ["--frames", "6", "--roads", "none,geo,sv,sv-no-caps", "--png", text(&png)];
        let Some(ran) = fly(&package, &csv, &options) else { return };
        assert_eq!(ran.code, 0, "{}", ran.err);
        for word in ["without first frame", "lod, roads sv-no-caps", "loss %", "p95", "26 %"] {
            assert!(ran.out.contains(word), "{word}: {}", ran.out);
        }
        let mut pictures: Vec<(String, Vec<u8>)> = fs::read_dir(&png)
            .unwrap()
            .map(|entry| entry.unwrap())
            .map(|entry| {
                let name = entry.file_name().into_string().unwrap();
                (name, fs::read(entry.path()).unwrap())
            })
            .collect();
        pictures.sort();
        flights.push((without_times(&csv), pictures));
    }
    assert!(flights[0] == flights[1], "{:?}\n{:?}", flights[0].0, flights[1].0);
    let (list, pictures) = &flights[0];
    assert_eq!(list.len(), 1 + 4 * 6);
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names.len(), 24);
    assert_eq!((names[0], names[23]), ("lod-geo-00000.png", "lod-sv-no-caps-00005.png"));
    let picture = |name: &str| &pictures.iter().find(|(known, _)| known == name).unwrap().1;
    assert_ne!(picture("lod-none-00003.png"), picture("lod-geo-00003.png"), "roads show");
    assert_ne!(picture("lod-sv-00003.png"), picture("lod-sv-no-caps-00003.png"), "caps show");
    assert_ne!(picture("lod-geo-00003.png"), picture("lod-geo-00004.png"), "the camera moves");
    // The same flight for all methods: they differ in segments only.
    let column = |name: &str| list[0].iter().position(|heading| heading == name).unwrap();
    let of = |line: usize, name: &str| list[line][column(name)].parse::<f64>().unwrap();
    for frame in 1..=6 {
        for (name, is_same) in [("time_s", true), ("triangles", true), ("road_segments", false)] {
            let (none, geo) = (of(frame, name), of(frame + 6, name));
            assert_eq!((none - geo).abs() < 1e-9, is_same, "{name} of frame {frame}");
        }
        assert!(of(frame, "gpu_bytes") > 0.0 && of(frame, "triangles") > 0.0);
    }
}

#[test]
fn full_resolution_culling_and_level_of_detail_draw_ever_less() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let (csv, svg) = (folder.path().join("fly.csv"), folder.path().join("fly.svg"));
    let options = ["--frames", "5", "--lod", "full,culled,lod", "--svg", text(&svg)];
    let Some(ran) = fly(&package, &csv, &options) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    let list = without_times(&csv);
    let column = list[0].iter().position(|heading| heading == "triangles").unwrap();
    let triangles: Vec<u64> = [0, 5, 10]
        .map(|start| {
            list[start + 1..start + 6].iter().map(|l| l[column].parse::<u64>().unwrap()).sum()
        })
        .into();
    assert!(triangles[0] > triangles[1] && triangles[1] > triangles[2], "{triangles:?}");
    let drawing = fs::read_to_string(&svg).unwrap();
    assert!(
        ["full", "culled", "lod"].iter().all(|lod| drawing.contains(&format!("{lod}, roads sv")))
    );

    // An existing file is kept, and the message is printed before anything is drawn; a table never
    // overwrites a package.
    let before = fs::read(&csv).unwrap();
    let again = fly(&package, &csv, &["--frames", "2"]).unwrap();
    assert_eq!((again.code, fs::read(&csv).unwrap() == before), (3, true), "{}", again.err);
    let over = fly(&package, &package, &["--frames", "2", "-O"]).unwrap();
    assert_eq!(over.code, 2, "{}", over.err);
    let replaced = fly(&package, &csv, &["--frames", "2", "-O"]).unwrap();
    assert_eq!(replaced.code, 0, "{}", replaced.err);
    assert_eq!(without_times(&csv).len(), 3);
}

#[test]
fn a_flight_can_be_written_down_changed_and_taken_again() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let at = |name: &str| folder.path().join(name);
    let (path, first, second) = (at("flight.toml"), at("first.csv"), at("second.csv"));
    let Some(ran) = fly(&package, &first, &["--frames", "3", "--save-path", text(&path)]) else {
        return;
    };
    assert_eq!(ran.code, 0, "{}", ran.err);
    let taken = ["--frames", "3", "--path", text(&path)];
    let ran = fly(&package, &second, &taken).unwrap();
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(without_times(&first), without_times(&second));

    let written = fs::read_to_string(&path).unwrap();
    let refused = |flight: &str, more: &[&str], words: &[&str]| {
        let (path, csv) = (at("changed.toml"), at("none.csv"));
        fs::write(&path, flight).unwrap();
        let options: Vec<&str> = ["--path", text(&path)].iter().chain(more).copied().collect();
        let ran = fly(&package, &csv, &options).unwrap();
        assert_eq!(ran.code, 2, "{}", ran.err);
        for word in words {
            assert!(ran.err.contains(word), "{word}: {}", ran.err);
        }
        assert!(!csv.exists());
    };
    refused("height = high", &[], &["changed.toml", "line 1"]);
    refused(&written.replace("time_s", "time"), &[], &["changed.toml", "time"]);
    let (crs, keyframes) = written.split_once('\n').unwrap();
    assert!(crs.starts_with("crs = \"EPSG:"), "{crs}");
    refused(&format!("crs = \"EPSG:3857\"\n{keyframes}"), &[], &["EPSG:3857", "lon_deg"]);
    let low: String = written
        .lines()
        .map(|line| {
            if line.starts_with("height_m") {
                "height_m = 5.0\n".to_owned()
            } else {
                format!("{line}\n")
            }
        })
        .collect();
    refused(&low, &[], &["too low", "s the eye"]);
    refused(&written, &["--step", "0"], &["--step"]);
    refused(&written, &["--svg", text(&at("none.csv"))], &["none.csv", "already uses this file"]);
    refused(&written, &["--gpu-memory", "1K"], &["1024", "memory"]);
    refused(&written, &["--gpu-memory", "1K", "--lod", "full"], &["level of detail"]);
}

/// A flight as recorded by a window, which keeps two metres of exaggerated height above the known
/// ground and records its path ten times a second.
#[test]
fn a_flight_that_dives_to_the_ground_is_flown_at_any_exaggeration() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let at = |name: &str| folder.path().join(name);
    let (path, csv) = (at("flight.toml"), at("fly.csv"));
    let saved = ["--frames", "2", "--save-path", text(&path)];
    let Some(ran) = fly(&package, &csv, &saved) else { return };
    assert_eq!(ran.code, 0, "{}", ran.err);
    let written = fs::read_to_string(&path).unwrap();
    let value = |name: &str| {
        let line = written.lines().filter(|line| line.starts_with(name)).nth(8).unwrap();
        line.split(" = ").nth(1).unwrap().parse::<f64>().unwrap()
    };
    let keyframe = |time_s: f64, x_m: f64, height_m: f64| {
        let y_m = value("y_m");
        format!(
            "[[keyframe]]\ntime_s = {time_s}\nx_m = {x_m}\ny_m = {y_m}\nheight_m = {height_m:.3}\n\
             heading_deg = 40.0\npitch_deg = 75.0\n"
        )
    };
    let flown = |flight: &str, options: &[&str]| {
        fs::write(&path, flight).unwrap();
        fly(&package, &csv, &[&["-O", "--path", text(&path)], options].concat()).unwrap()
    };
    let place_m = value("x_m");
    let sea = flown(&(keyframe(0.0, place_m, 0.0) + &keyframe(1.0, place_m, 0.0)), &[]);
    assert_eq!(sea.code, 2, "{}", sea.err);
    // The message gives the height of the ground with one decimal.
    let words: Vec<&str> = sea.err.split(' ').collect();
    let too_low = words.windows(2).position(|pair| pair == ["m", "too"]).expect(&sea.err);
    let ground_m: f64 = words[too_low - 1].parse().expect(&sea.err);

    // Down to a quarter of the clearance, a stop there, and up again.
    let lowest_m = ground_m + 0.5;
    let dive = keyframe(0.0, place_m, ground_m + 800.0)
        + &keyframe(1.0, place_m, lowest_m)
        + &keyframe(2.0, place_m, lowest_m)
        + &keyframe(3.0, place_m, ground_m + 800.0);
    let lowest_in_list = || {
        let list = without_times(&csv);
        let column = list[0].iter().position(|heading| heading == "height_m").unwrap();
        let heights = list[1..].iter().map(|line| line[column].parse::<f64>().unwrap());
        heights.fold(f64::INFINITY, f64::min)
    };
    let png = at("frames");
    let ran = flown(&dive, &["--frames", "7", "--exaggeration", "4", "--png", text(&png)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!((lowest_in_list() - lowest_m).abs() < 0.11, "{} {lowest_m}", lowest_in_list());
    let ran = flown(&dive, &["--frames", "7"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("raised to stay above the ground, by up to 1."), "{}", ran.err);
    assert!((lowest_in_list() - ground_m - 2.0).abs() < 0.11, "{} {ground_m}", lowest_in_list());
    let [high, low] = [0, 3].map(|frame: u32| {
        image::open(png.join(format!("lod-sv-{frame:05}.png"))).unwrap().to_rgb8()
    });
    assert!(high != low);
    // At a height of two metres the haze and the near plane are near: the ground just below fills
    // the lower half.
    let feet = low.get_pixel(80, 115);
    assert!(feet.0.iter().any(|channel| *channel > 0), "{feet:?}");

    // Between keyframes behind a ridge the camera is raised over it.
    let through = keyframe(0.0, place_m - 2500.0, ground_m + 1500.0)
        + &keyframe(5.0, place_m, lowest_m)
        + &keyframe(10.0, place_m + 2500.0, ground_m + 1500.0);
    let ran = flown(&through, &["--frames", "5"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// The table is larger than the limit on file sizes here; the recorded flight next to it is
/// smaller.
#[cfg(unix)]
#[test]
fn a_list_that_does_not_fit_on_the_disk_leaves_nothing_beside_it() {
    use std::process::Command;

    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    // The shell counts blocks of 512 or of 1024 bytes. If the signal is ignored, the write returns
    // an error.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$@\"";
    let ran = Command::new("sh")
        .args(["-c", limited, "sh"])
        .arg(e2e::binary())
        .args(["fly", text(&package), "--size", "16x12", "--frames", "120"])
        .args(["-o", text(&out.join("fly.csv")), "--save-path", text(&out.join("flight.toml"))])
        .output()
        .unwrap();
    let ran = Ran::from(ran);
    if lacks_adapter(&ran) {
        return;
    }
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(ran.err.contains("cannot write") && ran.err.contains("fly.csv"), "{}", ran.err);
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}

/// Looking up the ground beneath a million frames takes minutes; an interrupt is noticed long
/// before.
#[cfg(unix)]
#[test]
fn a_flight_is_interrupted_while_it_is_being_checked_too() {
    use std::{
        io::{BufRead, BufReader},
        process::{Command, Stdio},
        time::{Duration, Instant},
    };

    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let csv = folder.path().join("fly.csv");
    let mut child = Command::new(e2e::binary())
        .args(["fly", text(&package), "-o", text(&csv), "--frames", "1000000"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(child.stderr.take().unwrap());
    let mut lines = String::new();
    // The adapter is named before the check begins.
    while !lines.contains("drawn by") {
        if said.read_line(&mut lines).unwrap() == 0 {
            let code = child.wait().unwrap().code().unwrap_or(-1);
            assert!(lacks_adapter(&Ran { code, out: String::new(), err: lines }));
            return;
        }
    }
    let signalled = Instant::now();
    assert!(send_signal(&child, "INT"));
    assert_eq!(child.wait().unwrap().code(), Some(4));
    assert!(signalled.elapsed() < Duration::from_secs(10), "{:?}", signalled.elapsed());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the package is there");
}

/// An interrupted flight: exit code 4, and no table, images, chart or other file remains.
#[cfg(unix)]
#[test]
fn an_interrupted_flight_leaves_nothing() {
    use std::{
        process::{Command, Stdio},
        time::{Duration, Instant},
    };

    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let (csv, png, svg) = (out.join("fly.csv"), out.join("frames"), out.join("fly.svg"));
    let mut child = Command::new(e2e::binary())
        .args(["fly", text(&package), "-o", text(&csv), "--png", text(&png), "--svg", text(&svg)])
        .args(["--size", "160x120", "--frames", "5000"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Images are first written to a temporary folder.
    let is_under_way = || {
        let folders = fs::read_dir(&out)
            .unwrap()
            .filter_map(|entry| fs::read_dir(entry.unwrap().path()).ok());
        folders.flatten().count() > 0
    };
    let begun = Instant::now();
    while !is_under_way() {
        if child.try_wait().unwrap().is_some() {
            let ran = Ran::from(child.wait_with_output().unwrap());
            assert!(lacks_adapter(&ran), "{}", ran.err);
            return;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "no picture");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(send_signal(&child, "INT"));
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert_eq!(ran.code, 4, "{}", ran.err);
    assert!(ran.err.contains("interrupted"), "{}", ran.err);
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}
