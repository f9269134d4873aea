//! First mistakes of new users, and the program's answers: the helpful word, before any work, and
//! nothing superfluous.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path, process::Command};

use e2e::{Ran, binary, copy_pass, corniche, json, manifest, sample, text, write_ascii_grid};

/// A command ends with exit code 2, prints each of these words, and no debug form of a list.
fn refused(arguments: &[&str], words: &[&str]) -> Ran {
    let ran = corniche(arguments);
    assert_eq!(ran.code, 2, "{arguments:?}: {}{}", ran.out, ran.err);
    for word in words {
        assert!(ran.err.contains(word), "{arguments:?}: {word:?} is not in: {}", ran.err);
    }
    // Errors of the parser itself have a usage.
    for line in ran.err.lines().filter(|line| line.starts_with("corniche: ")) {
        assert!(!line.contains('[') && !line.contains("Some("), "{arguments:?}: {line}");
    }
    ran
}

/// Ground of 40 × 40 cells that rises to the east, in UTM 32.
fn write_ground(path: &Path) {
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(path, [41, 41], place, |column, _| 100.0 + column as f64);
}

#[test]
fn files_without_options_are_told_their_options() {
    refused(
        &["build", "a.hgt", "b.osm.pbf", "-o", "c.pmtiles"],
        &["'a.hgt'", "--dem a.hgt --osm b.osm.pbf"],
    );
    refused(&["plan", "b.osm.pbf", "a.tif"], &["--osm b.osm.pbf --dem a.tif"]);
    refused(&["profile", "a.pmtiles", "road.gpx"], &["--line road.gpx"]);
    // The most likely form of it.
    let files = ["pass/pass-dem.tif", "pass/pass.osm.pbf"].map(sample);
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("a.pmtiles");
    refused(
        &["build", "-q", "--dem", text(&files[0]), text(&files[1]), "-o", text(&package)],
        &["pass.osm.pbf\" has no raster band", "with --osm"],
    );
}

#[test]
fn a_place_outside_is_refused_and_swapped_numbers_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let package = text(&package);
    // The tile of level 0 extends that far, but the data does not.
    for place in ["9.65,46.9", "9.5,46.8", "9.44,46.99"] {
        refused(&["tile", package, "--at", place], &["the package covers longitudes 9.4"]);
    }
    refused(&["tile", package, "--at", "46.9,9.5"], &["longitude comes first: 9.5,46.9 is inside"]);
    assert_eq!(corniche(["tile", package, "--at", "9.5,46.9"]).code, 0);
    let png = folder.path().join("a.png");
    for (place, swapped) in [("46.9,9.5", "9.5,46.9"), ("46.87,9.55", "9.55,46.87")] {
        let arguments =
            ["render", package, "-o", text(&png), "--size", "64x48", "--look-at", place];
        let ran = corniche(arguments);
        if e2e::lacks_adapter(&ran) {
            return;
        }
        let words = format!("longitude comes first: {swapped} is inside");
        assert!(ran.code == 2 && ran.err.contains(&words), "{}", ran.err);
    }
    refused(
        &["profile", package, "--from", "46.93,9.46", "--to", "46.935,9.56"],
        &["longitude comes first: 9.46,46.93 is inside"],
    );
    let line = folder.path().join("line.geojson");
    fs::write(&line, r#"{"type":"LineString","coordinates":[[46.9,9.5],[46.91,9.52]]}"#).unwrap();
    refused(
        &["profile", package, "--line", text(&line)],
        &["longitude comes first: 9.5,46.9 is inside"],
    );
    let dem = sample("pass/pass-dem.tif");
    let other = folder.path().join("other.pmtiles");
    refused(
        &[
            "build",
            "-q",
            "--dem",
            text(&dem),
            "-o",
            text(&other),
            "--bounds",
            "46.88,9.47,46.9,9.5",
        ],
        &["9.47,46.88,9.5,46.9 has some"],
    );
    // An invalid latitude is rejected before the package is read.
    refused(
        &["render", package, "-o", text(&png), "--look-at", "45.5,-122.6"],
        &["longitude comes first"],
    );
}

