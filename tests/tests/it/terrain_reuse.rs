//! `corniche build --terrain`: new roads on the terrain of an earlier package, without its
//! elevation files.

use std::{fs, path::Path};

use corniche_testing::Raster;
use e2e::{build_pass, corniche, json, manifest, real_data, sample, some_of, text};

/// Runs `build` with some arguments before those of the extract and the package.
fn build(what: &[&str], osm: &Path, package: &Path, options: &[&str]) -> e2e::Ran {
    let mut arguments = vec!["build"];
    arguments.extend(what);
    arguments.extend(["--osm", text(osm), "-o", text(package), "--quiet"]);
    arguments.extend(options);
    corniche(arguments)
}

fn built(what: &[&str], osm: &Path, package: &Path, options: &[&str]) -> Vec<u8> {
    let ran = build(what, osm, package, options);
    assert_eq!(ran.code, 0, "{what:?} {options:?}: {}", ran.err);
    fs::read(package).expect("the package")
}

/// Two years of roads, on the terrain of the first and on a package without roads; the result keeps
/// every promise.
fn check_liechtenstein(options: &[&str]) {
    let files = ["N47E009.hgt", "N47E010.hgt", "2013-08-03", "2021-10-28"].map(|name| {
        let extract = format!("liechtenstein/liechtenstein-{name}.osm.pbf");
        real_data(&if name.contains('-') { extract } else { format!("liechtenstein/{name}") })
    });
    let [Some(west), Some(east), Some(old), Some(new)] = files else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    let dem = ["--dem", text(&west), text(&east)];
    built(&dem, &old, &at("old.pmtiles"), options);
    let bare: Vec<&str> = dem.iter().chain(options).copied().collect();
    let bare_path = at("bare.pmtiles");
    let ran = corniche(["build"].iter().chain(&bare).chain(&["-o", text(&bare_path), "-q"]));
    assert_eq!(ran.code, 0, "{}", ran.err);
    let full = built(&dem, &new, &at("full.pmtiles"), options);
    let again = at("again.pmtiles");
    for package in some_of(["old.pmtiles", "bare.pmtiles", "full.pmtiles"], [2, 2, 1]) {
        // Terrain settings may be repeated or omitted.
        let said = if package == "old.pmtiles" { options } else { &[] };
        let options = [said, &["-O"]].concat();
        let from = at(package);
        let terrain = ["--terrain", text(&from)];
        assert!(built(&terrain, &new, &again, &options) == full, "{package}");
    }
    let ran = corniche(["verify", text(&again), dem[0], dem[1], dem[2], "--osm", text(&new)]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
}

#[test]
#[ignore = "slow: three builds of a country"]
fn liechtenstein_of_2021_on_the_terrain_of_2013() {
    check_liechtenstein(&[]);
}

#[test]
#[ignore = "slow: three builds of a country"]
fn liechtenstein_of_2021_on_the_terrain_of_2013_resampled() {
    check_liechtenstein(&["--crs", "utm", "--cell", "60"]);
}

#[test]
fn the_sample_on_its_own_terrain_with_other_roads_settings_and_credits() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let osm = sample("pass/pass.osm.pbf");
    let credits = ["--attribution", "Heights: us", "--attribution", "and you"];
    build_pass(&at("old.pmtiles"), &[&credits[..], &["--quiet", "--max-error", "8"]].concat());
    let roads = ["--all-classes", "--simplify", "0", "--frc-table", "here5"];
    let terrain = [&credits[..], &["--quiet", "--max-error", "8"]].concat();
    build_pass(&at("full.pmtiles"), &[&roads[..], &terrain].concat());
    let full = fs::read(at("full.pmtiles")).unwrap();
    assert_ne!(fs::read(at("old.pmtiles")).unwrap(), full);
    let old = at("old.pmtiles");
    let take = ["--terrain", text(&old)];
    // Attribution is kept; a given one replaces it.
    assert!(built(&take, &osm, &at("a.pmtiles"), &roads) == full);
    // A forgotten option is reported.
    let ran = build(&take, &osm, &at("d.pmtiles"), &roads);
    assert!(
        ran.code == 0 && ran.err.contains("--simplify is 0, but it was built with 0.25"),
        "{}",
        ran.err
    );
    let ran = build(&take, &osm, &at("e.pmtiles"), &[]);
    assert!(ran.code == 0 && !ran.err.contains("it was built with"), "{}", ran.err);
    let own = [&roads[..], &["--attribution", "Another one"]].concat();
    built(&take, &osm, &at("b.pmtiles"), &own);
    let credits = manifest(&at("b.pmtiles"))["attribution"].clone();
    assert_eq!(credits[0], "Another one", "{credits}");
    assert_eq!(credits.as_array().unwrap().len(), 2, "{credits}");
    // A settings file with the same terrain is accepted; the same file was used for the first
    // build.
    fs::write(at("s.toml"), "[terrain]\nmax-error = 8\n[roads]\nsimplify = 0\n").unwrap();
    let file = at("s.toml");
    let with_file = ["--config", text(&file), "--all-classes", "--frc-table", "here5"];
    assert!(built(&take, &osm, &at("c.pmtiles"), &with_file) == full);
    // A build with terrain only removes the roads.
    let bare = at("bare.pmtiles");
    let ran = corniche(["build", take[0], take[1], "-o", text(&bare), "-q"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(manifest(&bare)["counts"]["roads_in"], 0);
    let plan = json(&["plan", take[0], take[1], "--osm", text(&osm), "--json"]);
    assert_eq!(plan["estimate"]["nodes"], 1_000_000);
}

#[test]
fn what_does_not_fit_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let osm = sample("pass/pass.osm.pbf");
    build_pass(&at("old.pmtiles"), &["--quiet", "--max-error", "8"]);
    let old = at("old.pmtiles");
    let take = ["--terrain", text(&old)];
    let refused = |what: &[&str], options: &[&str], words: &[&str]| {
        let ran = build(what, &osm, &at("new.pmtiles"), options);
        assert_eq!(ran.code, 2, "{what:?} {options:?}: {}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{words:?}: {}", ran.err);
        assert!(!at("new.pmtiles").exists());
    };
    refused(
        &take,
        &["--max-error", "3"],
        &["old.pmtiles", "--max-error is 3", "built with 8", "--dem"],
    );
    refused(&take, &["--cell", "20"], &["--cell is 20,20", "built with not given"]);
    let dem = sample("pass/pass-dem.tif");
    refused(&take, &["--dem", text(&dem)], &["--terrain", "--dem", "cannot be used with"]);
    refused(&[], &[], &["--dem"]);
    refused(&["--terrain", text(&dem)], &[], &["pass-dem.tif", "not a PMTiles file"]);
    let nothing = at("nothing.pmtiles");
    refused(&["--terrain", text(&nothing)], &[], &["nothing.pmtiles"]);

    // Another extract, in another region.
    let elsewhere = at("elsewhere.tif");
    let raster = Raster::new(32632, [40, 40], [700_000.0, 10.0, 0.0, 5_500_000.0, 0.0, -10.0]);
    raster.write_values(&elsewhere, vec![7.0_f32; 1600]);
    let far = at("far.pmtiles");
    let ran = corniche(["build", "--dem", text(&elsewhere), "-o", text(&far), "-q"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    refused(&["--terrain", text(&far)], &[], &["do not overlap"]);

    // One byte of a tile is changed.
    let mut bytes = fs::read(&old).unwrap();
    let last = bytes.len() - 1000;
    bytes[last] ^= 1;
    fs::write(at("damaged.pmtiles"), bytes).unwrap();
    let damaged = at("damaged.pmtiles");
    refused(&["--terrain", text(&damaged)], &[], &["damaged.pmtiles", "--dem"]);
}
