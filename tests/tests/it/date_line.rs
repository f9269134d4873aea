//! Roads, areas, boundaries and lines of other files over ±180° and over the opposite meridian, on
//! elevation models of many systems.
//!
//! All regions have the same ground; correct lengths and areas are those of `GeographicLib`'s
//! geodesics on WGS84.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::{
    Raster,
    pbf::{BlockBuilder, WayToWrite, extract as extract_of, file},
};
use e2e::{corniche, manifest, text};
use gdal::{
    Dataset,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{FieldValue, Geometry, LayerAccess as _},
};
use serde_json::Value;

/// Ways across 180°, from 180° and to 180°, with their lengths; the last one crosses the meridian
/// of Greenwich, on the opposite side.
const WAYS: [(i64, &[[f64; 2]], f64); 5] = [
    (1, &[[179.9, 10.0], [-179.9, 10.01]], 21_955.416),
    (2, &[[-180.0, 10.1], [-179.9, 10.1]], 10_960.568),
    (3, &[[179.95, 10.15], [180.0, 10.15], [-180.0, 10.15], [-179.95, 10.15]], 10_958.871),
    (4, &[[179.9, 10.05], [180.0, 10.05]], 10_962.256),
    (OPPOSITE, &[[-0.1, 10.0], [0.1, 10.05]], 22_612.900),
];
const OPPOSITE: i64 = 5;
/// Forests of 0.2 by 0.05 degrees across 180° and across Greenwich, from the south-western corner
/// on.
const FORESTS: [(i64, f64); 2] = [(11, 179.9), (12, -0.1)];
const FOREST_M2: f64 = 121_296_921.4;
/// Borders along ways 1 and 5.
const BORDERS: [(i64, usize); 2] = [(21, 0), (22, 4)];

/// Size and geotransform of a raster.
type File = ([usize; 2], [f64; 6]);

/// An elevation model: files of one system, and the options to build it.
struct Model {
    name: &'static str,
    epsg: u32,
    files: Vec<File>,
    options: &'static [&'static str],
    is_global: bool,
}

const X_180: f64 = 20_037_508.342_789_244;
const DEGREE_M: f64 = X_180 / 180.0;
/// The ground around 180°, degrees.
const GROUND: [f64; 4] = [-0.25, 9.8, 0.25, 10.3];

/// Transforms a position to another system with PROJ.
fn carried(epsg: u32, [lon, lat]: [f64; 2]) -> [f64; 2] {
    let [from, to] = [4326, epsg].map(|code| {
        let mut system = SpatialRef::from_epsg(code).unwrap();
        system.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        system
    });
    let (mut x, mut y) = ([lon], [lat]);
    CoordTransform::new(&from, &to).unwrap().transform_coords(&mut x, &mut y, &mut []).unwrap();
    [x[0], y[0]]
}

/// Files of a system with evenly spaced x, from west to east relative to its coordinate of 180°, in
/// fractions of a degree.
fn even(epsg: u32, parts: &[(f64, [f64; 2])], degree: f64, cell: f64) -> Vec<File> {
    // For the whole earth there is space for more than one row.
    let [_, south, _, north] = if cell < degree { GROUND } else { [0.0, -2.0, 0.0, 22.0] };
    let [south, north] = [south, north].map(|lat| carried(epsg, [170.0, lat])[1]);
    let rows = ((north - south) / cell).ceil() as usize;
    let file = |&(x_180, [west, east]): &(f64, [f64; 2])| {
        let columns = ((east - west) * degree / cell).round() as usize;
        ([columns, rows], [x_180 + west * degree, cell, 0.0, north, 0.0, -cell])
    };
    parts.iter().map(file).collect()
}

