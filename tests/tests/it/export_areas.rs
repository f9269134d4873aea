//! Exported areas, read back by OGR.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::path::Path;

use e2e::{corniche, extract_with_areas, extract_with_boundaries, sample, text};
use gdal::{
    Dataset, Metadata as _,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{Feature, Geometry, LayerAccess as _},
};

/// Sides of a cell of the extract's lattice, metres.
const CELL_M: [f64; 2] = [382.0, 444.7];

fn build(folder: &Path, layers: &str) -> std::path::PathBuf {
    let package = folder.join(format!("{layers}.pmtiles"));
    let (dem, osm) = (sample("pass/pass-dem.tif"), extract_with_areas(folder));
    let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
    let ran = corniche([&inputs[..], &["--layers", layers, "-o", text(&package)]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

/// The contents of a feature: object and id, class, polygons, holes, ratio to the area on the
/// lattice.
fn told(feature: &Feature<'_>, cells: f64) -> (String, String, usize, usize) {
    let field = |name: &str| {
        feature.field_as_string(feature.field_index(name).unwrap()).unwrap().unwrap_or_default()
    };
    let geometry = feature.geometry().unwrap();
    assert!(geometry.is_valid());
    let polygons = geometry.geometry_count();
    let holes = |polygon: usize| geometry.get_geometry(polygon).geometry_count() - 1;
    let area_m2: f64 = field("area_m2").parse().unwrap();
    let ratio = area_m2 / (cells * CELL_M[0] * CELL_M[1]);
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    assert_eq!(field("polygons"), polygons.to_string());
    let name = format!("{} {} {}", field("object"), field("id"), field("name"));
    (name.trim().to_owned(), field("class"), polygons, (0..polygons).map(holes).sum())
}

/// The rings' points, without the closing ones.
fn points(geometry: &Geometry) -> usize {
    match geometry.geometry_count() {
        0 => geometry.point_count() - 1,
        count => (0..count).map(|part| points(&geometry.get_geometry(part))).sum(),
    }
}

#[test]
fn areas_come_back_whole_in_each_format() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path(), "areas");
    for (ending, more) in [
        ("gpkg", &[][..]),
        ("fgb", &[]),
        ("csv", &[]),
        ("geojson", &["--crs", "EPSG:4326"]),
        ("gpkg", &["--crs", "EPSG:4326", "-O"]),
    ] {
        let file = folder.path().join(format!("areas.{ending}"));
        let words = ["export", "layer", "areas", text(&package), "-o", text(&file)];
        let ran = corniche([&words[..], more].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains("2 objects of layer areas on level"), "{}", ran.err);
        assert!(ran.err.contains("© OpenStreetMap contributors"), "{}", ran.err);
        let dataset = Dataset::open(&file).unwrap();
        if ending == "gpkg" {
            let credits = dataset.metadata_item("ATTRIBUTION", "").unwrap();
            assert!(credits.contains("OpenStreetMap"), "{credits}");
        }
        let mut layer = dataset.layer(0).unwrap();
        let mut all: Vec<_> = layer
            .features()
            .map(|feature| {
                // Of four corners each, on the package's finest lattice, and points on borders of
                // tiles.
                assert!((4..40).contains(&points(feature.geometry().unwrap())));
                let is_lake = feature.field_as_string(feature.field_index("id").unwrap());
                let is_lake = is_lake.unwrap().as_deref() == Some("2");
                told(&feature, if is_lake { 9.0 } else { 32.0 })
            })
            .collect();
        all.sort();
        let lake = ("way 2 Lake".to_owned(), "water".to_owned(), 1, 0);
        let wood = ("relation 7".to_owned(), "forest".to_owned(), 1, 1);
        assert_eq!(all, [wood, lake], "{ending}");
    }
}

#[test]
fn levels_and_classes_can_be_chosen_and_areas_that_are_not_there_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let package = build(folder.path(), "areas");
    let file = folder.path().join("areas.geojson");
    let export = |package: &Path, more: &[&str]| {
        let words = ["export", "layer", "areas", text(package), "-O", "-o", text(&file)];
        corniche([&words[..], more].concat())
    };
    let ran = export(&package, &["--classes", "water", "--level", "0"]);
    assert!(
        ran.code == 0 && ran.err.contains("1 objects of layer areas on level 0"),
        "{}",
        ran.err
    );
    let ran = export(&package, &["--classes", "water,glacier"]);
    assert!(ran.code == 0 && ran.err.contains("1 objects of layer areas on level"), "{}", ran.err);

    let refused = |ran: e2e::Ran, why: &str| {
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(ran.err.contains(why), "{}", ran.err);
    };
    refused(
        export(&package, &["--classes", "pond"]),
        "has no class \"pond\"; its classes are pier, breakwater, sea, water, glacier",
    );
    refused(export(&package, &["--level", "9"]), "has no level 9");
    refused(
        export(&build(folder.path(), "none"), &[]),
        "has no layers; build it again with --osm and --layers",
    );
    refused(export(&package, &["--crs", "package"]), "RFC 7946");
    // The existing file is unchanged.
    assert_eq!(json_features(&file), 1);
}

