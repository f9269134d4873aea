//! Photos on the terrain of an earlier package: the same bytes as a build from the elevation files,
//! for all ways to build.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{
    Job, When, corniche, manifest,
    photo::{build, inputs, of_ground, pass, photo, succeed},
    sample, some_of, text,
};

#[test]
fn photos_on_terrain_make_the_package_of_a_whole_build() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (west, east) =
        (photo(folder.path(), 0.05, "west.tif"), photo(folder.path(), 0.45, "east.tif"));
    let whole = build(&inputs(&[&west, &east]), &at("whole.pmtiles"), &[]);
    let other = build(&inputs(&[&east]), &at("other.pmtiles"), &["--photo-quality", "50"]);
    assert!(other != whole);
    // On a package without photos, with other photos, and with the same photos.
    for package in [pass(folder.path()), at("other.pmtiles"), at("whole.pmtiles")] {
        let ground = ["--terrain", text(&package)];
        let made = at("made.pmtiles");
        let again = build(&of_ground(&ground, &[&west, &east]), &made, &["-O"]);
        assert!(again == whole, "{}", package.display());
    }
    succeed(corniche(["verify", text(&at("made.pmtiles"))]));
    // With bounds, which are those of the package.
    let bounds = &manifest(&at("whole.pmtiles"))["wgs84_bounds"];
    let middle = |low: &str, high: &str, share: f64| {
        let [low, high] = [low, high].map(|key| bounds[key].as_f64().unwrap());
        low + share * (high - low)
    };
    let [west_deg, east_deg] = [0.3, 0.6].map(|share| middle("min_x", "max_x", share));
    let [south_deg, north_deg] = [0.4, 0.7].map(|share| middle("min_y", "max_y", share));
    let asked = format!("{west_deg},{south_deg},{east_deg},{north_deg}");
    let part = build(&inputs(&[&west]), &at("part.pmtiles"), &["--bounds", &asked]);
    let dem = sample("pass/pass-dem.tif");
    let bare = ["build", "-q", "--dem", text(&dem), "--max-error", "10", "--bounds", &asked];
    succeed(corniche([&bare[..], &["-o", text(&at("bare.pmtiles"))]].concat()));
    let bare = at("bare.pmtiles");
    let ground = of_ground(&["--terrain", text(&bare)], &[&west]);
    assert!(build(&ground, &at("on-bare.pmtiles"), &[]) == part, "bounds");
}

/// When new roads are built onto existing terrain, the photos need not be available. `--photo off`
/// omits them; attribution stays, as for elevation files.
#[test]
fn photos_of_the_terrain_stay_unless_they_are_off() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let west = photo(folder.path(), 0.05, "west.tif");
    let package = at("photo.pmtiles");
    let whole = build(&inputs(&[&west]), &package, &["--photo-quality", "60"]);
    fs::remove_file(&west).unwrap();
    let osm = sample("pass/pass.osm.pbf");
    let ground = ["--terrain", text(&package), "--osm", text(&osm)].map(str::to_owned);
    let made = at("made.pmtiles");
    assert!(build(&ground, &made, &[]) == whole, "photos changed");
    succeed(corniche(["verify", text(&made)]));
    let plan = at("plan.json");
    let words = ["plan", "-o", text(&plan)].into_iter().map(str::to_owned);
    succeed(corniche(words.chain(ground.clone())));
    let (merged, steps) = in_parts(folder.path(), &plan);
    assert!(merged == whole, "photos changed in parts");
    assert!(!steps.contains(&"heights".to_owned()), "nothing is read: {steps:?}");
    // Settings of photos cannot be changed without the files.
    let quality = ["--photo-quality", "80", "-O", "-o", text(&made)].map(str::to_owned);
    let words = ["build".to_owned()].into_iter().chain(ground.clone()).chain(quality);
    let ran = corniche(words);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("pass photos with --photo FILE"), "{}", ran.err);

    let dem = sample("pass/pass-dem.tif");
    let bare = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"].map(str::to_owned);
    let bare = build(&bare, &at("bare.pmtiles"), &["--attribution", "Photos: nobody"]);
    assert!(build(&ground, &made, &["-O", "--photo", "off"]) == bare, "--photo off");
    let config = at("settings.toml");
    fs::write(&config, "[inputs]\nphoto = \"off\"\n[photo]\nquality = 60\n").unwrap();
    assert!(build(&ground, &made, &["-O", "--config", text(&config)]) == bare, "settings file");
}