fn models() -> Vec<Model> {
    let model = |name, epsg, files, options| Model { name, epsg, files, options, is_global: false };
    let both = [-0.25, 0.25];
    let metres = |epsg, parts: &[(f64, [f64; 2])]| even(epsg, parts, DEGREE_M, 0.005 * DEGREE_M);
    let utm = {
        let [west, south, east, north] = GROUND;
        let corners = [[west, south], [west, north], [east, south], [east, north]];
        let corners = corners.map(|[lon, lat]| carried(32660, [180.0 + lon, lat]));
        let all = |axis: usize| corners.iter().map(move |corner| corner[axis]);
        let west = all(0).fold(f64::INFINITY, f64::min);
        let north = all(1).fold(f64::NEG_INFINITY, f64::max);
        vec![([112, 112], [west - 500.0, 500.0, 0.0, north + 500.0, 0.0, -500.0])]
    };
    let own = &["--crs", "dem"];
    let overlapping = [(X_180, [-0.25, 0.01]), (-X_180, [-0.01, 0.25])];
    let meeting = [(X_180, [-0.25, 0.0]), (-X_180, [0.0, 0.25])];
    vec![
        model("degrees", 4326, even(4326, &[(180.0, both)], 1.0, 0.005), &[]),
        model("degrees-west", 4326, even(4326, &[(-180.0, both)], 1.0, 0.005), &[]),
        model("3857", 3857, metres(3857, &[(X_180, both)]), own),
        model("3857-west", 3857, metres(3857, &[(-X_180, both)]), own),
        model("3857-meeting", 3857, metres(3857, &meeting), own),
        model("3857-meeting-west", 3857, metres(3857, &[meeting[1], meeting[0]]), own),
        // 250 m are not a multiple of a full turn: the files are on two grids, and one continues
        // where the other ends.
        model("3857-two-grids", 3857, even(3857, &overlapping, DEGREE_M, 250.0), own),
        model("3857-in-3832", 3857, metres(3857, &[(X_180, both)]), &["--crs", "EPSG:3832"]),
        model(
            "degrees-in-3857",
            4326,
            even(4326, &[(180.0, both)], 1.0, 0.005),
            &["--crs", "EPSG:3857"],
        ),
        model("3395", 3395, metres(3395, &[(X_180, both)]), own),
        model("3395-west", 3395, metres(3395, &[(-X_180, both)]), own),
        model("4087", 4087, metres(4087, &[(X_180, both)]), own),
        model("32662", 32662, metres(32662, &[(-X_180, both)]), own),
        model("32660", 32660, utm, own),
        globe("from-180", -180.0),
        globe("from-0", 0.0),
        cells("cells-from-180", &[(-180.0, 360)], own),
        cells("cells-from-0", &[(0.0, 360)], own),
        cells("cells-of-two-files", &[(-180.0, 200), (20.0, 160)], own),
        cells("cells-on-others", &[(-180.0, 360)], &["--crs", "dem", "--cell", "70000"]),
        cells("cells-in-4087", &[(0.0, 360)], &["--crs", "EPSG:4087"]),
        around("3857-globe", 3857),
        around("4087-globe", 4087),
    ]
}

/// A grid of the whole earth in degrees, with samples at both ends.
fn globe(name: &'static str, west: f64) -> Model {
    let files = vec![([361, 21], [west - 0.5, 1.0, 0.0, 20.5, 0.0, -1.0])];
    Model { name, epsg: 4326, files, options: &["--crs", "dem"], is_global: true }
}

