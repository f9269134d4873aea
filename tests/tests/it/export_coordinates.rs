//! Coordinates of exported features: GeoJSON in degrees without any option, and every layer and
//! format in projected systems, compared with the results of GDAL and PROJ.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{
    Ran, copy_pass, corniche, extract_with_areas, extract_with_boundaries, sample, some_of, text,
};
use gdal::{
    Dataset,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{Geometry, LayerAccess as _},
};

/// The package's own system.
const PACKAGE_EPSG: u32 = 32632;

/// The words of an export; `layer` is one word, or `layer` and its name.
fn words<'a>(package: &'a Path, layer: &'a str, file: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let words = ["export"].into_iter().chain(layer.split(' '));
    words.chain([text(package), "-o", text(file)]).chain(more.iter().copied()).collect()
}

fn export(package: &Path, layer: &str, file: &Path, more: &[&str]) -> Ran {
    let ran = corniche(words(package, layer, file, &[&["-O"], more].concat()));
    assert_eq!(ran.code, 0, "{layer} {more:?}: {}", ran.err);
    ran
}

/// All positions of a file, in its order.
fn positions(file: &Path) -> Vec<[f64; 3]> {
    fn add(geometry: &Geometry, all: &mut Vec<[f64; 3]>) {
        for part in 0..geometry.geometry_count() {
            add(&geometry.get_geometry(part), all);
        }
        if geometry.geometry_count() == 0 {
            let mut points = Vec::new();
            geometry.get_points(&mut points);
            all.extend(points.into_iter().map(|(x, y, z)| [x, y, z]));
        }
    }
    let dataset = Dataset::open(file).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let mut all = Vec::new();
    for feature in layer.features() {
        add(feature.geometry().unwrap(), &mut all);
    }
    all
}

/// Transforms positions of the package's CRS to another one with PROJ; heights are unchanged.
fn carried(mut all: Vec<[f64; 3]>, epsg: u32) -> Vec<[f64; 3]> {
    let crs = |code| {
        let mut crs = SpatialRef::from_epsg(code).unwrap();
        crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        crs
    };
    let transform = CoordTransform::new(&crs(PACKAGE_EPSG), &crs(epsg)).unwrap();
    for at in &mut all {
        let (mut x, mut y) = ([at[0]], [at[1]]);
        transform.transform_coords(&mut x, &mut y, &mut []).unwrap();
        *at = [x[0], y[0], at[2]];
    }
    all
}

fn are_same(found: &[[f64; 3]], expected: &[[f64; 3]], plan: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    assert!(found.len() > 3, "{what}");
    for (one, other) in found.iter().zip(expected) {
        let off = [0, 1, 2].map(|axis| (one[axis] - other[axis]).abs());
        assert!(
            off[0] < plan && off[1] < plan && off[2] < plan.max(1e-4),
            "{what}: {one:?} {other:?}"
        );
    }
}

/// Each exported layer, with a package that has it, and the required options.
fn layers(folder: &Path) -> Vec<(&'static str, PathBuf, Vec<String>)> {
    let [dem, osm] = ["pass/pass-dem.tif", "pass/pass.osm.pbf"].map(sample);
    let roads = folder.join("roads.pmtiles");
    copy_pass(&roads, &["-q"]);
    let built = |name: &str, osm: &Path, more: &[&str]| {
        let package = folder.join(name);
        let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(osm), "--max-error", "10"];
        let ran = corniche([&inputs[..], more, &["-o", text(&package)]].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        package
    };
    let areas = built("areas.pmtiles", &extract_with_areas(folder), &["--layers", "areas"]);
    let of_boundaries = extract_with_boundaries(folder);
    let boundaries = built("boundaries.pmtiles", &of_boundaries, &["--layers", "boundaries"]);
    let inputs = ["--dem", text(&dem), "--osm", text(&osm)].map(str::to_owned).to_vec();
    vec![
        ("roads", roads.clone(), Vec::new()),
        ("edges", roads, inputs),
        ("layer areas", areas, Vec::new()),
        ("layer boundaries", boundaries, Vec::new()),
    ]
}

