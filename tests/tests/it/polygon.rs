//! The whole binary with `--polygon`: GeoJSON and `GeoPackage`, parts, settings files, `verify`,
//! errors, and a real border.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, real_data, sample, text};
use gdal::{
    Dataset, DriverManager,
    spatial_ref::{AxisMappingStrategy, SpatialRef},
    vector::{Geometry, LayerAccess, LayerOptions, OGRwkbGeometryType},
};
use serde_json::Value;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}", ran.err);
    ran
}

fn manifest(package: &Path) -> Value {
    let ran = succeed(corniche(["info", "--json", text(package)]));
    let info: Value = serde_json::from_str(&ran.out).unwrap();
    info["manifest"].clone()
}

/// A polygon as a `GeoPackage`.
fn geopackage(path: &Path, epsg: u32, geometry: &Geometry) {
    let driver = DriverManager::get_driver_by_name("GPKG").unwrap();
    let mut dataset = driver.create_vector_only(path).unwrap();
    let mut reference = SpatialRef::from_epsg(epsg).unwrap();
    reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let layer = LayerOptions {
        name: "polygons",
        srs: Some(&reference),
        ty: OGRwkbGeometryType::wkbPolygon,
        options: None,
    };
    dataset.create_layer(layer).unwrap().create_feature(geometry.clone()).unwrap();
    dataset.close().unwrap();
}

/// The polygon of the sample `pass`, as a `GeoPackage`.
fn sample_as_geopackage(folder: &Path) -> PathBuf {
    let dataset = Dataset::open(sample("pass/part.geojson")).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let feature = layer.features().next().unwrap();
    let path = folder.join("part.gpkg");
    geopackage(&path, 4326, feature.geometry().unwrap());
    path
}

#[test]
fn every_way_to_name_a_polygon_makes_the_same_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let [dem, osm, json] =
        ["pass/pass-dem.tif", "pass/pass.osm.pbf", "pass/part.geojson"].map(sample);
    let inputs = ["--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let (package, list) = (at("a.pmtiles"), at("defects.csv"));
    let build = ["build", "-q", "-o", text(&package), "--defects", text(&list)];
    succeed(corniche([&build[..], &inputs, &["--polygon", text(&json)]].concat()));
    let bytes = fs::read(&package).unwrap();
    let said = succeed(corniche(["info", text(&package)])).out;
    assert!(said.contains("polygon      part.geojson, a part of"), "{said}");
    assert!(said.contains("lost outside the requested bounds"), "{said}");
    assert!(!fs::read_to_string(&list).unwrap().contains("bounds"));
    let own = manifest(&package);
    let kinds: Vec<&str> = own["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| input["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds, ["dem", "polygon", "osm"]);
    let counts = &own["counts"];
    let lost = counts["roads_lost"].as_array().unwrap().iter();
    let lost: u64 = lost.map(|loss| loss["length_um"].as_u64().unwrap()).sum();
    let um = |name: &str| counts[name].as_u64().unwrap();
    assert_eq!(um("roads_kept_um") + lost, um("roads_in_um"));

    // The same polygon in another format: the same tiles, and the same package except for the name
    // and hash of the file.
    let (gpkg, other) = (sample_as_geopackage(folder.path()), at("b.pmtiles"));
    let with_gpkg = ["build", "-q", "-o", text(&other), "--polygon", text(&gpkg), "--threads", "1"];
    succeed(corniche([&with_gpkg[..], &inputs].concat()));
    let own_hash = |package: &Path| manifest(package)["settings"]["polygon"]["sha256"].clone();
    assert_eq!(own_hash(&other), own_hash(&package));
    assert_eq!(manifest(&other)["counts"], own["counts"]);
    assert_eq!(manifest(&other)["levels"], own["levels"]);

    // In parts, with all inputs in a settings file.
    let (plan, config, store, merged) =
        (at("plan.json"), at("settings.toml"), at("store"), at("merged.pmtiles"));
    fs::write(
        &config,
        format!(
            "[inputs]\ndem = {:?}\nosm = {:?}\npolygon = {:?}\n[terrain]\nmax-error = 10.0\n",
            text(&dem),
            text(&osm),
            text(&json)
        ),
    )
    .unwrap();
    let planned = ["plan", "--subtrees", "1", "-o", text(&plan), "--config", text(&config)];
    let subtrees = succeed(corniche(planned)).out;
    let one = |step: &str, subtree: Option<&str>| {
        let mut command = vec!["part", text(&plan), "-q", "--store", text(&store), "--step", step];
        command.extend(subtree.into_iter().flat_map(|subtree| ["--subtree", subtree]));
        corniche(command)
    };
    succeed(one("hashes", None));
    succeed(one("roads", None));
    subtrees.lines().for_each(|subtree| drop(succeed(one("heights", Some(subtree)))));
    succeed(one("top", None));
    subtrees.lines().for_each(|subtree| drop(succeed(one("tiles", Some(subtree)))));
    succeed(corniche(["merge", text(&plan), "-q", "--store", text(&store), "-o", text(&merged)]));
    assert!(fs::read(&merged).unwrap() == bytes, "parts make another package");

    // Reused terrain needs the polygon again, under any name and in any format; so does verify.
    let again = at("again.pmtiles");
    let taken =
        ["build", "-q", "-o", text(&again), "--terrain", text(&package), "--osm", text(&osm)];
    succeed(corniche([&taken[..], &["--polygon", text(&json)]].concat()));
    assert!(fs::read(&again).unwrap() == bytes, "the terrain of a package makes another one");
    let refused = corniche([&taken[..], &["-O"]].concat());
    assert!(refused.code == 2 && refused.err.contains("--polygon"), "{}", refused.err);
    let verify = ["verify", text(&package), "--dem", text(&dem), "--osm", text(&osm)];
    succeed(corniche([&verify[..], &["--polygon", text(&gpkg)]].concat()));
    let refused = corniche(verify);
    assert!(refused.code == 2 && refused.err.contains("part.geojson"), "{}", refused.err);
}

