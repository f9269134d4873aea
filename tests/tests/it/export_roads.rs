//! Exported roads, read back by OGR and compared with `info` and `tile`.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf;
use e2e::{
    Ran, build_from, copy_pass, corniche, json, manifest, real_data, text, write_ascii_grid,
};
use gdal::{
    Dataset, Metadata as _,
    spatial_ref::{AxisMappingStrategy, CoordTransform, SpatialRef},
    vector::{FieldValue, Geometry, LayerAccess as _, geometry_type_to_name},
};
use serde_json::Value;

/// A feature as OGR reads it.
struct Road {
    fields: BTreeMap<String, Option<FieldValue>>,
    lines: Vec<Vec<[f64; 3]>>,
}

impl Road {
    fn integer(&self, name: &str) -> i64 {
        match &self.fields[name] {
            Some(FieldValue::IntegerValue(value)) => i64::from(*value),
            Some(FieldValue::Integer64Value(value)) => *value,
            Some(FieldValue::StringValue(value)) => value.parse().unwrap(),
            other => panic!("{name}: {other:?}"),
        }
    }

    fn real(&self, name: &str) -> f64 {
        match &self.fields[name] {
            Some(FieldValue::RealValue(value)) => *value,
            Some(FieldValue::StringValue(value)) => value.parse().unwrap(),
            other => panic!("{name}: {other:?}"),
        }
    }

    fn text(&self, name: &str) -> Option<String> {
        self.fields[name].clone().and_then(FieldValue::into_string).filter(|text| !text.is_empty())
    }

    /// A number of any kind as text; empty if missing. 0 counts as missing: FlatGeobuf omits nulls,
    /// and `gdal` returns 0.
    fn number(&self, name: &str) -> String {
        match self.fields[name].clone() {
            None | Some(FieldValue::IntegerValue(0)) => String::new(),
            Some(FieldValue::RealValue(value)) if value.abs() < f64::EPSILON => String::new(),
            Some(FieldValue::IntegerValue(value)) => value.to_string(),
            Some(FieldValue::RealValue(value)) => value.to_string(),
            Some(FieldValue::StringValue(value)) => value,
            other => panic!("{name}: {other:?}"),
        }
    }

    fn way_id(&self) -> i64 {
        self.integer("way_id")
    }

    fn vertices(&self) -> usize {
        self.lines.iter().map(Vec::len).sum()
    }
}

fn lines_of(geometry: &Geometry) -> Vec<Vec<[f64; 3]>> {
    (0..geometry.geometry_count())
        .map(|part| {
            let mut points = Vec::new();
            geometry.get_geometry(part).get_points(&mut points);
            points.into_iter().map(|(x, y, z)| [x, y, z]).collect()
        })
        .collect()
}

/// All roads of a file, by way and piece.
fn read(path: &Path) -> Vec<Road> {
    let dataset = Dataset::open(path).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let mut roads: Vec<Road> = layer
        .features()
        .map(|feature| {
            let geometry = feature.geometry().unwrap();
            assert_eq!(geometry_type_to_name(geometry.geometry_type()), "3D Multi Line String");
            Road { fields: feature.fields().collect(), lines: lines_of(geometry) }
        })
        .collect();
    let piece = |road: &Road| {
        let tile = road.fields.get("tile").map(|_| road.text("tile"));
        (road.way_id(), tile, road.fields.get("part").map(|_| road.integer("part")))
    };
    roads.sort_by_key(piece);
    roads
}

fn export(package: &Path, target: &Path, options: &[&str]) -> Ran {
    let mut arguments = vec!["export", "roads", text(package), "-o", text(target)];
    arguments.extend(options);
    corniche(arguments)
}

/// Exports and reads back.
fn exported(package: &Path, target: &Path, options: &[&str]) -> Vec<Road> {
    let ran = export(package, target, options);
    assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
    read(target)
}