#[test]
#[ignore = "slow: some ten builds with photos"]
fn photos_on_terrain_are_the_same_in_parts_and_after_a_stop() {
    let folder = tempfile::tempdir().unwrap();
    let west = photo(folder.path(), 0.05, "west.tif");
    let plain = pass(folder.path());
    let checks: [fn(&Path, &Path, &Path); 2] =
        [make_in_parts, |_, plain, photo| stop_and_go_on(plain, photo)];
    for check in some_of(checks, [2, 2, 1]) {
        check(folder.path(), &plain, &west);
    }
}

fn make_in_parts(folder: &Path, plain: &Path, photo: &Path) {
    let whole = build(&inputs(&[photo]), &folder.join("whole.pmtiles"), &[]);
    let plan = folder.join("plan.json");
    let words = ["plan", "-o", text(&plan)].into_iter().map(str::to_owned);
    succeed(corniche(words.chain(of_ground(&["--terrain", text(plain)], &[photo]))));
    let (merged, steps) = in_parts(folder, &plan);
    // Photos are read in parts, like heights.
    assert!(steps.iter().filter(|&step| step == "heights").count() > 1, "{steps:?}");
    assert!(merged == whole, "parts make another package");
}

/// Computes the parts of a plan in two stores, and the package of both; returns also the steps of
/// the parts.
fn in_parts(folder: &Path, plan: &Path) -> (Vec<u8>, Vec<String>) {
    let jobs = succeed(corniche(["jobs", text(plan), "--slots", "2", "--least-work", "0.05"]));
    let jobs: Vec<serde_json::Value> =
        jobs.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let (merge, parts) = jobs.split_last().unwrap();
    assert_eq!(merge["step"], "merge");
    let steps: Vec<String> =
        parts.iter().map(|job| job["step"].as_str().unwrap().to_owned()).collect();
    // Steps that read come before the tiles are computed.
    if let Some(top) = parts.iter().find(|job| job["step"] == "top") {
        let after = top["after"].as_array().unwrap();
        assert!(!steps.contains(&"heights".to_owned()) || after.contains(&"heights".into()));
    }
    let stores = ["one", "two"].map(|name| folder.join(name));
    for (index, job) in parts.iter().enumerate() {
        let args = job["args"].as_array().unwrap().iter().map(|word| word.as_str().unwrap());
        let [own, other] = [&stores[index % 2], &stores[(index + 1) % 2]];
        let mut words = vec!["part", text(plan), "-q"];
        words.extend(args);
        words.extend(["--store", text(own)]);
        words.extend(other.exists().then(|| text(other)));
        succeed(corniche(words));
    }
    let merged = folder.join("merged.pmtiles");
    let stores = stores.iter().filter(|store| store.exists()).map(|store| text(store));
    let mut words = vec!["merge", text(plan), "-q", "-o", text(&merged), "--store"];
    words.extend(stores);
    succeed(corniche(words));
    (fs::read(&merged).unwrap(), steps)
}

fn stop_and_go_on(plain: &Path, photo: &Path) {
    let options = ["--threads", "1", "--photo", text(photo), "--photo-levels", "4"];
    let whole = Job::new(&options).on_terrain(plain);
    whole.succeed(&["--quiet"]);
    let job = Job::new(&options).on_terrain(plain);
    let stopped = job.stop(&[], "KILL", When::Worked);
    assert_ne!(stopped.code, 0, "it ended by itself");
    job.succeed(&["--quiet", "--resume"]);
    assert!(job.result() == whole.result());
}