/// The same grid with one sample per cell: there are no samples between the last column and the
/// first.
fn cells(name: &'static str, parts: &[(f64, usize)], options: &'static [&'static str]) -> Model {
    let file = |&(west, columns): &(f64, usize)| ([columns, 40], [west, 1.0, 0.0, 20.0, 0.0, -1.0]);
    Model { name, epsg: 4326, files: parts.iter().map(file).collect(), options, is_global: true }
}

/// The same grid in metres.
fn around(name: &'static str, epsg: u32) -> Model {
    let files = even(epsg, &[(0.0, [-180.5, 180.5])], DEGREE_M, DEGREE_M);
    Model { name, epsg, files, options: &["--crs", "dem"], is_global: true }
}

impl Model {
    fn write(&self, folder: &Path) -> Vec<PathBuf> {
        let names = (0..self.files.len()).map(|file| format!("{}-{file}.tif", self.name));
        let write = |(name, &(size, map)): (String, &([usize; 2], [f64; 6]))| {
            Raster::new(self.epsg, size, map).write(folder, &name, |[_, y]| (y / map[1]) as f32)
        };
        names.zip(&self.files).map(write).collect()
    }
}

/// Writes the extract; `with_opposite` adds the objects across Greenwich.
fn extract(folder: &Path, with_opposite: bool) -> PathBuf {
    let mut block = BlockBuilder::new();
    let mut nodes = Vec::new();
    let mut line = |points: &[[f64; 2]]| -> Vec<i64> {
        let e7 = |deg: f64| (deg * 1e7).round() as i64;
        let node = |&[lon, lat]: &[f64; 2]| {
            nodes.push((nodes.len() as i64 + 1, e7(lat), e7(lon)));
            nodes.len() as i64
        };
        points.iter().map(node).collect()
    };
    let count = if with_opposite { WAYS.len() } else { WAYS.len() - 1 };
    let roads: Vec<Vec<i64>> = WAYS[..count].iter().map(|(_, points, _)| line(points)).collect();
    let parts = if with_opposite { 2 } else { 1 };
    let forests: Vec<Vec<i64>> = FORESTS[..parts]
        .iter()
        .map(|&(_, west)| {
            let east = if west > 0.0 { west + 0.2 - 360.0 } else { west + 0.2 };
            let mut ring = line(&[[west, 9.9], [east, 9.9], [east, 9.95], [west, 9.95]]);
            ring.push(ring[0]);
            ring
        })
        .collect();
    block.dense(&nodes);
    for ((id, ..), nodes) in WAYS.iter().zip(&roads) {
        block.way(*id, &[("highway", "primary")], nodes);
    }
    for ((id, _), nodes) in FORESTS.iter().zip(&forests) {
        block.way(*id, &[("landuse", "forest")], nodes);
    }
    let borders = &BORDERS[..parts];
    for &(id, along) in borders {
        block.way(id, &[], &roads[along]);
    }
    let tags = [("type", "boundary"), ("boundary", "administrative"), ("admin_level", "2")];
    let members: Vec<(i64, &str)> = borders.iter().map(|&(id, _)| (id, "outer")).collect();
    block.relation(31, &tags, &members);
    let path = folder.join(format!("{count}.osm.pbf"));
    fs::write(&path, file(&block)).unwrap();
    path
}

fn done(arguments: &[&str]) -> String {
    let ran = corniche(arguments);
    assert_eq!(ran.code, 0, "{arguments:?}: {}{}", ran.out, ran.err);
    ran.out
}

fn built(model: &Model, dems: &[PathBuf], osm: &Path, package: &Path) {
    let mut words = vec!["build", "-q", "--osm", text(osm), "-o", text(package)];
    words.extend(dems.iter().flat_map(|dem| ["--dem", text(dem)]));
    words.extend(["--layers", "areas,boundaries"]);
    words.extend(model.options);
    done(&words);
}

/// The features of a file: their numbers by name, and their geometries.
fn features(path: &Path) -> Vec<(BTreeMap<String, f64>, Geometry)> {
    let dataset = Dataset::open(path).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let number = |value: Option<FieldValue>| match value {
        Some(FieldValue::IntegerValue(value)) => Some(f64::from(value)),
        Some(FieldValue::Integer64Value(value)) => Some(value as f64),
        Some(FieldValue::RealValue(value)) => Some(value),
        _ => None,
    };
    let feature = |feature: gdal::vector::Feature<'_>| {
        let numbers = feature.fields().filter_map(|(name, value)| Some((name, number(value)?)));
        (numbers.collect(), feature.geometry().unwrap().clone())
    };
    layer.features().map(feature).collect()
}

fn near(what: &str, found: f64, expected: f64) {
    let off = (found / expected - 1.0).abs();
    assert!(off < 2e-5, "{what}: {found}, not {expected}");
}

/// Checks lines in degrees: all are within ±180, none has zero length, and the total length is
/// about right.
fn check_lines(what: &str, geometry: &Geometry, expected_m: f64) {
    let mut length_m = 0.0;
    for part in 0..geometry.geometry_count() {
        let mut points = Vec::new();
        geometry.get_geometry(part).get_points(&mut points);
        assert!(points.iter().all(|(lon, ..)| lon.abs() <= 180.0), "{what}: {points:?}");
        let own: f64 = points
            .array_windows()
            .map(|[(lon, lat, _), (next_lon, next_lat, _)]| {
                let [east, north] = [next_lon - lon, next_lat - lat].map(f64::to_radians);
                6.372e6 * (east * lat.to_radians().cos()).hypot(north)
            })
            .sum();
        assert!(own > 0.01, "{what}: a part of no length, {points:?}");
        length_m += own;
    }
    let off = (length_m / expected_m - 1.0).abs();
    assert!(off < 0.01, "{what}: {length_m} m, not {expected_m}");
}