/// A line of a tile, as `corniche tile` prints it, in coordinates of the CRS.
struct TileLine {
    tile: String,
    way_id: i64,
    part: i64,
    line: Vec<[f64; 3]>,
}

fn tile_lines(package: &Path, level: u64) -> Vec<TileLine> {
    let tiles = json(&["info", text(package), "--json"])["tiles"].take();
    let of_level = format!("{level}/");
    let ids: Vec<String> = serde_json::from_value(tiles).unwrap();
    let mut lines = Vec::new();
    for id in ids.into_iter().filter(|id| id.starts_with(&of_level)) {
        let dump = json(&["tile", text(package), &id, "--json", "--coordinates", "crs"]);
        for road in dump["roads_geo"].as_array().unwrap() {
            lines.push(TileLine {
                tile: id.clone(),
                way_id: road["way_id"].as_i64().unwrap(),
                part: road["part"].as_i64().unwrap(),
                line: serde_json::from_value(road["line"].clone()).unwrap(),
            });
        }
    }
    lines
}

/// Segments of lines, with their heights: by way and both ends in plan, to the last bit.
type Segments = BTreeMap<(i64, [u64; 4]), Vec<[f64; 2]>>;

fn segments<'a>(lines: impl Iterator<Item = (i64, &'a Vec<[f64; 3]>)>) -> Segments {
    let mut segments = Segments::new();
    for (way_id, line) in lines {
        for pair in line.windows(2) {
            let ends = [pair[0][0], pair[0][1], pair[1][0], pair[1][1]].map(f64::to_bits);
            segments.entry((way_id, ends)).or_default().push([pair[0][2], pair[1][2]]);
        }
    }
    segments
}

fn level_of(package: &Path) -> u64 {
    manifest(package)["frame"]["max_level"].as_u64().unwrap()
}

/// The roads of a file are the lines of the tiles: the segments are the same, in plan to the last
/// bit, in height to the millimetre. Counts and lengths are those of `info`.
fn is_the_package(package: &Path, roads: &[Road]) {
    let manifest = manifest(package);
    let counts = &manifest["counts"];
    assert_eq!(roads.len() as u64, counts["roads_kept"].as_u64().unwrap());
    let length_m: f64 = roads.iter().map(|road| road.real("length_2d_m")).sum();
    let kept_m = counts["roads_kept_um"].as_f64().unwrap() / 1e6;
    // Each clip at a border or at an edge of the ground is rounded to the lattice.
    assert!((length_m - kept_m).abs() < 1e-6 * kept_m, "{length_m} m, not {kept_m} m");
    let pieces = tile_lines(package, level_of(package));
    let found =
        segments(roads.iter().flat_map(|road| road.lines.iter().map(|line| (road.way_id(), line))));
    let expected = segments(pieces.iter().map(|piece| (piece.way_id, &piece.line)));
    assert!(found.len() > 100);
    assert!(found.keys().eq(expected.keys()), "other segments");
    for (found, expected) in found.values().flatten().zip(expected.values().flatten()) {
        for end in 0..2 {
            assert!((found[end] - expected[end]).abs() < 1e-3, "{found:?} {expected:?}");
        }
    }
    // Pieces are joined: fewer lines than pieces, and each join is one vertex.
    let lines: usize = roads.iter().map(|road| road.lines.len()).sum();
    assert!(lines < pieces.len(), "{lines} lines of {} pieces", pieces.len());
    let vertices: usize = roads.iter().map(Road::vertices).sum();
    let in_pieces: usize = pieces.iter().map(|piece| piece.line.len()).sum();
    assert_eq!(vertices, in_pieces - (pieces.len() - lines));
    points_add_up(package, &manifest, roads);
    for road in roads {
        assert_eq!(road.integer("vertices_out") as usize, road.vertices());
        assert_eq!(road.integer("parts") as usize, road.lines.len());
        assert!(road.integer("vertices_in") <= road.integer("vertices_out"));
        let (plan_m, space_m) = (road.real("length_2d_m"), road.real("length_3d_m"));
        assert!(space_m >= plan_m && plan_m > 0.0, "{plan_m} {space_m}");
        if road.integer("bridge") + road.integer("tunnel") > 0 {
            // The ascents and descents of the ground do not apply to them. FlatGeobuf has no nulls,
            // and `gdal` reads 0.
            assert!(road.number("ascent_m").is_empty() && road.number("steepest_pct").is_empty());
            continue;
        }
        let rise_m: f64 = road.lines.iter().map(|line| line[line.len() - 1][2] - line[0][2]).sum();
        let climbed_m = road.real("ascent_m") - road.real("descent_m");
        assert!((climbed_m - rise_m).abs() < 1e-4, "way {}: {climbed_m} {rise_m}", road.way_id());
    }
}

