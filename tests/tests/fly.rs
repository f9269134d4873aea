//! Flights over a package through the whole binary: twice the same, complete or not at all.

use std::{fs, path::Path};

use e2e::{Ran, build_pass, corniche, skipped};

fn text(path: &Path) -> &str {
    path.to_str().expect("paths of these tests are UTF-8")
}

/// `fly` in a small size; `None` where there is no adapter.
fn fly(package: &Path, csv: &Path, options: &[&str]) -> Option<Ran> {
    let fixed = ["fly", text(package), "-o", text(csv), "--size", "160x120"];
    let ran = corniche(fixed.into_iter().chain(options.iter().copied()));
    if ran.code == 1
        && std::env::var_os("CORNICHE_REQUIRE_GPU").is_none()
        && ran.err.contains("adapter")
    {
        skipped(&ran.err);
        return None;
    }
    Some(ran)
}

/// The cells of each line, without milliseconds, which come last.
fn without_times(csv: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(csv).expect("the list is written");
    let columns = text.lines().next().unwrap_or_default().split(',');
    let kept = columns.take_while(|name| !name.ends_with("_ms")).count();
    assert!((10..30).contains(&kept), "{text}");
    text.lines().map(|line| line.split(',').take(kept).map(str::to_owned).collect()).collect()
}

#[test]
fn the_same_flight_gives_the_same_list_and_the_same_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--quiet"]);
    let at = |name: &str| folder.path().join(name);
    let mut flights = Vec::new();
    for turn in ["first", "second"] {
        let (csv, png) = (at(&format!("{turn}.csv")), at(turn));
        let options = ["--frames", "6", "--roads", "none,geo,sv,sv-no-caps", "--png", text(&png)];
        let Some(ran) = fly(&package, &csv, &options) else { return };
        assert_eq!(ran.code, 0, "{}", ran.err);
        for word in ["first frame left out", "lod, roads sv-no-caps", "loss %", "p95", "26 %"] {
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
    build_pass(&package, &["--quiet"]);
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
        ["full", "culled", "lod"].iter().all(|lod| drawing.contains(&format!("{lod}, roads geo")))
    );

    // What exists is kept, and said before anything is drawn; a package is never replaced by a list.
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
    build_pass(&package, &["--quiet"]);
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
    refused(&written, &["--svg", text(&at("none.csv"))], &["none.csv", "uses that file"]);
    refused(&written, &["--gpu-memory", "1K"], &["1024", "memory"]);
    refused(&written, &["--gpu-memory", "1K", "--lod", "full"], &["level of detail"]);
}

/// Looking up the ground beneath a million frames takes minutes; an interrupt is noticed long before.
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
    build_pass(&package, &["--quiet"]);
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
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{lines}");
            assert!(lines.contains("adapter"), "{lines}");
            child.wait().unwrap();
            skipped(&lines);
            return;
        }
    }
    let signalled = Instant::now();
    let signal = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &signal]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(4));
    assert!(signalled.elapsed() < Duration::from_secs(10), "{:?}", signalled.elapsed());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the package is there");
}

/// Interrupted in the middle: exit code 4, no list, no pictures, no chart, nothing beside them.
#[cfg(unix)]
#[test]
fn an_interrupted_flight_leaves_nothing() {
    use std::{
        process::{Command, Stdio},
        time::{Duration, Instant},
    };

    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--quiet"]);
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
    // The first picture lies in a folder that is not yet the one asked for.
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
            assert!(std::env::var_os("CORNICHE_REQUIRE_GPU").is_none(), "{}", ran.err);
            assert!(ran.err.contains("adapter"), "{}", ran.err);
            skipped(&ran.err);
            return;
        }
        assert!(begun.elapsed() < Duration::from_mins(2), "no picture");
        std::thread::sleep(Duration::from_millis(20));
    }
    // The shell's own kill: a bare machine has no program of that name.
    let signal = format!("kill -INT {}", child.id());
    assert!(Command::new("sh").args(["-c", &signal]).status().unwrap().success());
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert_eq!(ran.code, 4, "{}", ran.err);
    assert!(ran.err.contains("interrupted"), "{}", ran.err);
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}
