//! Invalid inputs of every kind: each gives a clear message and the right exit code, and nothing is
//! written to the target.

use std::{fs, path::Path};

use e2e::{Ran, build_pass, corniche, real_data, sample, text};

/// Runs `corniche build` with `arguments` and expects `code`, no file at the target and no
/// temporary files next to it.
fn refuses(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) -> Ran {
    let target = folder.join("out.pmtiles");
    let mut all = vec!["build", "-o", text(&target)];
    all.extend(arguments);
    let ran: Ran = corniche(all);
    assert_eq!(ran.code, code, "{arguments:?}: {}", ran.err);
    for word in words {
        assert!(ran.err.contains(word), "{arguments:?} says {:?}, not {word:?}", ran.err);
    }
    assert!(!target.exists(), "{arguments:?} left a package");
    let litter: Vec<_> = fs::read_dir(folder)
        .expect("the folder is this test's own")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.contains(".work"))
        .collect();
    assert!(litter.is_empty(), "{arguments:?} left {litter:?}");
    ran
}

#[test]
fn refuses_files_that_are_missing_empty_or_something_else() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    let (empty, prose) = (folder.path().join("empty.tif"), folder.path().join("prose.tif"));
    fs::write(&empty, b"").unwrap();
    fs::write(&prose, b"this is not a raster, nor an extract").unwrap();
    refuses(folder.path(), &["--dem", "/nowhere/dem.tif"], 2, &["/nowhere/dem.tif"]);
    refuses(folder.path(), &["--dem", text(&empty)], 2, &["empty.tif"]);
    refuses(folder.path(), &["--dem", text(&prose)], 2, &["prose.tif"]);
    refuses(
        folder.path(),
        &["--dem", text(&dem), "--osm", "/nowhere/a.osm.pbf"],
        2,
        &["a.osm.pbf"],
    );
    refuses(folder.path(), &["--dem", text(&dem), "--osm", text(&prose)], 2, &["prose.tif"]);
    refuses(folder.path(), &["--dem", text(&dem), "--osm", text(&empty)], 2, &["empty.tif"]);
}

#[test]
fn refuses_an_extract_that_lies_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    let osm = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let options = ["--dem", text(&dem), "--osm", text(&osm)];
    let ran = refuses(folder.path(), &options, 2, &["do not overlap"]);
    // The message gives both positions, so that the reader sees which one is wrong.
    let rectangle = |before: &str| -> Vec<f64> {
        let (_, from) = ran.err.split_once(before).expect("it says so");
        let words = from.split([' ', ',', ';', '\n']);
        let [west, east, south, north] =
            words.filter_map(|word| word.parse().ok()).take(4).collect::<Vec<f64>>()[..]
        else {
            panic!("{from}");
        };
        vec![west, south, east, north]
    };
    for (within, true_deg) in [
        ("roads are within longitudes ", [9.47, 47.05, 9.64, 47.27]),
        ("heights within longitudes ", [9.50, 46.85, 9.58, 46.95]),
    ] {
        let told_deg = rectangle(within);
        let is_near = told_deg.iter().zip(true_deg).all(|(told, near)| (told - near).abs() < 0.1);
        assert!(told_deg.len() == 4 && is_near, "{}", ran.err);
    }
}

#[test]
fn refuses_settings_that_make_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    let dem = text(&dem);
    refuses(folder.path(), &["--dem", dem, "--max-error", "-1"], 2, &["--max-error"]);
    refuses(folder.path(), &["--dem", dem, "--cell", "0"], 2, &["--cell"]);
    refuses(folder.path(), &["--dem", dem, "--crs", "EPSG:4326"], 2, &["--crs"]);
    refuses(folder.path(), &["--dem", dem, "--crs", "nonsense"], 2, &["nonsense"]);
    refuses(folder.path(), &["--dem", dem, "--frc-table", "nonsense"], 2, &["nonsense"]);
    refuses(
        folder.path(),
        &["--dem", dem, "--photo", dem],
        2,
        &["Float32", "8 bits", "gdal_translate"],
    );
}

