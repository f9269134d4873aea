//! Photos laid on the terrain of an earlier package: the same bytes as a build from the elevation files, however they are made.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use e2e::{
    Job, When, corniche, manifest,
    photo::{build, inputs, of_ground, pass, photo, succeed},
    sample, text,
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
    // On a package without photos, with other photos, and with the same.
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

/// The terrain is taken, and not the photos: they come from the command line. Credits stay, as of elevation files.
#[test]
fn photos_that_are_not_given_again_are_left_out_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let west = photo(folder.path(), 0.05, "west.tif");
    let _ = build(&inputs(&[&west]), &at("photo.pmtiles"), &[]);
    let osm = sample("pass/pass.osm.pbf");
    let (package, made) = (at("photo.pmtiles"), at("made.pmtiles"));
    let words = ["build", "--terrain", text(&package), "--osm", text(&osm), "-o", text(&made)];
    let ran = succeed(corniche(words));
    assert!(ran.err.contains("photo.pmtiles has photos, which are not taken"), "{}", ran.err);
    let dem = sample("pass/pass-dem.tif");
    let words = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let credited = at("credited.pmtiles");
    let more = ["--attribution", "Photos: nobody", "-o", text(&credited)];
    let ran = succeed(corniche([&words[..], &more].concat()));
    assert!(!ran.err.contains("photos"), "{}", ran.err);
    assert!(fs::read(&made).unwrap() == fs::read(&credited).unwrap());
    succeed(corniche(["verify", text(&made)]));
}

#[test]
fn photos_on_terrain_are_the_same_in_parts_and_after_a_stop() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let west = photo(folder.path(), 0.05, "west.tif");
    let whole = build(&inputs(&[&west]), &at("whole.pmtiles"), &[]);
    let plain = pass(folder.path());
    let plan = at("plan.json");
    let words = ["plan", "-o", text(&plan)].into_iter().map(str::to_owned);
    succeed(corniche(words.chain(of_ground(&["--terrain", text(&plain)], &[&west]))));
    let stores = [at("one"), at("two")];
    let jobs = succeed(corniche(["jobs", text(&plan), "--slots", "2", "--least-work", "0.05"]));
    let jobs: Vec<serde_json::Value> =
        jobs.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let number = |step: &str| jobs.iter().filter(|job| job["step"] == step).count();
    // Photos are read in parts, as heights are, and before the tiles are made.
    assert!(number("heights") > 1, "{jobs:?}");
    let top = jobs.iter().find(|job| job["step"] == "top").unwrap();
    assert!(top["after"].as_array().unwrap().contains(&"heights".into()), "{top}");
    let (merge, parts) = jobs.split_last().unwrap();
    assert_eq!(merge["step"], "merge");
    for (index, job) in parts.iter().enumerate() {
        let args = job["args"].as_array().unwrap().iter().map(|word| word.as_str().unwrap());
        let [own, other] = [&stores[index % 2], &stores[(index + 1) % 2]];
        let mut words = vec!["part", text(&plan), "-q"];
        words.extend(args);
        words.extend(["--store", text(own)]);
        words.extend(other.exists().then(|| text(other)));
        succeed(corniche(words));
    }
    let merged = at("merged.pmtiles");
    let [one, two] = stores.each_ref().map(|store| text(store));
    let words = ["merge", text(&plan), "-q", "-o", text(&merged), "--store", one, two];
    succeed(corniche(words));
    assert!(fs::read(&merged).unwrap() == whole, "parts make another package");
    stop_and_go_on(&plain, &west);
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