/// The points before draping are those that the build counted for the level; if roads were lost,
/// they are a part of those.
fn points_add_up(package: &Path, manifest: &Value, roads: &[Road]) {
    let growth = json(&["growth", text(package), "--json"]);
    let counted =
        growth["levels"].as_array().unwrap().last().unwrap()["simplified_vertices"].clone();
    let points: i64 = roads.iter().map(|road| road.integer("vertices_in")).sum();
    let losses = manifest["counts"]["roads_lost"].as_array().unwrap();
    if losses.iter().all(|loss| loss["length_um"] == 0) {
        assert_eq!(points, counted.as_i64().unwrap());
    } else {
        let share = points as f64 / counted.as_f64().unwrap();
        assert!((0.95..=1.0).contains(&share), "{points} of {counted}");
    }
}

fn pass(folder: &Path) -> PathBuf {
    let package = folder.join("pass.pmtiles");
    copy_pass(&package, &["--quiet"]);
    package
}

#[test]
fn roads_read_back_are_those_of_the_package() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let target = folder.path().join("roads.gpkg");
    is_the_package(&package, &exported(&package, &target, &[]));
    let dataset = Dataset::open(&target).unwrap();
    let credit = dataset.metadata_item("ATTRIBUTION", "").unwrap();
    assert!(credit.contains("© OpenStreetMap contributors"), "{credit}");
    let layer = dataset.layer(0).unwrap();
    assert_eq!(layer.name(), "roads");
    assert_eq!(layer.spatial_ref().unwrap().auth_code().unwrap(), 32632);
}

#[test]
fn the_roads_of_liechtenstein_are_those_of_the_package() {
    let (Some(west), Some(east), Some(osm)) = (
        real_data("liechtenstein/N47E009.hgt"),
        real_data("liechtenstein/N47E010.hgt"),
        real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf"),
    ) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("li.pmtiles");
    let ran = corniche([
        "build",
        "--dem",
        text(&west),
        text(&east),
        "--osm",
        text(&osm),
        "-o",
        text(&package),
        "-q",
        "--dem-vertical-crs",
        "EPSG:5773",
    ]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let target = folder.path().join("roads.fgb");
    is_the_package(&package, &exported(&package, &target, &[]));
    let wkt = Dataset::open(&target).unwrap().layer(0).unwrap().spatial_ref().unwrap().to_wkt();
    assert!(wkt.unwrap().contains("EGM96 height"));
}

/// All formats have the same roads; CSV and GeoJSON round to less than a millimetre. (GDAL drops
/// the last of nine decimals after five zeros.)
#[test]
fn all_formats_have_the_same_roads() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let own = |name: &str| exported(&package, &folder.path().join(name), &[]);
    let degrees = |name: &str| {
        let options = ["--crs", "EPSG:4979", "--heights", "as-is"];
        exported(&package, &folder.path().join(name), &options)
    };
    let expected = own("a.gpkg");
    for (roads, largest) in [(own("a.fgb"), 0.0), (own("a.csv"), 1e-6)] {
        same(&expected, &roads, [largest; 3]);
    }
    let expected = degrees("b.gpkg");
    for (roads, largest) in [
        (degrees("b.fgb"), [0.0; 3]),
        (degrees("b.csv"), [1e-11, 1e-11, 1e-6]),
        (degrees("b.geojson"), [1e-8, 1e-8, 1e-5]),
    ] {
        same(&expected, &roads, largest);
    }
    let geojson: Value =
        serde_json::from_slice(&fs::read(folder.path().join("b.geojson")).unwrap()).unwrap();
    assert_eq!(geojson["attribution"], "© OpenStreetMap contributors, ODbL 1.0");
    assert!(geojson.get("crs").is_none(), "RFC 7946 has one CRS");
}

