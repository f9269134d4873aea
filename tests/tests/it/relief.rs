//! `corniche build --relief`: the levels that have a relief, its size, and that packages with and
//! without it keep their promises.

use std::{fs, path::Path};

use e2e::{build_pass, corniche, json, sample, text};

/// Stored bytes of reliefs, by level.
#[expect(clippy::unwrap_used, reason = "a helper of tests")]
fn relief_bytes(package: &Path) -> Vec<u64> {
    let levels = json(&["info", text(package), "--json"])["manifest"]["levels"].clone();
    let levels = levels.as_array().unwrap().clone();
    levels.iter().map(|level| level["relief_bytes"].as_u64().unwrap()).collect()
}

#[test]
fn each_choice_is_built_told_and_verified() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let dem = sample("pass/pass-dem.tif");
    let mut bytes = Vec::new();
    for choice in ["off", "finest", "full"] {
        let package = at(choice);
        let package = package.with_extension("pmtiles");
        build_pass(&package, &["--quiet", "--relief", choice]);
        let by_level = relief_bytes(&package);
        let has: Vec<bool> = by_level.iter().map(|&bytes| bytes > 0).collect();
        let last = has.len() - 1;
        let wanted = |level| choice == "full" || (choice == "finest" && level == last);
        assert_eq!(has, (0..=last).map(wanted).collect::<Vec<_>>(), "{choice}");
        let ran = corniche(["verify", text(&package), "--dem", text(&dem)]);
        assert_eq!(ran.code, 0, "{choice}: {}{}", ran.out, ran.err);
        bytes.push(by_level.iter().sum::<u64>());
    }
    // Each coarser level has a quarter of the tiles.
    assert!(bytes[1] < bytes[2] && bytes[2] < 2 * bytes[1], "{bytes:?}");
    // Without the option, all levels have a relief.
    build_pass(&at("usual.pmtiles"), &["--quiet"]);
    assert!(fs::read(at("usual.pmtiles")).unwrap() == fs::read(at("full.pmtiles")).unwrap());
    let ran = corniche(["info", text(&at("off.pmtiles"))]);
    assert!(ran.out.contains("relief"), "{}", ran.out);
}

#[test]
fn terrain_of_a_package_comes_with_its_relief_or_without_but_not_with_another() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let osm = sample("pass/pass.osm.pbf");
    build_pass(&at("full.pmtiles"), &["--quiet"]);
    build_pass(&at("off.pmtiles"), &["--quiet", "--relief", "off"]);
    let build = |from: &str, to: &str, options: &[&str]| {
        let (from, to) = (at(from), at(to));
        let begin = ["build", "--terrain", text(&from), "--osm", text(&osm), "-q", "-o", text(&to)];
        corniche(begin.iter().chain(options))
    };
    for (from, options, wanted) in [
        ("full.pmtiles", &[][..], "full.pmtiles"),
        ("full.pmtiles", &["--relief", "full"], "full.pmtiles"),
        ("full.pmtiles", &["--relief", "off"], "off.pmtiles"),
        ("off.pmtiles", &[], "off.pmtiles"),
    ] {
        let ran = build(from, "new.pmtiles", options);
        assert_eq!(ran.code, 0, "{from} {options:?}: {}", ran.err);
        let new = fs::read(at("new.pmtiles")).unwrap();
        assert!(new == fs::read(at(wanted)).unwrap(), "{from} {options:?}");
        fs::remove_file(at("new.pmtiles")).unwrap();
    }
    for (from, asked, has) in [
        ("off.pmtiles", "full", "off"),
        ("off.pmtiles", "finest", "off"),
        ("full.pmtiles", "finest", "full"),
    ] {
        let ran = build(from, "new.pmtiles", &["--relief", asked]);
        assert_eq!(ran.code, 2, "{}", ran.err);
        let said = format!("--relief is {asked}, but it was built with {has}");
        assert!(ran.err.contains(&said), "{}", ran.err);
        assert!(!at("new.pmtiles").exists());
    }
    let ran = build("full.pmtiles", "new.pmtiles", &["--relief", "half"]);
    assert!(ran.code == 2 && ran.err.contains("off, finest, full"), "{}", ran.err);
}
