//! A settings file can describe a whole build: inputs, settings and outputs.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, process::Command};

use e2e::{Ran, binary, build_pass, corniche, root, sample, text};

#[test]
fn a_settings_file_alone_makes_the_same_package() {
    let folder = tempfile::tempdir().unwrap();
    let (maps, elsewhere) = (folder.path().join("maps"), folder.path().join("elsewhere"));
    for place in [&maps.join("in"), &elsewhere] {
        fs::create_dir_all(place).unwrap();
    }
    for name in ["pass-dem.tif", "pass.osm.pbf"] {
        fs::copy(sample(&format!("pass/{name}")), maps.join("in").join(name)).unwrap();
    }
    let table = root().join("config/frc/valhalla.toml");
    fs::copy(table, maps.join("mine.toml")).unwrap();
    let settings = maps.join("build.toml");
    fs::write(
        &settings,
        "[inputs]\ndem = \"in/pass-dem.tif\"\nosm = \"in/pass.osm.pbf\"\n[output]\npackage = \"made.pmtiles\"\n\
         defects = \"defects.csv\"\n[terrain]\nmax-error = 10\nattribution = [\"Survey\"]\n[roads]\nfrc-table = \"mine.toml\"\n\
         [resources]\nmemory = \"0.5G\"\ntmp = \"work\"\n",
    )
    .unwrap();
    fs::create_dir(maps.join("work")).unwrap();
    let run = |arguments: &[&str]| -> Ran {
        Command::new(binary()).args(arguments).current_dir(&elsewhere).output().unwrap().into()
    };
    let ran = run(&["build", "--config", text(&settings), "-q"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let made = fs::read(maps.join("made.pmtiles")).unwrap();
    assert!(fs::read_to_string(maps.join("defects.csv")).unwrap().lines().count() > 1);
    assert_eq!(fs::read_dir(&elsewhere).unwrap().count(), 0);

    // The same as options.
    let package = folder.path().join("options.pmtiles");
    let mine = maps.join("mine.toml");
    build_pass(
        &package,
        &["-q", "--max-error", "10", "--attribution", "Survey", "--frc-table", text(&mine)],
    );
    assert!(fs::read(&package).unwrap() == made, "the packages differ");

    // The command line takes precedence, file by file; -O and errors are the same as without a
    // settings file.
    let ran = run(&["build", "--config", text(&settings), "-q"]);
    assert!(ran.code == 3 && ran.err.contains(text(&maps)), "{}", ran.err);
    let ran = run(&[
        "build",
        "--config",
        text(&settings),
        "-q",
        "-o",
        "other.pmtiles",
        "--defects",
        "other.csv",
        "--max-error",
        "20",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read(elsewhere.join("other.pmtiles")).unwrap() != made);
    assert!(run(&["plan", "--config", text(&settings)]).out.contains("max error"));
    let ran = run(&["build", "--config", text(&settings), "-O", "-q", "--dem", "/nowhere.tif"]);
    assert!(ran.code == 2 && ran.err.contains("/nowhere.tif"), "{}", ran.err);
    assert_eq!(fs::read(maps.join("made.pmtiles")).unwrap(), made);
    // Terrain from the built package: --terrain replaces the dem of the settings file.
    let old = maps.join("made.pmtiles");
    let ran = run(&[
        "build",
        "--config",
        text(&settings),
        "-q",
        "--terrain",
        text(&old),
        "-o",
        "again.pmtiles",
        "--defects",
        "again.csv",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(fs::read(elsewhere.join("again.pmtiles")).unwrap() == made, "the packages differ");
}

#[test]
fn a_settings_file_that_lacks_something_says_what() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("build.toml");
    let dem = sample("pass/pass-dem.tif");
    let package = folder.path().join("a.pmtiles");
    for (content, more, word) in [
        ("[terrain]\nmax-error = 10\n", &["-o", text(&package)][..], "dem under [inputs]"),
        ("[terrain]\nmax-error = 10\n", &["--dem", text(&dem)], "package under [output]"),
        (
            "[inputs]\ndem = \"a.tif\"\nterrain = \"b.pmtiles\"\n",
            &["-o", text(&package)],
            "remove the other",
        ),
        ("[output]\ndefects = \"a.csv\"\n", &["--dem", text(&dem), "-o", text(&package)], "--osm"),
        ("[output]\npackage = \"a.tif\"\n", &["--dem", text(&dem)], "a.tif.pmtiles"),
        ("[inputs]\nraster = \"a.tif\"\n", &["-o", text(&package)], "raster"),
    ] {
        fs::write(&settings, content).unwrap();
        let ran = corniche([&["build", "--config", text(&settings)], more].concat());
        assert_eq!(ran.code, 2, "{content}: {}", ran.err);
        assert!(ran.err.contains(word), "{content}: {}", ran.err);
        assert!(!package.exists());
    }
}