fn same(expected: &[Road], found: &[Road], largest: [f64; 3]) {
    assert_eq!(expected.len(), found.len());
    for (expected, found) in expected.iter().zip(found) {
        assert_eq!(expected.way_id(), found.way_id());
        for name in ["class", "bridge", "tunnel", "layer", "vertices_in", "vertices_out", "parts"] {
            assert_eq!(expected.integer(name), found.integer(name), "{name}");
        }
        for name in [
            "name",
            "ref",
            "surface",
            "oneway",
            "form",
            "highway",
            "maxspeed",
            "sac_scale",
            "tracktype",
        ] {
            assert_eq!(expected.text(name), found.text(name), "{name}");
        }
        for name in ["lanes", "width"] {
            assert_eq!(expected.number(name), found.number(name), "{name}");
        }
        // Some formats convert nulls to 0, and some omit them.
        let number = |road: &Road, name: &str| road.number(name).parse().unwrap_or(0.0);
        for name in ["length_2d_m", "length_3d_m", "ascent_m", "descent_m", "height_tolerance_m"] {
            let (expected, found): (f64, f64) = (number(expected, name), number(found, name));
            assert!((expected - found).abs() < 1e-6, "{name}");
        }
        assert_eq!(expected.lines.len(), found.lines.len());
        for (expected, found) in expected.lines.iter().flatten().zip(found.lines.iter().flatten()) {
            for axis in 0..3 {
                assert!(
                    (expected[axis] - found[axis]).abs() <= largest[axis],
                    "{expected:?} {found:?}"
                );
            }
        }
    }
}

/// The vertical datum of a package that does not record one may be given for an export, with the
/// same result as in the build. It cannot be given twice, nor be in feet, because the build has
/// interpreted the numbers as metres.
#[test]
fn the_datum_may_be_said_when_roads_are_exported() {
    let folder = tempfile::tempdir().unwrap();
    let [plain, told] = ["plain", "told"].map(|name| folder.path().join(format!("{name}.pmtiles")));
    copy_pass(&plain, &["--quiet"]);
    copy_pass(&told, &["--quiet", "--dem-vertical-crs", "EPSG:5773"]);
    let said = ["--dem-vertical-crs", "EPSG:5773"];
    for (crs, name) in [("package", "own.csv"), ("EPSG:4979", "earth.csv")] {
        let at = |package: &str| folder.path().join(format!("{package}-{name}"));
        let (late, early) = (at("late"), at("early"));
        let _ = exported(&plain, &late, &[&["--crs", crs], &said[..]].concat());
        let _ = exported(&told, &early, &["--crs", crs]);
        assert_eq!(fs::read(late).unwrap(), fs::read(early).unwrap(), "{crs}");
    }
    let layer = folder.path().join("late.gpkg");
    let _ = exported(&plain, &layer, &said);
    let crs = Dataset::open(&layer).unwrap().layer(0).unwrap().spatial_ref().unwrap();
    assert!(crs.is_compound() && crs.to_wkt().unwrap().contains("EGM96 height"));
    let out = folder.path().join("refused.gpkg");
    for (package, crs, words) in [
        (&told, "EPSG:5773", ["is already known, \"EGM96 height\"", "omit --dem-vertical-crs"]),
        (&plain, "EPSG:6360", ["not in metres upwards", "build it again"]),
        (&plain, "EPSG:4326", ["--dem-vertical-crs", "EPSG:4326"]),
    ] {
        let line = ["export", "roads", text(package), "-o", text(&out), "--dem-vertical-crs", crs];
        let ran = corniche(line);
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{crs}: {}", ran.err);
        assert!(!out.exists(), "{crs}");
    }
}