#[test]
fn wrong_polygons_are_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (dem, package) = (sample("pass/pass-dem.tif"), at("package.pmtiles"));
    let feature =
        |geometry: &str| format!(r#"{{"type":"Feature","properties":{{}},"geometry":{geometry}}}"#);
    for (name, content, words) in [
        (
            "line.geojson",
            feature(r#"{"type":"LineString","coordinates":[[9.5,46.9],[9.6,46.95]]}"#),
            "encloses no area",
        ),
        (
            "bow.geojson",
            feature(
                r#"{"type":"Polygon","coordinates":[[[9.5,46.9],[9.55,46.94],[9.55,46.9],[9.5,46.94],[9.5,46.9]]]}"#,
            ),
            "-makevalid",
        ),
        (
            "far.geojson",
            feature(
                r#"{"type":"Polygon","coordinates":[[[10.5,46.9],[10.55,46.9],[10.55,46.94],[10.5,46.9]]]}"#,
            ),
            "contains no cell",
        ),
        ("empty.geojson", r#"{"type":"FeatureCollection","features":[]}"#.to_owned(), "no polygon"),
        ("text.geojson", "polygon".to_owned(), "not a vector file"),
    ] {
        fs::write(at(name), content).unwrap();
        let ran = corniche([
            "build",
            "-q",
            "-o",
            text(&package),
            "--dem",
            text(&dem),
            "--polygon",
            text(&at(name)),
        ]);
        assert_eq!(ran.code, 2, "{name}: {}", ran.err);
        assert!(ran.err.contains(words) && ran.err.contains(name), "{name}: {}", ran.err);
    }
    assert!(!package.exists());
}

/// Liechtenstein, clipped to its own border: all of the country's roads except those that the
/// extract has beyond the border.
#[test]
fn a_country_is_cut_by_its_own_border() {
    let Some(osm) = real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf") else { return };
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // GDAL assembles relations of ways; admin level 2 is the country.
    let dataset = Dataset::open(&osm).unwrap();
    let mut layer = dataset.layer_by_name("multipolygons").unwrap();
    layer.set_attribute_filter("admin_level = '2' AND boundary = 'administrative'").unwrap();
    let border = layer.features().next().expect("the extract has the country's border");
    let polygon = at("border.gpkg");
    geopackage(&polygon, 4326, border.geometry().unwrap());
    let build = |name: &str, options: &[&str]| {
        let package = at(name);
        let inputs =
            ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
        succeed(corniche([&inputs[..], &["--max-error", "30"], options].concat()));
        package
    };
    let cut = build("cut.pmtiles", &["--polygon", text(&polygon)]);
    let boxed = build("box.pmtiles", &["--bounds", "osm"]);
    let [cut_counts, boxed_counts] =
        [&cut, &boxed].map(|package| manifest(package)["counts"].clone());
    let um = |counts: &Value, name: &str| counts[name].as_u64().unwrap() as f64;
    // The country has 160 km² of the bounding box's 300.
    let nodes = |counts: &Value| counts["samples"]["with_data"].as_u64().unwrap() as f64;
    let share = nodes(&cut_counts) / nodes(&boxed_counts);
    assert!((0.4..0.7).contains(&share), "{share} of the nodes");
    let kept = um(&cut_counts, "roads_kept_um") / um(&boxed_counts, "roads_kept_um");
    assert!((0.8..1.0).contains(&kept), "{kept} of the roads");
    succeed(corniche([
        "verify",
        text(&cut),
        "--dem",
        text(&dem),
        "--osm",
        text(&osm),
        "--polygon",
        text(&polygon),
    ]));
}