fn check(model: &Model, folder: &Path, extracts: &[PathBuf; 2]) {
    let name = model.name;
    let at = |ending: &str| folder.join(format!("{name}{ending}"));
    let (package, dems) = (at(".pmtiles"), model.write(folder));
    built(model, &dems, &extracts[1], &package);
    let mut words = vec!["verify", text(&package), "--osm", text(&extracts[1])];
    words.extend(dems.iter().flat_map(|dem| ["--dem", text(dem)]));
    let said = done(&words);
    assert!(!said.contains("broken"), "{name}: {said}");

    let is_there = |id: i64, opposite: i64| model.is_global || id != opposite;
    let roads: Vec<_> = WAYS.iter().filter(|(id, ..)| is_there(*id, OPPOSITE)).collect();
    for (ending, options) in
        [(".gpkg", &[][..]), (".geojson", &["--crs", "EPSG:4979", "--heights", "as-is"])]
    {
        let target = at(ending);
        done(&[&["export", "roads", "-q", text(&package), "-o", text(&target)], options].concat());
        let mut found = features(&target);
        found.sort_by(|(a, _), (b, _)| a["way_id"].total_cmp(&b["way_id"]));
        let ids: Vec<i64> = found.iter().map(|(numbers, _)| numbers["way_id"] as i64).collect();
        assert_eq!(ids, roads.iter().map(|(id, ..)| *id).collect::<Vec<_>>(), "{name}");
        for ((numbers, geometry), (id, _, length_m)) in found.iter().zip(&roads) {
            let what = format!("{name}, way {id}, {ending}");
            near(&what, numbers["length_2d_m"], *length_m);
            if ending == ".geojson" {
                check_lines(&what, geometry, *length_m);
            }
        }
    }

    let target = at("-areas.geojson");
    let words = ["export", "layer", "areas", text(&package), "-q", "-o", text(&target)];
    done(&[&words[..], &["--crs", "EPSG:4326"]].concat());
    let found = features(&target);
    let forests = FORESTS.iter().filter(|(id, _)| is_there(*id, FORESTS[1].0)).count();
    assert_eq!(found.len(), forests, "{name}");
    for (numbers, geometry) in &found {
        near(&format!("{name}, a forest"), numbers["area_m2"], FOREST_M2);
        let around = geometry.envelope();
        assert!(geometry.is_valid() && around.MinX >= -180.0 && around.MaxX <= 180.0, "{name}");
        // 0.2 by 0.05 degrees.
        let area = geometry.area();
        assert!((area / 0.01 - 1.0).abs() < 1e-3, "{name}: {area} square degrees");
    }

    let told = manifest(&package);
    let kept = &e2e::layer(&told, "boundaries")["kept"];
    let borders: f64 = BORDERS.iter().map(|&(_, along)| WAYS[along].2).sum();
    near(&format!("{name}, borders"), kept[0]["length_um"].as_f64().unwrap() / 1e6, borders);
    if !model.is_global {
        // The objects on the opposite side do not affect the ground.
        let without = at("-without.pmtiles");
        built(model, &dems, &extracts[0], &without);
        let without = manifest(&without);
        let levels = |told: &Value, layer: &str| e2e::layer(told, layer)["levels"].clone();
        for layer in ["areas", "boundaries"] {
            assert_eq!(levels(&told, layer), levels(&without, layer), "{name}, {layer}");
        }
    }

    for (ending, kind, lines) in [
        ("-whole.geojson", "LineString", "[[179.9,10],[-179.9,10.01]]"),
        (
            "-cut.geojson",
            "MultiLineString",
            "[[[179.9,10],[180,10.005]],[[-180,10.005],[-179.9,10.01]]]",
        ),
    ] {
        let line = at(ending);
        let geometry = format!(r#"{{"type":"{kind}","coordinates":{lines}}}"#);
        fs::write(
            &line,
            format!(r#"{{"type":"Feature","properties":{{}},"geometry":{geometry}}}"#),
        )
        .unwrap();
        let said = done(&["profile", text(&package), "--line", text(&line)]);
        let length = said.split_whitespace().nth(1).and_then(|word| word.parse().ok());
        near(&format!("{name}, {kind}: {said}"), length.unwrap(), WAYS[0].2);
        assert!(!said.contains("parts"), "{name}, {kind}: {said}");
    }
}

/// One model per system and counting of longitudes, with all objects that cross 180°, end there, or
/// cross the opposite meridian.
#[test]
fn what_goes_over_the_end_of_the_map_is_as_long_as_on_the_earth() {
    let folder = tempfile::tempdir().unwrap();
    let extracts = [false, true].map(|with_opposite| extract(folder.path(), with_opposite));
    for model in e2e::some_of(models(), [6, 3, 1]) {
        check(&model, folder.path(), &extracts);
    }
}

/// Coastlines end at the border of the map of the whole earth, where the sea is closed.
#[test]
fn a_coast_over_the_end_of_the_map_is_closed_there() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let [dem] = &globe("coast", -180.0).write(folder.path())[..] else { panic!("one file") };
    // An island from 176° east to 176° west, and a road on it.
    let corners = [(176, 6), (-176, 6), (-176, 14), (176, 14)];
    let nodes: Vec<(i64, i64, i64)> = (1..)
        .zip(corners)
        .map(|(id, (lon, lat))| (id, lat * 10_000_000, lon * 10_000_000))
        .collect();
    let mut block = BlockBuilder::new();
    block.dense(&nodes);
    block.way(1, &[("highway", "primary")], &[1, 3]);
    block.way(2, &[("natural", "coastline")], &[1, 2, 3, 4, 1]);
    let (osm, package) = (at("coast.osm.pbf"), at("coast.pmtiles"));
    fs::write(&osm, file(&block)).unwrap();
    let defects = at("defects.csv");
    let words = ["build", "-q", "--dem", text(dem), "--osm", text(&osm), "-o", text(&package)];
    let more = ["--crs", "dem", "--layers", "areas", "--defects", text(&defects)];
    done(&[&words[..], &more].concat());
    let defects = fs::read_to_string(&defects).unwrap();
    assert!(!defects.contains("coastline"), "{defects}");
    let said = done(&["verify", text(&package), "--dem", text(dem), "--osm", text(&osm)]);
    assert!(!said.contains("broken"), "{said}");
    let target = at("sea.gpkg");
    done(&["export", "layer", "areas", text(&package), "-q", "-o", text(&target)]);
    let [(_, sea)] = &features(&target)[..] else { panic!("one sea") };
    let is_sea = |lon: f64, lat: f64| {
        sea.contains(&Geometry::from_wkt(&format!("POINT ({lon} {lat})")).unwrap())
    };
    assert!(is_sea(0.0, 10.0) && is_sea(175.5, 10.0) && is_sea(-175.5, 10.0) && is_sea(179.9, 5.0));
    assert!(!is_sea(176.5, 10.0) && !is_sea(179.9, 10.0) && !is_sea(-179.9, 10.0));
}

/// Grids may count longitudes from 0 to 360, or beyond. Positions in packages are within ±180; in
/// the header of the file the whole earth is -180 to 180, because numbers end at 214.75.
#[test]
fn what_lies_beyond_180_degrees_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let file = ([100, 100], [270.0, 0.005, 0.0, 10.3, 0.0, -0.005]);
    let model = |name, files| Model { name, epsg: 4326, files, options: &[], is_global: false };
    let regional = model("beyond", vec![file]);
    let globe = globe("globe", 0.0);
    let line = WayToWrite {
        tags: vec![("highway", "primary")],
        points_deg: vec![[-89.9, 10.0], [-89.8, 10.1]],
    };
    let osm = at("beyond.osm.pbf");
    fs::write(&osm, extract_of(&[], &[line])).unwrap();
    for (model, expected, part) in [
        (&regional, [-89.9975, -89.5025], None),
        (&globe, [-180.0, 180.0], None),
        (&globe, [-95.0, -85.0], Some("-95,2,-85,18")),
    ] {
        let package = at(&format!("{}.pmtiles", model.name));
        let dems = model.write(folder.path());
        let mut words = vec!["build", "-q", "-O", "--dem", text(&dems[0]), "-o", text(&package)];
        words.extend(["--osm", text(&osm)]);
        words.extend(model.options);
        words.extend(part.iter().flat_map(|part| ["--bounds", *part]));
        done(&words);
        let bytes = fs::read(&package).unwrap();
        // West and east of the bounds, then the middle.
        let found = [102, 110, 119]
            .map(|at| f64::from(i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())) / 1e7);
        let name = format!("{} {part:?}: {found:?}", model.name);
        assert!(
            (found[0] - expected[0]).abs() < 1e-6 && (found[1] - expected[1]).abs() < 1e-6,
            "{name}"
        );
        assert!(found[2].abs() <= 180.0, "{name}");
        let told = &manifest(&package)["wgs84_bounds"];
        if model.name == "beyond" || part.is_some() {
            assert!((told["min_x"].as_f64().unwrap() - expected[0]).abs() < 1e-6, "{told}");
        }
        let said = done(&["verify", text(&package), "--dem", text(&dems[0]), "--osm", text(&osm)]);
        assert!(!said.contains("broken"), "{name}: {said}");
        let target = at("roads.geojson");
        let words = ["export", "roads", "-q", "-O", text(&package), "-o", text(&target)];
        done(&[&words[..], &["--crs", "EPSG:4979", "--heights", "as-is"]].concat());
        let [(_, road)] = &features(&target)[..] else { panic!("one road") };
        let around = road.envelope();
        assert!((around.MinX + 89.9).abs() < 1e-6 && (around.MaxX + 89.8).abs() < 1e-6, "{name}");
        let list = at("list.csv");
        done(&["profile", text(&package), "--way", "1", "-O", "--csv", text(&list)]);
        let list = fs::read_to_string(&list).unwrap();
        let lon = list.lines().nth(1).and_then(|row| row.split(',').nth(5)).unwrap();
        if model.name == "beyond" || part.is_some() {
            assert!(lon.starts_with("-89."), "{name}: {list}");
        }
    }
}