/// Positions in EPSG:4979 are those that PROJ gives for the compound CRS, to a centimetre. PROJ's
/// grid for it comes with PROJ.
#[test]
fn ellipsoidal_heights_are_those_of_proj() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    copy_pass(&package, &["--quiet", "--dem-vertical-crs", "EPSG:5773"]);
    let own = folder.path().join("own.gpkg");
    let own_roads = exported(&package, &own, &[]);
    let layer_crs = Dataset::open(&own).unwrap().layer(0).unwrap().spatial_ref().unwrap();
    assert!(layer_crs.is_compound() && layer_crs.to_wkt().unwrap().contains("EGM96 height"));
    let target = folder.path().join("earth.gpkg");
    let roads = exported(&package, &target, &["--crs", "EPSG:4979"]);
    let crs = |text: &str| {
        let mut crs = SpatialRef::from_definition(text).unwrap();
        crs.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        crs
    };
    let to_earth = CoordTransform::new(&crs("EPSG:32632+5773"), &crs("EPSG:4979")).unwrap();
    let mut geoid_m: Vec<f64> = Vec::new();
    for (own, found) in own_roads.iter().zip(&roads) {
        for (own, found) in own.lines.iter().flatten().zip(found.lines.iter().flatten()) {
            let (mut x, mut y, mut z) = ([own[0]], [own[1]], [own[2]]);
            to_earth.transform_coords(&mut x, &mut y, &mut z).unwrap();
            let [lon, lat, height_m] = *found;
            assert!(
                (lon - x[0]).abs() < 1e-7 && (lat - y[0]).abs() < 1e-7,
                "{found:?} {x:?} {y:?}"
            );
            assert!((height_m - z[0]).abs() < 0.01, "{height_m} {z:?}");
            geoid_m.push(height_m - own[2]);
        }
    }
    // In the Alps the geoid of EGM96 is some 48 m above the ellipsoid: the conversion was not
    // skipped.
    assert!(geoid_m.iter().all(|metres| (45.0..55.0).contains(metres)), "{:?}", geoid_m.first());
    let crs = Dataset::open(&target).unwrap().layer(0).unwrap().spatial_ref().unwrap();
    assert_eq!(crs.auth_code().unwrap(), 4979);
}

/// With --pieces each line of a tile is a feature, with its tile and part, as `tile` has it.
#[test]
fn pieces_are_the_lines_of_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    for (level, options) in
        [(level_of(&package), &["--pieces"][..]), (1, &["--pieces", "--level", "1"][..])]
    {
        let target = folder.path().join(format!("{level}.fgb"));
        let roads = exported(&package, &target, options);
        let mut pieces = tile_lines(&package, level);
        pieces.sort_by_key(|piece| (piece.way_id, piece.tile.clone(), piece.part));
        assert_eq!(roads.len(), pieces.len());
        for (road, piece) in roads.iter().zip(&pieces) {
            let key = (road.way_id(), road.text("tile").unwrap(), road.integer("part"));
            assert_eq!(key, (piece.way_id, piece.tile.clone(), piece.part));
            assert_eq!(road.lines, std::slice::from_ref(&piece.line));
        }
    }
}

/// Coarser levels have fewer classes and simpler lines.
#[test]
fn another_level_has_the_roads_of_that_level() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let finest = exported(&package, &folder.path().join("finest.gpkg"), &[]);
    let root = exported(&package, &folder.path().join("root.gpkg"), &["--level", "0"]);
    let ways = |lines: &[TileLine]| -> Vec<i64> {
        let mut ways: Vec<i64> = lines.iter().map(|line| line.way_id).collect();
        ways.sort_unstable();
        ways.dedup();
        ways
    };
    assert_eq!(root.iter().map(Road::way_id).collect::<Vec<_>>(), ways(&tile_lines(&package, 0)));
    assert!(!root.is_empty() && root.len() < finest.len());
}

