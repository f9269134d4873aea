//! The treatment of plans, stores, settings and styles of newer and older versions: they are
//! rejected with both versions and with advice.
//!
//! Packages of other versions: `hostile_packages`, and the tests `version_2` of `tileset`. Newer
//! packages in older programs: `reader_of_before` of `pipeline`'s tests.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::fs;

use e2e::{copy_pass, corniche, sample, text};

#[test]
fn plans_of_other_versions_and_other_programs_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let (plan, store) = (file("plan.json"), file("store"));
    let dem = sample("pass/pass-dem.tif");
    let ran = corniche(["plan", "-q", "--dem", text(&dem), "-o", text(&plan)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let own = fs::read_to_string(&plan).unwrap();
    let program = concat!("corniche ", env!("CARGO_PKG_VERSION"));
    let cases = [
        (
            "\"plan_version\": 11",
            "\"plan_version\": 12",
            "has version 12, but this program reads version 11",
        ),
        (
            "\"plan_version\": 11",
            "\"plan_version\": 7",
            "has version 7, but this program reads version 11",
        ),
        (program, "corniche 99.0.0", "created by corniche 99.0.0"),
        ("\"libraries\": \"GDAL ", "\"libraries\": \"GDAL 9.9, not ", "GDAL 9.9"),
    ];
    for (there, other, words) in cases {
        assert!(own.contains(there), "the plan lacks {there}");
        fs::write(&plan, own.replace(there, other)).unwrap();
        let ran = corniche(["part", text(&plan), "--step", "hashes", "--store", text(&store)]);
        assert_eq!(ran.code, 2, "{other}: {}", ran.err);
        assert!(
            ran.err.contains(words) && ran.err.contains("create the plan again"),
            "{}",
            ran.err
        );
    }
}

#[test]
fn stores_of_other_versions_are_refused_with_the_folder_that_can_be_removed() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let (plan, store, package) = (file("plan.json"), file("store"), file("a.pmtiles"));
    let dem = sample("pass/pass-dem.tif");
    let ran = corniche(["plan", "-q", "--dem", text(&dem), "-o", text(&plan)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let hashes = ["part", text(&plan), "--step", "hashes", "--store", text(&store)];
    assert_eq!(corniche(hashes).code, 0);
    let own = fs::read(store.join("store")).unwrap();
    // A killed build leaves such a folder, too.
    let left = file(".a.pmtiles.work");
    fs::create_dir(&left).unwrap();
    fs::copy(store.join("plan.json"), left.join("plan.json")).unwrap();
    let build = ["build", "-q", "--max-error", "50", "--dem", text(&dem), "-o", text(&package)];
    let resumed: Vec<&str> = build.into_iter().chain(["--resume"]).collect();
    for version in [0, 2] {
        // The version without the checksum, because another version may have another checksum.
        let mut other = own.clone();
        other[8] = version;
        for (place, command) in [(&store, hashes.as_slice()), (&left, &resumed)] {
            fs::write(place.join("store"), &other).unwrap();
            let ran = corniche(command);
            assert_eq!(ran.code, 2, "{}", ran.err);
            let words = format!(
                "{place:?} was written by another version of Corniche (store format {version}, this version reads 1); use that version, or delete \
                 the store and start over (build: with -O)"
            );
            assert!(ran.err.contains(&words), "{}", ran.err);
        }
    }
    fs::remove_dir_all(&store).unwrap();
    assert_eq!(corniche(hashes).code, 0);
    let ran = corniche(build.into_iter().chain(["-O"]));
    assert_eq!((ran.code, left.exists()), (0, false), "{}", ran.err);
}

/// Texts of each kind with few of the existing keys, as an older program wrote them.
const OLDER_TEXTS: [(&str, &str); 4] = [
    ("settings.toml", "[terrain]\nmax-error = 50\n"),
    ("classes.toml", "name = \"own\"\nleast_class = 7\nnot_roads = []\n[classes]\nprimary = 1\n"),
    (
        "layer.toml",
        "id = \"own\"\ngeometry = \"area\"\n[[class]]\nid = \"wood\"\ntags = { natural = \"wood\" }\n",
    ),
    ("style.toml", "base = \"road-atlas\"\noutline_px = 1\n"),
];

#[test]
fn texts_that_a_program_does_not_know_are_refused_with_their_line_and_older_ones_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let (package, plan, drawn) = (file("a.pmtiles"), file("plan.json"), file("a.png"));
    copy_pass(&package, &["-q", "--max-error", "10"]);
    let (dem, osm) = (sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf"));
    let planned = ["plan", "-q", "-O", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&plan)];
    let drawing = ["render", text(&package), "--size", "16x16", "-O", "-o", text(&drawn)];
    let run = |name: &str| {
        let (command, option) = match name {
            "settings.toml" => (planned.as_slice(), "--config"),
            "classes.toml" => (planned.as_slice(), "--frc-table"),
            "layer.toml" => (planned.as_slice(), "--layers"),
            _ => (drawing.as_slice(), "--style"),
        };
        corniche(command.iter().copied().chain([option, text(&file(name))]))
    };
    for (name, older) in OLDER_TEXTS {
        fs::write(file(name), older).unwrap();
        let ran = run(name);
        // If nothing can draw, the style is read before that is detected.
        assert!(ran.code == 0 || (name == "style.toml" && ran.code == 1), "{name}: {}", ran.err);
        fs::write(file(name), format!("of-next-year = 1\n{older}")).unwrap();
        let ran = run(name);
        assert_eq!(ran.code, 2, "{name}: {}", ran.err);
        for words in [text(&file(name)), "line 1", "unknown field `of-next-year`, expected one of"]
        {
            assert!(ran.err.contains(words), "{name}: {}", ran.err);
        }
    }
}
