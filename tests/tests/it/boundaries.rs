//! `corniche build --layers boundaries`: boundaries through the whole binary, for all ways to build
//! a package; losses; errors.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{
    Job, Ran, When, built_in_parts, corniche, extract_with_boundaries, kept, lacks_adapter, layer,
    manifest, sample, text,
};

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

#[test]
#[ignore = "slow: several builds of a country"]
fn boundaries_are_the_same_however_the_package_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_boundaries(folder.path()));
    let whole = at("whole.pmtiles");
    let inputs =
        ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10", "--layers", "boundaries"];
    let build = |package: &Path, inputs: &[&str], more: &[&str]| {
        succeed(corniche([&["build", "-q", "-o", text(package)], inputs, more].concat()));
        fs::read(package).unwrap()
    };
    let bytes = build(&whole, &inputs, &["--threads", "1", "--defects", text(&at("defects.csv"))]);
    let ran = succeed(corniche(["verify", text(&whole), "--dem", text(&dem), "--osm", text(&osm)]));
    assert!(!ran.out.contains("broken"), "{}", ran.out);

    // All read ways are either kept or lost, with their ids.
    let found = manifest(&whole);
    let found = layer(&found, "boundaries");
    assert_eq!(found["objects"], 4);
    assert_eq!(kept(found), [("admin-2", 1), ("admin-6", 1), ("protected", 1)]);
    assert_eq!(found["lost"][0]["reason"], "way of a line is missing");
    let defects = fs::read_to_string(at("defects.csv")).unwrap();
    // It is in the neighbouring country, which is not a defect of the extract.
    assert!(!defects.contains("way of a line"), "{defects}");
    let ran = succeed(corniche(["info", text(&whole)]));
    assert!(
        ran.out.contains("Layer boundaries: 4 ways of the extract, 3 of them converted"),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("  ways missing from the extract: 1\n"), "{}", ran.out);
    assert!(!ran.out.contains("defect: way of a line"), "{}", ran.out);
    // 5 by 4 steps of the lattice of nodes and so on: 382 by 445 metres each.
    let length_km = found["kept"][0]["length_um"].as_f64().unwrap() / 1e9;
    let expected_km = (3.0_f64 * 0.382).hypot(2.0 * 0.4447) + (4.0_f64 * 0.382).hypot(0.4447);
    assert!((length_km / expected_km - 1.0).abs() < 0.01, "{length_km} and {expected_km} km");

    // Other threads and memory; onto recorded terrain; left out; in parts.
    let again = build(&at("again.pmtiles"), &inputs, &["--threads", "3", "--memory", "600M"]);
    assert!(again == bytes, "threads");
    let plain = at("plain.pmtiles");
    let plain_bytes = build(&plain, &inputs[..6], &[]);
    assert!(manifest(&plain).get("layers").is_none());
    let none = build(&at("none.pmtiles"), &inputs[..6], &["--layers", "none"]);
    assert!(none == plain_bytes, "none is what is usual");
    let onto = ["--terrain", text(&plain), "--osm", text(&osm), "--layers", "boundaries"];
    assert!(build(&at("onto.pmtiles"), &onto, &[]) == bytes, "onto recorded terrain");
    let without = ["--terrain", text(&whole), "--osm", text(&osm)];
    assert!(build(&at("without.pmtiles"), &without, &[]) == plain_bytes, "left out");
    assert!(built_in_parts(folder.path(), &inputs) == bytes, "in parts");
}

#[test]
#[ignore = "slow: several builds of a country"]
fn a_build_with_boundaries_that_was_stopped_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = || [sample("pass/pass-dem.tif"), extract_with_boundaries(folder.path())];
    let options = ["--max-error", "0.25", "--layers", "boundaries"];
    let whole = Job::new(&options).with_inputs(inputs());
    whole.succeed(&["--quiet"]);
    let job = Job::new(&options).with_inputs(inputs());
    let stopped = job.stop(&[], "KILL", When::Worked);
    assert_ne!(stopped.code, 0, "it ended by itself");
    job.succeed(&["--quiet", "--resume"]);
    assert!(job.result() == whole.result());
}