/// Four rectangles that share a corner have all roads between them: their lengths add up. No road
/// is outside.
#[test]
fn roads_are_cut_at_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let whole: f64 = exported(&package, &folder.path().join("all.gpkg"), &[])
        .iter()
        .map(|road| road.real("length_2d_m"))
        .sum();
    let degrees = ["--crs", "EPSG:4979", "--heights", "as-is"];
    let mut length_m = 0.0;
    for [west, south, east, north] in [
        [9.0, 46.0, 9.51, 46.91],
        [9.51, 46.0, 10.0, 46.91],
        [9.0, 46.91, 9.51, 47.0],
        [9.51, 46.91, 10.0, 47.0],
    ] {
        let bounds = format!("{west},{south},{east},{north}");
        let target = folder.path().join(format!("{west}-{south}.gpkg"));
        let options = [&degrees[..], &["--bounds", &bounds]].concat();
        let roads = exported(&package, &target, &options);
        assert!(roads.len() > 3 && roads.len() < 67, "{}", roads.len());
        for [lon, lat, _] in roads.iter().flat_map(|road| road.lines.iter().flatten()) {
            // Rectangles are clipped by a table that is accurate to a centimetre.
            let room = 2e-7;
            assert!((west - room..=east + room).contains(lon), "{lon} {bounds}");
            assert!((south - room..=north + room).contains(lat), "{lat} {bounds}");
        }
        length_m += roads.iter().map(|road| road.real("length_2d_m")).sum::<f64>();
    }
    assert!((length_m - whole).abs() < 1e-6 * whole, "{length_m} {whole}");
}

/// Classes are selected correctly, and add up to all roads.
#[test]
fn classes_can_be_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let of = |classes: &str| {
        let target = folder.path().join(format!("{classes}.fgb"));
        exported(&package, &target, &["--classes", classes])
    };
    let (few, many) = (of("0,2-3"), of("1,4-8"));
    assert!(few.iter().all(|road| [0, 2, 3].contains(&road.integer("class"))));
    assert_eq!((few.len(), many.len()), (27, 40));
    let none = of("8");
    assert!(none.is_empty(), "an empty layer is a layer");
}

/// The same roads produce the same bytes, whatever the date and the file name.
#[test]
fn the_same_roads_make_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let package = pass(folder.path());
    let options = ["--crs", "EPSG:4979", "--heights", "as-is"];
    for ending in ["gpkg", "fgb", "geojson", "csv"] {
        let [one, two] = ["one", "two"].map(|name| {
            let target = folder.path().join(format!("{name}.{ending}"));
            assert_eq!(export(&package, &target, &options).code, 0);
            std::thread::sleep(std::time::Duration::from_millis(1100));
            fs::read(target).unwrap()
        });
        assert!(one == two, "{ending}: other bytes");
    }
}

