//! `corniche build --layers areas`: areas through the whole binary, for all ways to build a
//! package; losses; errors.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{collections::BTreeMap, fs, path::Path};

use e2e::{
    Job, Ran, When, built_in_parts, corniche, extract_with_areas, extract_with_coast, json, layer,
    manifest, objects, sample, text,
};
use serde_json::Value;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// Area of a polygon with its holes, square metres in plan.
fn area_m2(rings: &Value) -> f64 {
    let of_ring = |ring: &Value| -> f64 {
        let points: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum()
    };
    rings.as_array().unwrap().iter().map(of_ring).sum()
}

/// Areas of all tiles of each level by object, square metres; and the classes of the objects.
fn areas_of(package: &Path) -> BTreeMap<(u64, String), f64> {
    let found = json(&["info", text(package), "--json"]);
    let mut areas: BTreeMap<(u64, String), f64> = BTreeMap::new();
    for tile in found["tiles"].as_array().unwrap() {
        let id =
            tile.as_str().map_or_else(|| tile["id"].as_str().unwrap().to_owned(), str::to_owned);
        let level: u64 = id.split('/').next().unwrap().parse().unwrap();
        let tile = json(&["tile", text(package), &id, "--json"]);
        for area in objects(&tile, "areas") {
            let name = format!(
                "{} {} {}",
                area["object"].as_str().unwrap(),
                area["id"],
                area["class"].as_str().unwrap()
            );
            let parts = area["polygons"].as_array().unwrap();
            *areas.entry((level, name)).or_default() += parts.iter().map(area_m2).sum::<f64>();
        }
    }
    areas
}

#[test]
#[ignore = "slow: several builds of a country"]
fn areas_are_the_same_however_the_package_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_areas(folder.path()));
    let whole = at("whole.pmtiles");
    let inputs =
        ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10", "--layers", "areas"];
    let build = |package: &Path, inputs: &[&str], more: &[&str]| {
        succeed(corniche([&["build", "-q", "-o", text(package)], inputs, more].concat()));
        fs::read(package).unwrap()
    };
    let bytes = build(&whole, &inputs, &["--threads", "1", "--defects", text(&at("defects.csv"))]);
    succeed(corniche(["verify", text(&whole), "--dem", text(&dem), "--osm", text(&osm)]));

    // All read objects are either kept or lost, with their ids.
    let found = manifest(&whole);
    let counts = layer(&found, "areas");
    assert_eq!(counts["objects"], 4);
    let lost: Vec<&str> = counts["lost"]
        .as_array()
        .unwrap()
        .iter()
        .map(|lost| lost["reason"].as_str().unwrap())
        .collect();
    assert_eq!(lost, ["area way is not closed", "outline of an area crosses itself"]);
    let defects = fs::read_to_string(at("defects.csv")).unwrap();
    assert!(
        defects.contains("area way is not closed")
            && defects.contains("outline of an area crosses itself"),
        "{defects}"
    );
    let ran = succeed(corniche(["info", text(&whole)]));
    assert!(
        ran.out.contains("Layer areas: 4 objects of the extract, 2 of them converted"),
        "{}",
        ran.out
    );

    // Each level has both areas as a whole; the sides of a cell of the lattice are 382 by 445
    // metres there.
    let cell_m2 = 382.0 * 444.7;
    let areas = areas_of(&whole);
    let finest = areas.keys().map(|(level, _)| *level).max().unwrap();
    assert!(finest >= 2, "{areas:?}");
    for level in 0..=finest {
        for (name, cells) in [("way 2 water", 9.0), ("relation 7 forest", 32.0)] {
            let ratio = areas[&(level, name.to_owned())] / (cells * cell_m2);
            assert!((ratio - 1.0).abs() < 0.02, "{name} on level {level}: {ratio}");
        }
    }

    // Other threads and memory; onto recorded terrain; in parts.
    assert!(
        build(&at("again.pmtiles"), &inputs, &["--threads", "3", "--memory", "600M"]) == bytes,
        "threads"
    );
    let plain = at("plain.pmtiles");
    build(&plain, &inputs[..6], &[]);
    assert!(manifest(&plain).get("layers").is_none());
    let onto = ["--terrain", text(&plain), "--osm", text(&osm), "--layers", "areas"];
    assert!(build(&at("onto.pmtiles"), &onto, &[]) == bytes, "onto recorded terrain");
    let without = ["--terrain", text(&whole), "--osm", text(&osm)];
    assert!(
        build(&at("without.pmtiles"), &without, &[]) == fs::read(&plain).unwrap(),
        "areas are left out"
    );
    assert!(built_in_parts(folder.path(), &inputs) == bytes, "in parts");
}

