//! The whole binary with several `--osm`: any order, lists and folders, shares, parts, settings
//! files, contradictions.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf::{BlockBuilder, plain_header, raw};
use e2e::{Ran, corniche, sample, text};
use serde_json::Value;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

/// Writes roads over the sample `pass`: way k from the west to the east, bent at a node that all
/// ways of the same tens share.
fn extract(path: &Path, ids: std::ops::RangeInclusive<i64>, lift: i64) {
    let (mut block, mut nodes) = (BlockBuilder::new(), BlockBuilder::new());
    let mut places = Vec::new();
    for id in ids {
        let lat = 468_800_000 + id * 12_000 + lift;
        let shared = 1000 + id / 10;
        places.push((2 * id, lat, 94_600_000));
        places.push((2 * id + 1, lat, 95_600_000));
        places.push((shared, 469_000_000 + shared * 100, 95_100_000));
        block.way(id, &[("highway", "secondary")], &[2 * id, shared, 2 * id + 1]);
    }
    places.sort_unstable();
    places.dedup();
    nodes.dense(&places);
    let data = [nodes, block].map(|block| raw(b"OSMData", &block.bytes()));
    fs::write(path, [plain_header(), data.concat()].concat()).unwrap();
}

fn counts(package: &Path) -> Value {
    let ran = succeed(corniche(["info", "--json", text(package)]));
    let info: Value = serde_json::from_str(&ran.out).unwrap();
    info["manifest"]["counts"].clone()
}

/// A folder of two overlapping extracts, and next to it an extract with all objects.
struct Files {
    folder: tempfile::TempDir,
}

