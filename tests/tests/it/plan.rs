//! `corniche plan`, and builds with too few resources.

use std::{fs, path::Path};

use corniche_testing::Raster;
use e2e::{build_pass, corniche, json, manifest, sample, text};
use serde_json::Value;

/// The arguments of a plan of the `pass` sample.
fn pass() -> [String; 5] {
    let [dem, osm] = [sample("pass/pass-dem.tif"), sample("pass/pass.osm.pbf")];
    ["plan", "--dem", text(&dem), "--osm", text(&osm)].map(str::to_owned)
}

fn plan(options: &[&str]) -> e2e::Ran {
    let pass = pass();
    corniche(pass.iter().map(String::as_str).chain(options.iter().copied()))
}

#[test]
fn the_plan_has_as_many_tiles_on_each_level_as_the_package() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    build_pass(&package, &["--quiet"]);
    let manifest = manifest(&package);
    let ran = plan(&["--json"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let planned: Value = serde_json::from_str(&ran.out).unwrap();
    let estimate = &planned["estimate"];
    let levels = manifest["levels"].as_array().unwrap();
    let built: Vec<&Value> = levels.iter().map(|level| &level["tiles"]).collect();
    let tiles: Vec<&Value> = estimate["tiles"].as_array().unwrap().iter().collect();
    assert_eq!(tiles, built);
    assert_eq!(estimate["nodes"], manifest["counts"]["samples"]["nodes"]);
    assert_eq!(planned["plan_sha256"].as_str().unwrap().len(), 64);
}

#[test]
fn a_plan_is_printed_and_written_and_never_replaced_unasked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.json");
    let write = ["-o", text(&file)];
    let ran = plan(&write);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for part in ["tiles", "memory", "intermediate results", "time", "from recorded rates"] {
        assert!(ran.out.contains(part), "{part}: {}", ran.out);
    }
    let written = fs::read_to_string(&file).unwrap();
    let value: Value = serde_json::from_str(&written).unwrap();
    let dem = sample("pass/pass-dem.tif");
    assert_eq!(value["inputs"][0]["path"], text(&dem));
    assert_eq!(value["inputs"][0]["bytes"], fs::metadata(&dem).unwrap().len());

    let ran = plan(&write);
    assert_eq!(ran.code, 3, "{}", ran.err);
    let ran = plan(&[&write[..], &["-O", "--max-error", "20"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_ne!(fs::read_to_string(&file).unwrap(), written);
    let ran = plan(&[&write[..], &["-O", "--max-error", "-1"]].concat());
    assert_eq!(ran.code, 2, "{}", ran.err);
    let ran = corniche(["plan", "--dem", text(&folder.path().join("none.tif"))]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    let input = ["plan", "--dem", text(&dem), "-O", "-o", text(&dem)];
    assert_eq!(corniche(input).code, 2);
}

/// Without `--max-error` the bound is a 16th of the cell's shorter side, for cells of 1 to 4 m it
/// is 0.25 m, and for smaller ones a quarter of the cell. A plan stores the bound itself: if it is
/// given explicitly, the plan is the same, but the default of earlier versions, a quarter, gives
/// another plan.
#[test]
fn the_bound_without_max_error_follows_from_the_cell() {
    let folder = tempfile::tempdir().unwrap();
    let bounds = [
        ([80.0, 60.0], 3.75),
        ([10.0, 10.0], 0.625),
        ([5.0, 5.0], 0.3125),
        ([2.0, 3.0], 0.25),
        ([1.0, 1.0], 0.25),
        ([0.5, 0.5], 0.125),
    ];
    for (number, ([east_m, north_m], bound_m)) in bounds.into_iter().enumerate() {
        let place = [500_000.0, east_m, 0.0, 5_000_000.0, 0.0, -north_m];
        let raster = Raster::new(32632, [20, 20], place);
        let dem = raster.write(folder.path(), &format!("{number}.tif"), |[x, _]| (x / 10.0) as f32);
        let planned = |bound: &[&str]| -> (Value, Value) {
            let file = folder.path().join("plan.json");
            let words = ["plan", "--dem", text(&dem), "-O", "-o", text(&file), "--json"];
            let ran = corniche([&words[..], bound].concat());
            assert_eq!(ran.code, 0, "{}", ran.err);
            let told: Value = serde_json::from_str(&ran.out).unwrap();
            let plan: Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
            (plan["settings"]["max_error_m"].clone(), told["plan_sha256"].clone())
        };
        let usual = planned(&[]);
        assert_eq!(usual.0, bound_m, "{east_m} x {north_m} m");
        assert_eq!(planned(&["--max-error", &bound_m.to_string()]), usual);
        let quarter_m = east_m.min(north_m) / 4.0;
        let quarter = planned(&["--max-error", &quarter_m.to_string()]);
        assert_eq!(quarter.1 == usual.1, quarter_m <= bound_m, "{east_m} x {north_m} m");
    }
}

/// A DEM whose samples are compressed as one block, so that each thread must decode all of it: 35
/// MB each.
fn one_strip(folder: &Path) -> std::path::PathBuf {
    let place = [500_000.0, 10.0, 0.0, 5_000_000.0, 0.0, -10.0];
    let raster = Raster::new(32632, [3500, 2500], place);
    let raster = raster.created(&["COMPRESS=DEFLATE", "BLOCKYSIZE=2500"]);
    raster.write(folder, "strip.tif", |[x, _]| ((x - 500_000.0) / 100.0) as f32)
}

#[test]
fn a_build_that_memory_cannot_suffice_for_does_not_begin_unless_forced() {
    let folder = tempfile::tempdir().unwrap();
    let dem = one_strip(folder.path());
    let target = folder.path().join("out.pmtiles");
    let build = ["build", "--dem", text(&dem), "-o", text(&target), "--quiet", "--max-error", "50"];
    let small = ["--memory", "256M", "--threads", "4"];
    let ran = corniche([&build[..], &small].concat());
    assert_eq!(ran.code, 2, "{}", ran.err);
    for part in ["--memory allows 256M", "strip.tif", "--threads", "--force", "TILED=YES"] {
        assert!(ran.err.contains(part), "{part}: {}", ran.err);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only the DEM is there");

    // The plan is written, and reports this.
    let estimate = &json(&["plan", "--dem", text(&dem), "--json"])["estimate"];
    assert!(estimate["memory"]["block_bytes"].as_u64().unwrap() >= 35_000_000, "{estimate}");
    let ran = corniche([&["plan", "--dem", text(&dem)], &small[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.out.contains("the limit is too low"), "{}", ran.out);

    let ran = corniche([&build[..], &small, &["--force"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(target.exists());
}

#[test]
fn less_than_256_mib_is_no_memory_to_build_in() {
    let ran = plan(&["--memory", "255M"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("at least 256M"), "{}", ran.err);
}