#[test]
fn they_are_drawn_by_both_methods_and_can_be_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let osm = extract_with_boundaries(folder.path());
    let dem = sample("pass/pass-dem.tif");
    let package = at("package.pmtiles");
    let words = ["build", "-q", "-o", text(&package), "--dem", text(&dem), "--osm", text(&osm)];
    succeed(corniche([&words[..], &["--max-error", "5", "--layers", "boundaries"]].concat()));
    let render = |name: &str, more: &[&str]| {
        let picture = at(name);
        let words = ["render", text(&package), "-o", text(&picture), "--size", "500x400"];
        let view = ["--look-at", "9.525,46.885", "--distance", "6000", "--pitch", "40"];
        let ran = corniche([&words[..], &view, more].concat());
        (!lacks_adapter(&ran)).then(|| {
            succeed(ran);
            image::open(picture).unwrap().to_rgba8()
        })
    };
    let Some(geo) = render("geo.png", &["--roads", "geo"]) else { return };
    let sv = render("sv.png", &["--roads", "sv"]).unwrap();
    let without = render("without.png", &["--roads", "sv", "--layers", "none"]).unwrap();
    let differ = |one: &image::RgbaImage, other: &image::RgbaImage| {
        one.pixels().zip(other.pixels()).filter(|(a, b)| a != b).count()
    };
    assert!(differ(&sv, &without) > 1000, "{} pixels", differ(&sv, &without));
    assert!(differ(&geo, &sv) * 20 < differ(&sv, &without), "{} pixels", differ(&geo, &sv));

    // Where there is a road, no boundary is drawn.
    let bare = render("bare.png", &["--roads", "none", "--layers", "none"]).unwrap();
    let alone = render("alone.png", &["--roads", "none"]).unwrap();
    let on_roads = |with: &image::RgbaImage, plain: &image::RgbaImage| {
        let roads = without.pixels().zip(bare.pixels()).map(|(a, b)| a != b);
        let lines = with.pixels().zip(plain.pixels()).map(|(a, b)| a != b);
        roads.zip(lines).filter(|both| *both == (true, true)).count()
    };
    let (crossing, drawn) = (on_roads(&alone, &bare), on_roads(&sv, &without));
    println!("boundaries on roads: {crossing} pixels without roads, {drawn} with them");
    assert!(crossing > 20 && drawn * 10 < crossing, "{drawn} of {crossing} pixels");
}

#[test]
fn bounds_leave_out_what_is_far_and_an_extract_is_needed() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let osm = extract_with_boundaries(folder.path());
    let dem = sample("pass/pass-dem.tif");
    let (whole, part) = (at("whole.pmtiles"), at("part.pmtiles"));
    let build = |package: &Path, more: &[&str]| {
        let words = ["build", "-q", "-o", text(package), "--dem", text(&dem), "--max-error", "5"];
        corniche([&words[..], more].concat())
    };
    let from_extract = ["--osm", text(&osm), "--layers", "boundaries"];
    succeed(build(&whole, &from_extract));
    let bounds = ["--bounds", "9.505,46.875,9.52,46.885"];
    succeed(build(&part, &[&from_extract[..], &bounds].concat()));
    succeed(corniche(["verify", text(&part), "--osm", text(&osm)]));
    let points = |package: &Path| {
        let levels = layer(&manifest(package), "boundaries")["levels"].clone();
        let finest = levels.as_array().unwrap().last().unwrap().clone();
        finest["points"].as_u64().unwrap()
    };
    assert!(points(&part) < points(&whole), "{} and {}", points(&part), points(&whole));
    let refused = build(&at("none.pmtiles"), &["--layers", "boundaries"]);
    assert_eq!(refused.code, 2);
    assert!(refused.err.contains("pass one with --osm"), "{}", refused.err);
}