/// A road due east on a plane: UTM at its central meridian, so lengths, grade and climb are known.
#[test]
fn a_road_on_a_plane_is_measured_in_closed_form() {
    const GRADE: f64 = 0.08;
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] =
        ["plane.asc", "plane.osm.pbf", "plane.pmtiles"].map(|name| folder.path().join(name));
    let place = "xllcenter 497000\nyllcenter 5197000\ncellsize 10\nNODATA_value -9999";
    write_ascii_grid(&dem, [601, 601], place, |column, _| 500.0 + GRADE * 10.0 * column as f64);
    let points_deg = (0..=60).map(|k| [8.98 + 0.04 * f64::from(k) / 60.0, 46.945]).collect();
    let tags = vec![("highway", "primary"), ("name", "Rampe"), ("oneway", "-1")];
    fs::write(&osm, pbf::extract(&[], &[pbf::WayToWrite { tags, points_deg }])).unwrap();
    build_from([&dem, &osm], &package, &["-q", "--dem-crs", "EPSG:32632"]);
    let roads = exported(&package, &folder.path().join("plane.gpkg"), &[]);
    let [road] = &roads[..] else { panic!("{} roads", roads.len()) };
    // 0.04 degrees of the parallel at 46.945° on WGS84: N cos φ.
    let latitude = 46.945_f64.to_radians();
    let e2 = 0.006_694_379_990_14;
    let parallel_m = 6_378_137.0 / (1.0 - e2 * latitude.sin().powi(2)).sqrt() * latitude.cos();
    let length_m = parallel_m * 0.04_f64.to_radians();
    let near = |name: &str, expected: f64, largest: f64| {
        let found = road.real(name);
        assert!((found - expected).abs() < largest, "{name}: {found}, not {expected}");
    };
    near("length_2d_m", length_m, 0.01);
    // Off the central meridian a true metre is 0.9996 m of the map, on which the plane rises.
    let grade = GRADE * 0.9996;
    near("ascent_m", length_m * grade, 0.1);
    near("descent_m", 0.0, 0.01);
    near("length_3d_m", length_m * grade.hypot(1.0), 0.02);
    // Heights are whole quanta, 1/16 m at most.
    near("steepest_pct", 100.0 * grade, 0.35);
    assert_eq!((road.integer("vertices_in"), road.integer("parts")), (61, 1));
    assert_eq!((road.integer("tunnel"), road.integer("bridge"), road.integer("class")), (0, 0, 2));
    assert_eq!(
        (road.text("oneway").as_deref(), road.text("name").as_deref()),
        (Some("-1"), Some("Rampe"))
    );
    assert_eq!(road.text("surface"), None);
}

/// Across the antimeridian: one line in the package's CRS, with continuous longitudes; two in
/// EPSG:4979; clipped by bounds with west > east.
#[test]
fn roads_cross_the_antimeridian() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] =
        ["fiji.asc", "fiji.osm.pbf", "fiji.pmtiles"].map(|name| folder.path().join(name));
    let place = "xllcenter 179.9\nyllcenter -16.6\ncellsize 0.001\nNODATA_value -9999";
    write_ascii_grid(&dem, [201, 201], place, |column, row| (column + 2 * row) as f64);
    let points_deg = vec![[179.95, -16.5], [179.99, -16.51], [-179.96, -16.49]];
    let line = pbf::WayToWrite { tags: vec![("highway", "primary")], points_deg };
    fs::write(&osm, pbf::extract(&[], &[line])).unwrap();
    build_from([&dem, &osm], &package, &["-q", "--dem-crs", "EPSG:4326"]);
    let own = exported(&package, &folder.path().join("own.gpkg"), &[]);
    let [line] = &own[0].lines[..] else { panic!("{} lines", own[0].lines.len()) };
    assert!(line.windows(2).all(|pair| (pair[1][0] - pair[0][0]).abs() < 1.0));
    assert!((line[line.len() - 1][0] - line[0][0] - 0.09).abs() < 1e-6);
    let options = ["--crs", "EPSG:4979", "--heights", "as-is"];
    let earth = exported(&package, &folder.path().join("earth.geojson"), &options);
    let [west, east] = &earth[0].lines[..] else { panic!("{} lines", earth[0].lines.len()) };
    assert_eq!((west[west.len() - 1][0], east[0][0]), (180.0, -180.0));
    assert_eq!(west[west.len() - 1][1..], east[0][1..]);
    let bounds = [&options[..], &["--bounds", "179.98,-17,-179.98,-16"]].concat();
    let cut = exported(&package, &folder.path().join("cut.gpkg"), &bounds);
    let longitudes: Vec<f64> = cut[0].lines.iter().flatten().map(|position| position[0]).collect();
    assert!(
        (longitudes[0] - 179.98).abs() < 1e-6
            && (longitudes[longitudes.len() - 1] + 179.98).abs() < 1e-6
    );
}