/// No check runs whose result the wrong files would make worthless.
#[test]
fn files_that_are_not_those_of_the_package_are_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let [ground, other, package] = ["ground.asc", "other.asc", "a.pmtiles"].map(at);
    write_ground(&ground);
    fs::write(&other, fs::read_to_string(&ground).unwrap().replacen("139", "140", 1)).unwrap();
    let built = corniche([
        "build",
        "--dem",
        text(&ground),
        "--dem-crs",
        "EPSG:32632",
        "-o",
        text(&package),
        "-q",
    ]);
    assert_eq!(built.code, 0, "{}", built.err);
    let ran = refused(
        &["verify", text(&package), "--dem", text(&other)],
        &["not the elevation files", "pass \"ground.asc\", the same files"],
    );
    assert!(!ran.err.contains("tiles"), "no tile was looked at: {}", ran.err);
    let ran = refused(
        &["verify", text(&package), "--osm", text(&sample("pass/pass.osm.pbf"))],
        &["built without an extract"],
    );
    assert!(!ran.err.contains("tiles"), "{}", ran.err);
    let pass = at("pass.pmtiles");
    copy_pass(&pass, &["-q", "--max-error", "10"]);
    let osm = at("other.osm.pbf");
    fs::copy(sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf"), &osm).unwrap();
    let ran = refused(
        &["verify", text(&pass), "--osm", text(&osm)],
        &["other.osm.pbf\" is not what the package was built from; pass \"pass.osm.pbf\""],
    );
    assert!(!ran.err.contains("tiles"), "{}", ran.err);
    assert_eq!(corniche(["verify", text(&package), "--dem", text(&ground)]).code, 0);
}

/// A server has no folder for Wayland's socket, but no library complains about it.
#[test]
#[cfg(target_os = "linux")]
fn libraries_are_silent_without_a_desktop() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let (png, csv) = (folder.path().join("a.png"), folder.path().join("a.csv"));
    let small = ["--size", "64x48"];
    for arguments in [
        &[&["render", text(&package), "-o", text(&png)], &small[..]].concat()[..],
        &[&["fly", text(&package), "-o", text(&csv), "--frames", "2"], &small[..]].concat(),
        &["view", text(&package)],
    ] {
        for folder in [None, Some("relative")] {
            let mut command = Command::new(binary());
            for name in ["XDG_RUNTIME_DIR", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"] {
                command.env_remove(name);
            }
            if let Some(folder) = folder {
                command.env("XDG_RUNTIME_DIR", folder);
            }
            let ran = Ran::from(command.args(arguments).arg("-q").output().unwrap());
            assert!(!ran.err.contains("XDG_RUNTIME_DIR"), "{arguments:?}: {}", ran.err);
            assert!(ran.err.lines().all(|line| line.starts_with("corniche: ")), "{}", ran.err);
            let _ = (fs::remove_file(&png), fs::remove_file(&csv));
        }
    }
}

/// Empty lists are not printed: no line ends with a colon without a text after or below it.
#[test]
fn no_colon_stands_before_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let [ground, package, plan] = ["ground.asc", "a.pmtiles", "a.json"].map(at);
    write_ground(&ground);
    let [ground, package] = [text(&ground), text(&package)];
    let from = ["--dem", ground, "--dem-crs", "EPSG:32632"];
    let exports: Vec<[String; 2]> = [
        ("geotiff", "a.tif"),
        ("mesh", "a.glb"),
        ("3dtiles", "tiles"),
        ("quantized-mesh", "terrain"),
    ]
    .map(|(what, name)| [what.to_owned(), text(&at(name)).to_owned()])
    .to_vec();
    let mut lines: Vec<Vec<&str>> = vec![
        [&["build", "-o", package], &from[..]].concat(),
        [&["plan", "-o", text(&plan)], &from[..]].concat(),
        vec!["info", package],
        vec!["growth", package],
        vec!["verify", package],
        vec!["verify", package, "--dem", ground],
        vec!["tile", package, "0/0/0"],
    ];
    for [what, name] in &exports {
        let heights: &[&str] =
            if what.starts_with(['3', 'q']) { &["--heights", "as-is"] } else { &[] };
        lines.push([&["export", what, package, "-o", name], heights].concat());
    }
    for arguments in lines {
        let ran = corniche(&arguments);
        assert!(ran.code == 0 || arguments[0] == "growth", "{arguments:?}: {}", ran.err);
        for said in [&ran.out, &ran.err] {
            let mut lines = said.lines().peekable();
            while let Some(line) = lines.next() {
                let below = lines.peek().is_some_and(|next| !next.trim().is_empty());
                assert!(!line.trim_end().ends_with(':') || below, "{arguments:?}: {said}");
            }
        }
    }
}

#[test]
#[cfg(unix)]
fn a_name_that_is_too_long_is_told_as_that() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    let package = folder.path().join("a.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "20"]);
    for bytes in [232, 250, 300, 4000] {
        let named = |ending: &str| format!("{}/{}{ending}", text(folder.path()), "n".repeat(bytes));
        let words = ["too long for this file system", "choose a shorter name"];
        refused(&["build", "--dem", text(&dem), "-o", &named(".pmtiles")], &words);
        refused(&["plan", "--dem", text(&dem), "-o", &named(".json")], &words);
        refused(&["export", "geotiff", text(&package), "-o", &named(".tif")], &words);
        refused(&["export", "roads", text(&package), "-o", &named(".gpkg")], &words);
    }
    let long = "n".repeat(300);
    for arguments in [&["info", &long][..], &["build", "--dem", &long, "-o", "a.pmtiles"]] {
        refused(arguments, &["File name too long"]);
    }
    assert_eq!(e2e::names(folder.path()), ["a.pmtiles"]);
}

