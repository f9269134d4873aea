//! Selections of inputs: a region (`--bounds`), some classes (`--classes`), files by folder,
//! pattern, list and archive (`--dem`).

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{Ran, corniche, real_data, sample, text};
use serde_json::Value;

/// Some five by four kilometres in the centre of the sample `pass`.
const BOUNDS: &str = "9.47,46.885,9.53,46.92";

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

fn inputs() -> Vec<String> {
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"].map(str::to_owned).to_vec()
}

fn with<'a>(command: &[&'a str], inputs: &'a [String], rest: &[&'a str]) -> Vec<&'a str> {
    let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
    [command, &inputs, rest].concat()
}

fn manifest(package: &Path) -> Value {
    let ran = succeed(corniche(["info", "--json", text(package)]));
    let info: Value = serde_json::from_str(&ran.out).unwrap();
    info["manifest"].clone()
}

#[test]
fn parts_resumed_builds_and_settings_files_make_the_package_of_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (inputs, whole, part) = (inputs(), at("whole.pmtiles"), at("part.pmtiles"));
    let list = at("defects.csv");
    succeed(corniche(with(&["build", "-q", "-o", text(&whole)], &inputs, &[])));
    let options = ["--bounds", BOUNDS, "--defects", text(&list)];
    succeed(corniche(with(&["build", "-q", "-o", text(&part)], &inputs, &options)));
    let bytes = fs::read(&part).unwrap();
    assert!(bytes.len() < fs::read(&whole).unwrap().len() / 2);
    let said = succeed(corniche(["info", text(&part)])).out;
    assert!(said.contains("9.47 46.885 9.53 46.92"), "{said}");
    assert!(said.contains("lost outside the requested bounds"), "{said}");
    assert!(!fs::read_to_string(&list).unwrap().contains("bounds"));
    let counts = &manifest(&part)["counts"];
    let lost: u64 = counts["roads_lost"]
        .as_array()
        .unwrap()
        .iter()
        .map(|loss| loss["length_um"].as_u64().unwrap())
        .sum();
    assert_eq!(
        counts["roads_kept_um"].as_u64().unwrap() + lost,
        counts["roads_in_um"].as_u64().unwrap()
    );

    // In parts, with the bounds in a settings file.
    let (plan, config, store, merged) =
        (at("plan.json"), at("settings.toml"), at("store"), at("merged.pmtiles"));
    fs::write(&config, format!("[terrain]\nbounds = [{BOUNDS}]\n")).unwrap();
    let planned = with(
        &["plan", "--subtrees", "1", "-o", text(&plan), "--config", text(&config)],
        &inputs,
        &[],
    );
    let subtrees = succeed(corniche(planned)).out;
    let one = |step: &str, subtree: Option<&str>| {
        let mut command = vec!["part", text(&plan), "-q", "--store", text(&store), "--step", step];
        command.extend(subtree.into_iter().flat_map(|subtree| ["--subtree", subtree]));
        succeed(corniche(command));
    };
    one("hashes", None);
    one("roads", None);
    subtrees.lines().for_each(|subtree| one("heights", Some(subtree)));
    one("top", None);
    subtrees.lines().for_each(|subtree| one("tiles", Some(subtree)));
    succeed(corniche(["merge", text(&plan), "-q", "--store", text(&store), "-o", text(&merged)]));
    assert!(fs::read(&merged).unwrap() == bytes, "parts make another package");

    // Roads of the same extract on the terrain of the package: its bounds are the default.
    let again = at("again.pmtiles");
    let osm = sample("pass/pass.osm.pbf");
    let taken = ["build", "-q", "-o", text(&again), "--terrain", text(&part), "--osm", text(&osm)];
    succeed(corniche(taken));
    assert!(fs::read(&again).unwrap() == bytes, "the terrain of a package makes another one");
    let refused = corniche([&taken[..], &["-O", "--bounds", "9.4,46.88,9.5,46.9"]].concat());
    assert_eq!(refused.code, 2);
    assert!(refused.err.contains("--bounds is 9.4,46.88,9.5,46.9"), "{}", refused.err);

    let checked = with(&["verify", text(&part)], &inputs[..4], &[]);
    succeed(corniche(checked));
}

#[test]
fn wrong_bounds_are_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("package.pmtiles");
    let inputs = inputs();
    for (bounds, words) in [
        ("9.47,46.9", "west,south,east,north"),
        ("9.47,46.92,9.53,46.885", "south must be less"),
        ("10,50,11,51", "contains no cell of the elevation data"),
        ("osm", "has no bounding box"),
    ] {
        let ran =
            corniche(with(&["build", "-q", "-o", text(&package)], &inputs, &["--bounds", bounds]));
        assert_eq!(ran.code, 2, "{bounds}: {}", ran.err);
        assert!(ran.err.contains(words), "{bounds}: {}", ran.err);
    }
    let ran =
        corniche(with(&["build", "-q", "-o", text(&package)], &inputs[..2], &["--bounds", "osm"]));
    assert!(ran.code == 2 && ran.err.contains("pass one with --osm"), "{}", ran.err);
    assert!(!package.exists());
}