#[test]
fn refuses_a_cell_far_finer_than_the_samples_unless_forced() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("small.asc");
    let grid = "ncols 20\nnrows 20\nxllcorner 500000\nyllcorner 5200000\ncellsize 10\n";
    fs::write(&dem, format!("{grid}{}", "1 2 3 4 5 6 7 8 9 8 7 6 5 4 3 2 1 0 1 2\n".repeat(20)))
        .unwrap();
    // The raster's spacing is 10 m: 16 nodes per sample are allowed, 20 are not.
    let raster = ["--dem", text(&dem), "--dem-crs", "EPSG:32632"];
    let fine = [&raster[..], &["--cell", "0.5"]].concat();
    refuses(folder.path(), &fine, 2, &["20 nodes", "--cell", "--force"]);
    let target = folder.path().join("out.pmtiles");
    let coarse = ["--max-error", "20", "--quiet", "-o", text(&target)];
    let ran = corniche([&["build", "--cell", "0.625"], &raster[..], &coarse[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = corniche([&["build"], &fine[..], &["--force", "-O"], &coarse[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
}

#[test]
fn a_terabyte_is_a_size() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    let target = folder.path().join("out.pmtiles");
    let line = ["build", "--dem", text(&dem), "--quiet", "-o", text(&target), "--memory", "1T"];
    let ran = corniche(line);
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// The file extension must be that of a PNG, the only format of images.
#[test]
fn refuses_a_picture_that_its_name_makes_something_else() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--quiet"]);
    for name in ["a.jpg", "a.jpeg", "a.tif", "a.webp"] {
        let picture = folder.path().join(name);
        let ran = corniche(["render", text(&package), "-o", text(&picture)]);
        assert_eq!(ran.code, 2, "{name}: {}", ran.err);
        assert!(ran.err.contains(name) && ran.err.contains(".png"), "{name}: {}", ran.err);
        assert!(!picture.exists());
    }
}

#[test]
fn keeps_what_exists_unless_told_to_replace_it() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("pass.pmtiles");
    fs::write(&target, b"precious").unwrap();
    let dem = sample("pass/pass-dem.tif");
    let arguments = ["build", "--dem", text(&dem), "-o", text(&target)];
    let ran = corniche(arguments);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert_eq!(fs::read(&target).unwrap(), b"precious");
    // A failed run leaves the existing file unchanged, with or without -O.
    let ran = corniche(["build", "--dem", "/nowhere.tif", "-O", "-o", text(&target)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert_eq!(fs::read(&target).unwrap(), b"precious");
    build_pass(&target, &["-O", "--quiet"]);
    assert!(fs::metadata(&target).unwrap().len() > 10_000);
}

#[test]
fn refuses_a_target_that_cannot_be_written() {
    let dem = sample("pass/pass-dem.tif");
    for target in ["/nowhere/out.pmtiles", "/proc/out.pmtiles"] {
        let ran = corniche(["build", "--dem", text(&dem), "-o", target]);
        assert_eq!(ran.code, 2, "{}", ran.err);
    }
}

#[test]
fn refuses_packages_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let prose = folder.path().join("prose.pmtiles");
    fs::write(&prose, b"PMTiles, one might think, but no").unwrap();
    for command in ["info", "growth", "verify"] {
        for package in [text(&prose), "/nowhere/a.pmtiles"] {
            let ran = corniche([command, package]);
            assert_eq!(ran.code, 2, "{command} {package}: {}", ran.err);
            assert!(ran.err.contains(package), "{}", ran.err);
        }
    }
}

/// An interrupted build: exit code 4, no file at the target; progress is kept, and the resumed
/// build produces the package and the list of defects of an uninterrupted build.
#[cfg(unix)]
#[test]
fn goes_on_after_an_interruption() {
    use std::{
        io::{BufRead as _, BufReader},
        process::{Command, Stdio},
    };

    let folder = tempfile::tempdir().unwrap();
    let [target, list] = ["out.pmtiles", "out.csv"].map(|name| folder.path().join(name));
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let build = |arguments: &[&str]| {
        let mut command = Command::new(e2e::binary());
        command
            .args(["build", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&target)])
            .args(["--max-error", "0.05", "--defects", text(&list)])
            .args(arguments);
        command
    };
    let left = || -> Vec<_> {
        let mut names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    };
    // With a fine tolerance and one thread the build takes long enough to be interrupted.
    let mut child =
        build(&["--threads", "1", "--json-progress"]).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let meshing = lines.any(|line| line.unwrap().contains("\"coarse-tins\""));
    assert!(meshing, "the build ended before it meshed");
    assert!(e2e::send_signal(&child, "INT"));
    let rest: Vec<String> = lines.map(Result::unwrap).collect();
    let code = child.wait().unwrap().code();
    assert_eq!(code, Some(4), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("interrupted")), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("--resume")), "{rest:?}");
    assert_eq!(left(), [".out.pmtiles.work"], "only the store is there");

    let resumed = build(&["--resume", "--json-progress"]).output().unwrap();
    let said = String::from_utf8_lossy(&resumed.stderr);
    assert!(resumed.status.success(), "{said}");
    assert!(
        said.contains("\"tiles\"") && !said.contains("\"roads\""),
        "roads are read once: {said}"
    );
    assert_eq!(left(), ["out.csv", "out.pmtiles"], "the store is gone");
    let [package, defects] = [&target, &list].map(|path| fs::read(path).unwrap());
    let unbroken = build(&["-O", "--quiet"]).output().unwrap();
    assert!(unbroken.status.success(), "{unbroken:?}");
    assert!(fs::read(&target).unwrap() == package, "the package is another");
    let [defects, unbroken] =
        [defects, fs::read(&list).unwrap()].map(|csv| String::from_utf8(csv).unwrap());
    assert_eq!(defects, unbroken);
    assert!(unbroken.contains("self-crossing"), "the sample's extract has defects: {unbroken}");
}

/// Real extracts that are unusable: each is rejected with the reason before any long work.
#[test]
fn refuses_broken_and_foreign_extracts() {
    let cases = [
        ("nasty/osm/empty.osm.pbf", "no road"),
        ("nasty/derived-osm/truncated-half.osm.pbf", "truncated-half"),
        ("nasty/derived-osm/zero-bytes.osm.pbf", "zero-bytes"),
        ("nasty/osm/monaco-latest.lz4.osm.pbf", "LZ4"),
        ("nasty/osm/deleted_nodes.osh.pbf", "history"),
    ];
    for (file, word) in cases {
        let Some(osm) = real_data(file) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let dem = sample("pass/pass-dem.tif");
        refuses(folder.path(), &["--dem", text(&dem), "--osm", text(&osm)], 2, &[word]);
    }
}