fn json_features(file: &Path) -> usize {
    let text = std::fs::read_to_string(file).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["features"].as_array().unwrap().len()
}

/// A package in metres, whose CRS bends the sides of a rectangle of degrees: clipping gives the
/// same result as GEOS, in both coordinates.
#[test]
fn bounds_cut_areas_and_boundaries_as_geos_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let dem = sample("pass/pass-dem.tif");
    // West of the lake's middle, south of the wood's hole; in UTM 33 north is 4 degrees beside.
    let bounds = [9.512, 46.8765, 9.531, 46.895];
    let words = bounds.map(|degrees| degrees.to_string()).join(",");
    let [west, south, east, north] = bounds;
    let wkt = format!(
        "POLYGON(({west} {south},{east} {south},{east} {north},{west} {north},{west} {south}))"
    );
    let rectangle = Geometry::from_wkt(&wkt).unwrap();
    let extracts = [
        ("areas", extract_with_areas(folder.path())),
        ("boundaries", extract_with_boundaries(folder.path())),
    ];
    for (layer, osm) in extracts {
        let package = at(&format!("{layer}.pmtiles"));
        let inputs = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--max-error", "10"];
        let more = ["--layers", "areas,boundaries", "--crs", "EPSG:32633"];
        let ran = corniche([&inputs[..], &more, &["-o", text(&package)]].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        let export = |more: &[&str]| {
            let file = at("file.gpkg");
            let words = ["export", "layer", layer, text(&package), "-O", "-o", text(&file)];
            let ran = corniche([&words[..], more].concat());
            assert_eq!(ran.code, 0, "{}", ran.err);
            by_id(&file)
        };
        let whole = export(&["--crs", "EPSG:4326"]);
        let size = |geometry: &Geometry| {
            if layer == "areas" { geometry.area() } else { geometry.length() }
        };
        let expected: Vec<(i64, Geometry)> = whole
            .iter()
            .map(|(id, geometry)| (*id, geometry.intersection(&rectangle).unwrap()))
            .filter(|(_, cut)| size(cut) > 0.0)
            .collect();
        assert!(expected.len() > 1);
        let is_cut =
            expected.iter().zip(&whole).any(|((_, cut), (_, own))| size(cut) < 0.9 * size(own));
        assert!(is_cut, "{layer}");
        for crs in ["EPSG:4326", "package"] {
            let found = export(&["--bounds", &words, "--crs", crs]);
            assert_eq!(found.len(), expected.len(), "{layer}");
            for ((id, found), (same, expected)) in found.iter().zip(&expected) {
                assert_eq!(id, same);
                assert!(found.is_valid(), "{layer} {id}");
                let ratio = size(found) / size(expected);
                let envelope = found.envelope();
                let beyond = [west - envelope.MinX, south - envelope.MinY]
                    .into_iter()
                    .chain([envelope.MaxX - east, envelope.MaxY - north])
                    .fold(0.0, f64::max);
                assert!(beyond < 2e-7, "{layer} {id} in {crs}: {beyond} degrees beyond");
                // GEOS treats the long lines of boundaries as straight in degrees, but they are
                // straight in metres.
                let [least, away] = if layer == "areas" { [1e-5, 2e-7] } else { [5e-5, 1e-6] };
                assert!((ratio - 1.0).abs() < least, "{layer} {id} in {crs}: {ratio}");
                let away = found.difference(&expected.buffer(away, 4).unwrap()).unwrap();
                assert!(away.is_empty(), "{layer} {id} in {crs}: {}", away.wkt().unwrap());
            }
        }
    }
}

/// The features of a file, in longitude and latitude, by ascending ids.
fn by_id(file: &Path) -> Vec<(i64, Geometry)> {
    let dataset = Dataset::open(file).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let mut wgs84 = SpatialRef::from_epsg(4326).unwrap();
    wgs84.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let mut own = layer.spatial_ref().unwrap();
    own.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
    let transform = CoordTransform::new(&own, &wgs84).unwrap();
    let features = layer.features().map(|feature| {
        let id = feature.field_index("id").unwrap();
        let geometry = feature.geometry().unwrap().transform(&transform).unwrap();
        (feature.field_as_integer64(id).unwrap().unwrap(), geometry)
    });
    let mut all: Vec<_> = features.collect();
    all.sort_by_key(|(id, _)| *id);
    all
}