#[test]
#[ignore = "slow: several builds of a country"]
fn a_build_with_areas_that_was_stopped_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = || [sample("pass/pass-dem.tif"), extract_with_areas(folder.path())];
    let options = ["--max-error", "0.25", "--layers", "areas"];
    let whole = Job::new(&options).with_inputs(inputs());
    whole.succeed(&["--quiet"]);
    for signal in ["TERM", "KILL"] {
        let job = Job::new(&options).with_inputs(inputs());
        let stopped = job.stop(&[], signal, When::Worked);
        assert_ne!(stopped.code, 0, "{signal}: it ended by itself");
        job.succeed(&["--quiet", "--resume"]);
        assert!(job.result() == whole.result(), "{signal}");
    }
}

#[test]
fn tables_that_are_none_and_areas_without_an_extract_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (package, table) = (folder.path().join("out.pmtiles"), folder.path().join("table.toml"));
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_areas(folder.path()));
    let refused = |options: &[&str]| {
        let ran = corniche(
            [&["build", "-q", "--dem", text(&dem), "-o", text(&package)], options].concat(),
        );
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(!package.exists());
        ran.err
    };
    assert!(
        refused(&["--layers", "areas"]).contains("--layers needs an extract; pass one with --osm")
    );
    let no_table = refused(&["--osm", text(&osm), "--layers", "nothing"]);
    for words in ["\"nothing\"", "(areas, boundaries, railways, waterways, ", "readable file"] {
        assert!(no_table.contains(words), "{no_table}");
    }

    // A custom table next to a settings file that names it.
    let text_of_table =
        "id = 'own'\ngeometry = 'area'\n[[class]]\nid = 'pond'\ntags = { natural = 'water' }\n";
    fs::write(&table, text_of_table).unwrap();
    let settings = folder.path().join("settings.toml");
    fs::write(&settings, "[layers]\nlayers = 'table.toml'\n").unwrap();
    let ran = corniche([
        "build",
        "-q",
        "--dem",
        text(&dem),
        "--osm",
        text(&osm),
        "-o",
        text(&package),
        "--max-error",
        "10",
        "--config",
        text(&settings),
    ]);
    succeed(ran);
    let found = manifest(&package);
    assert_eq!(found["settings"]["layers"][0]["id"], "own");
    assert_eq!(e2e::kept(layer(&found, "own")), [("pond", 1)]);
}

/// When new roads are built onto existing terrain without `--layers`, the missing layers are
/// reported.
#[test]
fn areas_that_are_not_asked_for_again_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_areas(folder.path()));
    let old = at("old.pmtiles");
    let words = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let words = [&["build", "-q", "-o", text(&old)], &words[..], &["--layers", "areas"]].concat();
    succeed(corniche(words));
    let again = |more: &[&str]| {
        let new = at("new.pmtiles");
        let words = ["build", "-q", "--terrain", text(&old), "--osm", text(&osm), "-O", "-o"];
        succeed(corniche([&words[..], &[text(&new)], more].concat())).err
    };
    let said = again(&[]);
    assert!(said.contains("--layers is none, but it was built with areas ("), "{said}");
    let said = again(&["--layers", "areas"]);
    assert!(!said.contains("settings that differ"), "{said}");
}

/// Sea in the south of a coast, with an island, within bounds; and the same coast without one of
/// its ways.
#[test]
fn the_sea_is_closed_along_the_edge_and_ends_at_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let dem = sample("pass/pass-dem.tif");
    // The sides of 0.005 by 0.004 degrees are 382 by 445 metres there. The data end at 46.86234
    // degrees, 0.59 of such a side north of the bounds.
    let expected_m2 = (12.0 * (10.0 - 0.59) - 4.0 * 2.5) * 382.0 * 444.7;
    for (is_whole, open_ends) in [(true, 0), (false, 2)] {
        let osm = extract_with_coast(folder.path(), is_whole);
        let package = folder.path().join("coast.pmtiles");
        let words = ["build", "-q", "-O", "--dem", text(&dem), "--osm", text(&osm), "-o"];
        let more = ["--layers", "areas", "--bounds", "9.5,46.86,9.56,46.92", "--max-error", "10"];
        succeed(corniche([&words[..], &[text(&package)], &more].concat()));
        let areas = areas_of(&package);
        let finest = areas.keys().map(|(level, _)| *level).max().unwrap();
        for level in 0..=finest {
            let ratio = areas[&(level, "way 0 sea".to_owned())] / expected_m2;
            assert!((ratio - 1.0).abs() < 0.02, "level {level}: {ratio}");
        }
        let manifest = manifest(&package);
        assert_eq!(e2e::kept(layer(&manifest, "areas")), [("sea", 1)]);
        let said = manifest["counts"]["defects"].to_string();
        let told = format!(r#"{{"count":{open_ends},"name":"open end of a coastline"}}"#);
        assert_eq!(said.contains(&told), open_ends > 0, "{said}");
        succeed(corniche(["verify", text(&package), "--osm", text(&osm), "-q"]));
    }
}