#[test]
fn every_layer_and_format_has_degrees_and_projected_coordinates() {
    let folder = tempfile::tempdir().unwrap();
    for (layer, package, inputs) in layers(folder.path()) {
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        let own = folder.path().join("own.gpkg");
        export(&package, layer, &own, &inputs);
        let own = positions(&own);
        // The first attempt succeeds, and the coordinates are reported.
        let json = folder.path().join("degrees.geojson");
        let ran = export(&package, layer, &json, &inputs);
        assert!(ran.err.contains("coordinates: EPSG:4326, the CRS of GeoJSON"), "{}", ran.err);
        let has_heights = layer != "layer areas";
        assert_eq!(ran.err.contains("as in the package (--crs"), has_heights, "{}", ran.err);
        are_same(&positions(&json), &carried(own.clone(), 4326), 1e-8, layer);
        // The datum of the last one was made for a neighbouring country: its operation counts
        // there, too.
        let pairs = [2056, 32633, 3857, 31467]
            .into_iter()
            .flat_map(|epsg| ["gpkg", "fgb", "csv", "geojson"].map(|ending| (epsg, ending)));
        for (epsg, ending) in some_of(pairs, [5, 5, 1]) {
            let mut expected = carried(own.clone(), epsg);
            let crs = format!("EPSG:{epsg}");
            let what = format!("{layer} {crs} {ending}");
            let file = folder.path().join(format!("projected.{ending}"));
            let ran = export(&package, layer, &file, &[&inputs[..], &["--crs", &crs]].concat());
            assert!(ran.err.contains(&format!("coordinates: {crs}")), "{}", ran.err);
            let mut found = positions(&file);
            if ending == "fgb" {
                // Its spatial index has another order.
                for all in [&mut found, &mut expected] {
                    all.sort_by_key(|at| at.map(|value| (value * 100.0).round() as i64));
                }
            }
            // GDAL writes numbers of GeoJSON without long rows of nines.
            let most = match ending {
                "fgb" => 0.02,
                "geojson" => 1e-3,
                _ => 1e-5,
            };
            are_same(&found, &expected, most, &what);
            if ending == "csv" {
                continue;
            }
            let dataset = Dataset::open(&file).unwrap();
            let named = dataset.layer(0).unwrap().spatial_ref().unwrap();
            let wkt = named.to_wkt().unwrap();
            assert!(wkt.contains(&format!("\"EPSG\",\"{epsg}\"")), "{what}: {wkt}");
        }
        for (crs, why) in
            [("EPSG:4258", "not a projected"), ("EPSG:1", "EPSG:1"), ("utm", "ogr2ogr")]
        {
            let file = folder.path().join("refused.gpkg");
            let more = [&["--crs", crs][..], &inputs].concat();
            let ran = corniche(words(&package, layer, &file, &more));
            assert_eq!(ran.code, 2, "{}", ran.err);
            assert!(ran.err.contains(why), "{}", ran.err);
            assert!(!file.exists());
        }
    }
}

/// A package with a known vertical datum records it in the layer, in addition to the projected CRS.
#[test]
fn the_datum_of_heights_stays_in_the_layer() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["-q"]);
    let file = folder.path().join("roads.gpkg");
    export(&package, "roads", &file, &["--crs", "EPSG:2056", "--dem-vertical-crs", "EPSG:5773"]);
    let dataset = Dataset::open(&file).unwrap();
    let wkt = dataset.layer(0).unwrap().spatial_ref().unwrap().to_wkt().unwrap();
    assert!(wkt.contains("CH1903+ / LV95") && wkt.contains("EGM96"), "{wkt}");
    let json = folder.path().join("roads.geojson");
    export(&package, "roads", &json, &["--crs", "EPSG:2056"]);
    let text = fs::read_to_string(json).unwrap();
    assert!(text.contains("urn:ogc:def:crs:EPSG::2056"), "the member crs");
}