impl Files {
    fn new() -> Self {
        let files = Self { folder: tempfile::tempdir().unwrap() };
        fs::create_dir(files.at("parts")).unwrap();
        extract(&files.at("parts/a.osm.pbf"), 1..=30, 0);
        extract(&files.at("parts/b.osm.pbf"), 21..=50, 0);
        extract(&files.at("whole.osm.pbf"), 1..=50, 0);
        files
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Builds with these extracts, named as given.
    fn build(&self, name: &str, osm: &[&str]) -> PathBuf {
        let (package, dem) = (self.at(name), sample("pass/pass-dem.tif"));
        let start = [
            "build",
            "-q",
            "-o",
            text(&package),
            "--dem",
            text(&dem),
            "--max-error",
            "20",
            "--osm",
        ];
        succeed(corniche([&start[..], osm].concat()));
        package
    }
}

#[test]
fn every_way_to_name_extracts_makes_the_same_package() {
    let files = Files::new();
    let [a, b, whole] =
        ["parts/a.osm.pbf", "parts/b.osm.pbf", "whole.osm.pbf"].map(|name| files.at(name));
    let two = files.build("two.pmtiles", &[text(&a), text(&b)]);
    let bytes = fs::read(&two).unwrap();
    let list = files.at("list.txt");
    fs::write(&list, "# both\nparts/b.osm.pbf\nparts/a.osm.pbf\n").unwrap();
    let (folder, pattern, listed) =
        (files.at("parts"), files.at("parts/*.pbf"), format!("@{}", text(&list)));
    for (name, osm) in [
        ("turned.pmtiles", &[text(&b), text(&a)][..]),
        ("repeated.pmtiles", &[text(&b), "--osm", text(&a), text(&b)]),
        ("folder.pmtiles", &[text(&folder)]),
        ("pattern.pmtiles", &[text(&pattern)]),
        ("list.pmtiles", &[&listed]),
    ] {
        assert!(fs::read(files.build(name, osm)).unwrap() == bytes, "{name}");
    }
    let whole = files.build("whole.pmtiles", &[text(&whole)]);
    assert_eq!(counts(&two), counts(&whole));
    let said = succeed(corniche(["info", text(&two)])).out;
    assert!(
        said.contains("input        osm a.osm.pbf") && said.contains("osm b.osm.pbf"),
        "{said}"
    );
    // verify, with the package after the extracts.
    succeed(corniche(["verify", "--osm", text(&b), text(&a), text(&two)]));
    let ran = corniche(["verify", text(&two), "--osm", text(&a)]);
    assert!(ran.code == 2 && ran.err.contains("b.osm.pbf"), "{}", ran.err);
    let ran = corniche(["plan", "--dem", text(&two), "--osm", text(&files.at("none"))]);
    assert_eq!(ran.code, 2, "{}", ran.err);
}

#[test]
fn parts_in_shares_and_resumed_builds_make_the_same_package() {
    let files = Files::new();
    let [a, b] = ["parts/a.osm.pbf", "parts/b.osm.pbf"].map(|name| files.at(name));
    let bytes = fs::read(files.build("two.pmtiles", &[text(&a), text(&b)])).unwrap();
    let (plan, config, store, merged) = (
        files.at("plan.json"),
        files.at("settings.toml"),
        files.at("store"),
        files.at("merged.pmtiles"),
    );
    let dem = sample("pass/pass-dem.tif");
    fs::write(
        &config,
        format!(
            "[inputs]\ndem = {:?}\nosm = [\"parts/b.osm.pbf\", \"parts/a.osm.pbf\"]\n[terrain]\nmax-error = 20.0\n",
            text(&dem)
        ),
    )
    .unwrap();
    let planned = ["plan", "--subtrees", "1", "-o", text(&plan), "--config", text(&config)];
    let subtrees = succeed(corniche(planned)).out;
    let part = |step: &str, more: &[&str]| {
        let command = ["part", text(&plan), "-q", "--store", text(&store), "--step", step];
        succeed(corniche([&command[..], more].concat()));
    };
    part("hashes", &[]);
    for step in ["ways", "nodes"] {
        for share in ["3/3", "1/3", "2/3"] {
            part(step, &["--share", share]);
        }
    }
    part("roads", &[]);
    subtrees.lines().for_each(|subtree| part("heights", &["--subtree", subtree]));
    part("top", &[]);
    subtrees.lines().for_each(|subtree| part("tiles", &["--subtree", subtree]));
    succeed(corniche(["merge", text(&plan), "-q", "--store", text(&store), "-o", text(&merged)]));
    assert!(fs::read(&merged).unwrap() == bytes, "shares make another package");
    // A change of any extract is detected.
    extract(&b, 22..=50, 0);
    let ran = corniche(["part", text(&plan), "-q", "--store", text(&store), "--step", "roads"]);
    assert!(ran.code == 2 && ran.err.contains("b.osm.pbf has changed"), "{}", ran.err);
}

#[test]
fn contradictions_are_counted_and_listed() {
    let files = Files::new();
    // In the second, the nodes of the common ways have other positions.
    let [a, b] = ["parts/a.osm.pbf", "parts/b.osm.pbf"].map(|name| files.at(name));
    extract(&b, 21..=50, 5);
    let (package, list, dem) =
        (files.at("a.pmtiles"), files.at("defects.csv"), sample("pass/pass-dem.tif"));
    succeed(corniche([
        "build",
        "-q",
        "-o",
        text(&package),
        "--defects",
        text(&list),
        "--dem",
        text(&dem),
        "--max-error",
        "20",
        "--osm",
        text(&b),
        text(&a),
    ]));
    let listed = fs::read_to_string(&list).unwrap();
    let conflicts = listed.lines().filter(|line| line.contains("conflicting node")).count();
    // Two ends of each of ten ways.
    assert_eq!(conflicts, 20, "{listed}");
    let found = counts(&package)["defects"].to_string();
    assert!(found.contains("conflicting node") && found.contains("20"), "{found}");
    // The first file decides; so it does under another name.
    let renamed = files.at("parts/z.osm.pbf");
    fs::rename(&a, &renamed).unwrap();
    let ran = corniche(["verify", text(&package), "-q", "--osm", text(&b), text(&renamed)]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
}