#[test]
fn half_a_file_of_srtm_is_told_with_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let [half, odd] = ["N47E009.hgt", "alps.hgt"].map(|name| folder.path().join(name));
    fs::write(&half, vec![0; 1_442_402]).unwrap();
    fs::write(&odd, vec![0; 2_884_802]).unwrap();
    let package = folder.path().join("a.pmtiles");
    let build = |dem: &Path, words: &[&str]| {
        refused(&["build", "--dem", text(dem), "-o", text(&package)], words);
    };
    build(&half, &["N47E009.hgt", "1442402 bytes", "2884802", "download it again"]);
    build(&odd, &["alps.hgt", "like N47E009.hgt"]);
}

/// `masl`, `unspecified`: invalid units of length are rejected with the option that sets the unit.
#[test]
fn the_unit_of_heights_can_be_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let ground = at("ground.asc");
    write_ground(&ground);
    for (unit, said, unit_m) in
        [("masl", "metre", 1.0), ("unspecified", "foot", 0.3048), ("ft", "decimetre", 0.1)]
    {
        let aux = format!(
            "<PAMDataset><PAMRasterBand band=\"1\"><UnitType>{unit}</UnitType></PAMRasterBand></PAMDataset>"
        );
        fs::write(at("ground.asc.aux.xml"), aux).unwrap();
        let package = at(&format!("{said}.pmtiles"));
        let arguments = [
            "build",
            "-q",
            "--dem",
            text(&ground),
            "--dem-crs",
            "EPSG:32632",
            "-o",
            text(&package),
        ];
        if unit != "ft" {
            refused(&arguments, &["ground.asc", unit, "--vertical-unit metre"]);
        }
        let built = corniche([&arguments[..], &["--vertical-unit", said]].concat());
        assert_eq!(built.code, 0, "{}", built.err);
        let told = json(&["info", text(&package), "--json"])["manifest"].take();
        assert_eq!(told["settings"]["vertical_unit"], said);
        let highest_m = told["vertical"]["range_m"][1].as_f64().unwrap();
        assert!((highest_m - 140.0 * unit_m).abs() < 0.13, "{unit}: {highest_m}");
        let ran = corniche(["verify", text(&package), "--dem", text(&ground), "-q"]);
        assert_eq!(ran.code, 0, "{}", ran.out);
    }
    let package = at("odd.pmtiles");
    let given = ["build", "--dem", text(&ground), "--dem-crs", "EPSG:32632", "-o", text(&package)];
    refused(&[&given[..], &["--vertical-unit", "masl"]].concat(), &["--vertical-unit", "us-foot"]);
}

/// Texts are checked where they are given: attribution must fit on one line.
#[test]
fn a_credit_is_plain_text_on_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let [ground, config] = ["ground.asc", "a.toml"].map(|name| folder.path().join(name));
    write_ground(&ground);
    let package = folder.path().join("a.pmtiles");
    let build =
        ["build", "-q", "--dem", text(&ground), "--dem-crs", "EPSG:32632", "-o", text(&package)];
    let long = "x".repeat(66_000);
    for (credit, words) in [
        ("a\nb", "U+000A"),
        ("\u{1b}[2J", "U+001B"),
        ("a\u{85}b", "U+0085"),
        (&*long, "66000 characters"),
    ] {
        let ran = corniche([&build[..], &["--attribution", credit]].concat());
        assert!(ran.code == 2 && ran.err.contains(words), "{credit:?}: {}", ran.err);
        assert!(ran.err.len() < 10_000, "{} bytes", ran.err.len());
    }
    fs::write(&config, "[terrain]\nattribution = [\"a\\u0000b\"]\n").unwrap();
    let of_config = corniche([&build[..], &["--config", text(&config)]].concat());
    assert!(of_config.code == 2 && of_config.err.contains("U+0000"), "{}", of_config.err);
    assert!(!package.exists());
    // An error in a file is one line, without the parser's drawing of the position.
    fs::write(&config, "[terrain]\nattribution = 3\n").unwrap();
    let odd = corniche([&build[..], &["--config", text(&config)]].concat());
    assert!(odd.code == 2 && odd.err.contains("line 2, column 15: invalid type"), "{}", odd.err);
    assert!(odd.err.lines().count() == 1 && !odd.err.contains("u{a}"), "{}", odd.err);
    let good = corniche([&build[..], &["--attribution", "© 測量, 1:25 000"]].concat());
    assert_eq!(good.code, 0, "{}", good.err);
    assert_eq!(manifest(&package)["attribution"][0], "© 測量, 1:25 000");
}

#[test]
fn info_explains_its_words_and_names_the_classes() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let said = corniche(["info", text(&package)]).out;
    for words in [
        "  FRC 3 secondary",
        "FRC table: default",
        "\nWords:\n",
        "  quantum ",
        "  FRC ",
        "  uncovered ",
        "docs/conventions.md#terms",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
}