/// A globe with one sample per cell has ground everywhere, also between its last column and its
/// first one. A grid that ends a column earlier has no ground there.
#[test]
fn a_globe_of_cells_has_no_gap_where_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let line = |points_deg: &[[f64; 2]]| WayToWrite {
        tags: vec![("highway", "primary")],
        points_deg: points_deg.to_vec(),
    };
    let osm = at("ends.osm.pbf");
    let ways = [line(&[[179.9, -16.5], [-179.9, -16.5]]), line(&[[-0.1, 16.5], [0.1, 16.6]])];
    fs::write(&osm, extract_of(&[], &ways)).unwrap();
    let lengths_m = [21_352.830, 24_045.265];
    let globe = [(-180.0, 360)];
    for (model, kept) in [
        (cells("whole", &globe, &["--crs", "dem"]), &[1, 2][..]),
        (cells("second", &globe, &["--crs", "dem", "--cell-every", "2"]), &[1, 2]),
        (cells("open-180", &[(-180.0, 359)], &["--crs", "dem"]), &[2]),
        (cells("open-0", &[(1.0, 359)], &["--crs", "dem"]), &[1]),
    ] {
        let name = model.name;
        let (package, target) = (at(&format!("{name}.pmtiles")), at(&format!("{name}.gpkg")));
        let dems = model.write(folder.path());
        let words =
            ["build", "-q", "--dem", text(&dems[0]), "--osm", text(&osm), "-o", text(&package)];
        done(&[&words[..], model.options].concat());
        let said = done(&["verify", text(&package), "--dem", text(&dems[0]), "--osm", text(&osm)]);
        assert!(!said.contains("broken"), "{name}: {said}");
        done(&["export", "roads", "-q", text(&package), "-o", text(&target)]);
        let mut found: Vec<_> = features(&target).into_iter().map(|(numbers, _)| numbers).collect();
        found.sort_by(|a, b| a["way_id"].total_cmp(&b["way_id"]));
        let ids: Vec<i64> = found.iter().map(|numbers| numbers["way_id"] as i64).collect();
        assert_eq!(ids, kept, "{name}");
        for numbers in found {
            let id = numbers["way_id"] as usize;
            near(&format!("{name}, way {id}"), numbers["length_2d_m"], lengths_m[id - 1]);
        }
    }
}