#[test]
fn bounds_of_an_extract_are_those_of_its_header() {
    let Some(osm) = real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf") else { return };
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let ran =
        corniche(["plan", "--dem", text(&dem), "--osm", text(&osm), "--bounds", "osm", "--json"]);
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.json");
    assert_eq!(ran.code, 0, "{}", ran.err);
    succeed(corniche([
        "plan",
        "--dem",
        text(&dem),
        "--osm",
        text(&osm),
        "--bounds",
        "osm",
        "-o",
        text(&plan),
    ]));
    let plan: Value = serde_json::from_str(&fs::read_to_string(plan).unwrap()).unwrap();
    let bounds: Vec<f64> = serde_json::from_value(plan["settings"]["bounds_deg"].clone()).unwrap();
    // The header says 9.471 47.048 9.636 47.271, extended by 1 %.
    for (found, wanted) in bounds.iter().zip([9.469, 47.0457, 9.638, 47.2733]) {
        assert!((found - wanted).abs() < 1e-3, "{bounds:?}");
    }
}

#[test]
fn classes_that_are_chosen_become_roads_and_the_others_have_a_length() {
    let Some(osm) = real_data("liechtenstein/liechtenstein-2013-08-03.osm.pbf") else { return };
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let folder = tempfile::tempdir().unwrap();
    let bounds = ["--bounds", "9.5,47.12,9.56,47.17", "--max-error", "60"];
    let build = |name: &str, options: &[&str]| {
        let package = folder.path().join(name);
        let inputs =
            ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
        succeed(corniche([&inputs[..], &bounds, options].concat()));
        package
    };
    let (usual, all, some) = (
        build("usual.pmtiles", &[]),
        build("all.pmtiles", &["--classes", "0-8"]),
        build("some.pmtiles", &["--classes", "2,8"]),
    );
    let counts = [&usual, &all, &some].map(|package| manifest(package)["counts"].clone());
    let roads = |counts: &Value, class: usize| counts["classes"][class]["roads"].as_u64().unwrap();
    let left_out = |counts: &Value, reason: &str| -> [u64; 2] {
        let all = counts["left_out"].as_array().unwrap().iter();
        let found = all.filter(|left_out| left_out["reason"] == reason);
        let add = |sums: [u64; 2], left_out: &Value| {
            [
                sums[0] + left_out["ways"].as_u64().unwrap(),
                sums[1] + left_out["length_um"].as_u64().unwrap(),
            ]
        };
        found.fold([0; 2], add)
    };
    assert_eq!((roads(&counts[0], 8), left_out(&counts[1], "class is off")), (0, [0, 0]));
    // The ways that the default classes skip become roads with all classes: the same number, and
    // the same length (measured in two ways).
    let [ways, length_um] = left_out(&counts[0], "class is off");
    let length_of =
        |counts: &Value, class: usize| counts["classes"][class]["length_um"].as_u64().unwrap();
    assert!(ways > 500 && roads(&counts[1], 8).abs_diff(ways) <= ways / 100, "{ways}");
    let off = length_of(&counts[1], 8).abs_diff(length_um) as f64 / length_um as f64;
    assert!(off < 1e-4, "{off}");
    for class in 0..9 {
        let wanted = if [2, 8].contains(&class) { roads(&counts[1], class) } else { 0 };
        assert_eq!(roads(&counts[2], class), wanted, "class {class}");
    }
    let said = succeed(corniche(["info", text(&usual)])).out;
    assert!(said.contains("    highway=footway: ") && said.contains(" km"), "{said}");
    // The extract is read again with the classes of the package.
    succeed(corniche(["verify", text(&some), "--osm", text(&osm)]));
    // They are settings of the build.
    let plan = |name: &str, options: &[&str]| {
        let path = folder.path().join(name);
        let inputs = ["plan", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&path)];
        succeed(corniche([&inputs[..], options].concat()));
        path
    };
    let store = folder.path().join("store");
    let part = |plan: &Path| {
        corniche(["part", text(plan), "-q", "--store", text(&store), "--step", "hashes"])
    };
    succeed(part(&plan("a.json", &["--classes", "0-8"])));
    // Classes by name are the same classes.
    let other = part(&plan("b.json", &["--classes", "motorway,trunk"]));
    assert!(other.code == 2 && other.err.contains("--classes is 0, 1"), "{}", other.err);
    let wrong = corniche(["plan", "--dem", text(&dem), "--classes", "0-9"]);
    assert!(wrong.code == 2 && wrong.err.contains("0 to 8"), "{}", wrong.err);
}

#[test]
fn elevation_files_are_named_by_folder_pattern_and_list() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem");
    fs::create_dir(&dem).unwrap();
    fs::copy(sample("pass/pass-dem.tif"), dem.join("pass.tif")).unwrap();
    fs::write(dem.join("notes.txt"), "no raster").unwrap();
    let list = folder.path().join("list.txt");
    fs::write(&list, "# one\ndem/pass.tif\n").unwrap();
    let listed = format!("@{}", text(&list));
    let pattern = dem.join("p*.tif");
    let plan = |name: &str, dem: &str| {
        let path = folder.path().join(name);
        succeed(corniche(["plan", "--dem", dem, "-o", text(&path)]));
        fs::read(path).unwrap()
    };
    let plain = plan("plain.json", text(&dem.join("pass.tif")));
    for (name, dem) in
        [("folder.json", text(&dem)), ("pattern.json", text(&pattern)), ("list.json", &listed)]
    {
        assert!(plan(name, dem) == plain, "{name}: another plan");
    }
    let empty = folder.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let ran = corniche(["plan", "--dem", text(&empty)]);
    assert!(ran.code == 2 && ran.err.contains("contains no elevation file"), "{}", ran.err);
}
