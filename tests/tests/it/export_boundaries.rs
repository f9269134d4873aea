//! Exported boundaries, read back by OGR and compared with those that osmium finds in the extract.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{Ran, corniche, extract_with_boundaries, json, sample, skip, text};
use gdal::{
    Dataset,
    vector::{FieldValue, LayerAccess as _},
};

type Line = Vec<[f64; 2]>;

/// A feature: class, level, names, length, lines.
#[derive(Debug, PartialEq)]
struct Exported {
    class: String,
    admin_level: Option<i64>,
    names: Option<String>,
    length_m: f64,
    lines: Vec<Line>,
}

fn built(folder: &Path, dem: &Path, osm: &Path, more: &[&str]) -> PathBuf {
    let package = folder.join("package.pmtiles");
    let inputs = ["build", "-q", "--dem", text(dem), "--osm", text(osm), "-o", text(&package)];
    let ran = corniche([&inputs[..], more].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

fn export(package: &Path, what: &str, file: &Path, more: &[&str]) -> Ran {
    corniche([&["export", what, text(package), "-O", "-o", text(file)], more].concat())
}

/// The features that OGR reads from a file, by way.
fn read(file: &Path) -> BTreeMap<i64, Exported> {
    let dataset = Dataset::open(file).unwrap();
    let mut layer = dataset.layer(0).unwrap();
    let features = layer.features().map(|feature| {
        let of = |name: &str| {
            let index = feature.field_index(name).unwrap();
            let text = feature.field_as_string(index).unwrap();
            text.filter(|text| !text.is_empty()).and_then(|_| feature.field(index).unwrap())
        };
        let number = |name: &str| match of(name)? {
            FieldValue::IntegerValue(value) => Some(i64::from(value)),
            FieldValue::Integer64Value(value) => Some(value),
            FieldValue::StringValue(value) => value.parse().ok(),
            other => panic!("{name} is {other:?}"),
        };
        let length_m = match of("length_m") {
            Some(FieldValue::RealValue(value)) => value,
            Some(FieldValue::StringValue(value)) => value.parse().unwrap(),
            other => panic!("{other:?}"),
        };
        let Some(FieldValue::StringValue(class)) = of("class") else { panic!("no class") };
        let geometry = feature.geometry().unwrap();
        let lines: Vec<Line> = (0..geometry.geometry_count())
            .map(|part| {
                let part = geometry.get_geometry(part);
                let place = |index| part.get_point(index as i32);
                (0..part.point_count()).map(place).map(|(x, y, _)| [x, y]).collect()
            })
            .collect();
        let points: usize = lines.iter().map(Vec::len).sum();
        assert_eq!(number("points"), Some(points as i64));
        assert_eq!(number("parts"), Some(lines.len() as i64));
        let admin_level = number("admin_level");
        // Without an extract the field does not exist.
        let index = feature.field_index("names").ok();
        let names = index.and_then(|index| feature.field_as_string(index).unwrap());
        (number("way_id").unwrap(), Exported { class, admin_level, names, length_m, lines })
    });
    features.collect()
}

/// Length of a line in degrees by the radii of the ellipsoid of WGS84 in the middle of each segment
/// (EPSG guidance note 7-2): good to 1e-6 for segments of some kilometres.
fn length_m(line: &[[f64; 2]]) -> f64 {
    let segment = |[from, to]: &[[f64; 2]; 2]| {
        let sine = f64::midpoint(from[1], to[1]).to_radians().sin();
        let (a, e2) = (6_378_137.0, 0.006_694_379_990_14);
        let w2 = 1.0 - e2 * sine * sine;
        let north = (to[1] - from[1]).to_radians() * a * (1.0 - e2) / w2.powf(1.5);
        let cosine = (1.0 - sine * sine).sqrt();
        let east = (to[0] - from[0]).to_radians() * a / w2.sqrt() * cosine;
        east.hypot(north)
    };
    line.array_windows().map(segment).sum()
}

/// Whether a line has these points, each to 0.1 m and the rounding of the lattice.
fn is_same(found: &[[f64; 2]], points: &[[f64; 2]]) -> bool {
    let near = |(one, other): (&[f64; 2], &[f64; 2])| length_m(&[*one, *other]) < 0.11;
    found.len() == points.len() && found.iter().zip(points).all(near)
}

/// Across borders of tiles each way comes back unchanged, once, in each format.
#[test]
fn boundaries_come_back_whole_in_each_format() {
    let folder = tempfile::tempdir().unwrap();
    let osm = extract_with_boundaries(folder.path());
    let more = ["--max-error", "10", "--boundaries", "on"];
    let package = built(folder.path(), &sample("pass/pass-dem.tif"), &osm, &more);
    let place = |x: i32, y: i32| [9.5 + 0.005 * f64::from(x), 46.87 + 0.004 * f64::from(y)];
    let expected: [(i64, &str, Option<i64>, Line); 3] = [
        (2, "admin-2", Some(2), vec![place(1, 2), place(4, 4), place(8, 3)]),
        (3, "admin-6", Some(6), vec![place(8, 3), place(7, 8), place(2, 7), place(1, 2)]),
        (4, "protected", None, vec![place(4, 4), place(6, 5), place(5, 7), place(4, 4)]),
    ];
    for ending in ["gpkg", "fgb", "csv", "geojson"] {
        let file = folder.path().join(format!("boundaries.{ending}"));
        let ran = export(&package, "boundaries", &file, &["--crs", "EPSG:4326"]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains("3 ways of level") && ran.err.contains("3 lines"), "{}", ran.err);
        assert!(ran.err.contains("© OpenStreetMap contributors"), "{}", ran.err);
        let found = read(&file);
        assert_eq!(found.len(), 3, "{ending}");
        for (way_id, class, admin_level, line) in &expected {
            let way = &found[way_id];
            assert_eq!((way.class.as_str(), way.admin_level), (*class, *admin_level), "{ending}");
            assert!(way.lines.len() == 1 && is_same(&way.lines[0], line), "{ending}: {way:?}");
            let ratio = way.length_m / length_m(line);
            assert!((ratio - 1.0).abs() < 1e-4, "{ending}, way {way_id}: {ratio}");
        }
    }

    let file = folder.path().join("boundaries.csv");
    assert_eq!(export(&package, "boundaries", &file, &[]).code, 0);
    tiles_have_the_parts(&package, &read(&file)[&2].lines[0]);
    let ran = export(&package, "boundaries", &file, &["--classes", "protected,admin-6"]);
    assert_eq!((ran.code, read(&file).into_keys().collect::<Vec<_>>()), (0, vec![3, 4]));
    // Districts are not stored at this cell size.
    assert_eq!(export(&package, "boundaries", &file, &["--level", "0"]).code, 0);
    let refused = |ran: Ran, why: &str| {
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(ran.err.contains(why), "{}", ran.err);
    };
    refused(export(&package, "boundaries", &file, &["--classes", "admin-9"]), "are admin-2, ");
    refused(export(&package, "areas", &file, &[]), "it was built without --areas");
    let geojson = folder.path().join("boundaries.geojson");
    refused(export(&package, "boundaries", &geojson, &["--crs", "package"]), "RFC 7946");
}

/// Each segment of way 2, in the package's CRS, is in the JSON of some tile, with the way's class.
fn tiles_have_the_parts(package: &Path, line: &[[f64; 2]]) {
    let ids = json(&["info", text(package), "--json"])["tiles"].clone();
    let mut found = [false; 2];
    for tile in ids.as_array().unwrap() {
        let id = tile.as_str().unwrap();
        let document = json(&["tile", text(package), id, "--json", "--coordinates", "crs"]);
        let none = Vec::new();
        for part in document["boundaries"].as_array().unwrap_or(&none) {
            if part["way_id"] != 2 {
                continue;
            }
            assert_eq!((&part["class"], &part["admin_level"]), (&"admin-2".into(), &2.into()));
            let points: Line = serde_json::from_value(part["line"].clone()).unwrap();
            let ends = line.array_windows::<2>().zip(&mut found);
            ends.for_each(|(ends, found)| {
                let near = |one: &[f64; 2], other: &[f64; 2]| {
                    (one[0] - other[0]).hypot(one[1] - other[1]) < 1e-6
                };
                let is_same = |segment: &[[f64; 2]; 2]| {
                    near(&segment[0], &ends[0]) && near(&segment[1], &ends[1])
                };
                *found |= points.array_windows::<2>().any(is_same);
            });
        }
    }
    assert_eq!(found, [true; 2]);
}

/// The lines of an OPL file with the positions of ways.
fn opl_of_osmium(extract: &Path, folder: &Path) -> Option<String> {
    let opl = folder.join("ways.opl");
    let mut command = Command::new("osmium");
    command.args(["add-locations-to-ways", "-O", "-f", "opl", "-o"]).arg(&opl).arg(extract);
    assert!(command.output().ok()?.status.success());
    Some(std::fs::read_to_string(&opl).unwrap())
}

/// The positions of each way.
fn ways_of(opl: &str) -> BTreeMap<i64, Line> {
    let way = |line: &str| {
        let id = line.strip_prefix('w')?.split(' ').next()?.parse().ok()?;
        let nodes = line.split(' ').find_map(|field| field.strip_prefix('N'))?;
        let place = |node: &str| {
            let (lon, lat) = node.split_once('x')?.1.split_once('y')?;
            Some([lon.parse().ok()?, lat.parse().ok()?])
        };
        let places: Option<Line> = nodes.split(',').map(place).collect();
        Some((id, places?))
    };
    opl.lines().filter_map(way).collect()
}

/// The names, by way and class: those of the relations that refer to the way, and its own if it is
/// closed.
fn names_of(opl: &str) -> BTreeMap<i64, BTreeMap<String, BTreeSet<String>>> {
    // OPL escapes its special characters, and those beyond ASCII, as numbers between percent signs.
    let plain = |text: &str| -> String {
        let part = |(place, part): (usize, &str)| match place % 2 {
            0 => part.to_owned(),
            _ => u32::from_str_radix(part, 16).ok().and_then(char::from_u32).unwrap().to_string(),
        };
        text.split('%').enumerate().map(part).collect()
    };
    let mut names: BTreeMap<i64, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for line in opl.lines() {
        let field = |letter| line.split(' ').find_map(|field| field.strip_prefix(letter));
        let tags = field('T').unwrap_or_default().split(',');
        let tags: BTreeMap<&str, &str> = tags.filter_map(|tag| tag.split_once('=')).collect();
        let class = match (tags.get("boundary"), tags.get("admin_level")) {
            (Some(&"administrative"), Some(&level @ ("2" | "3" | "4" | "5" | "6" | "7" | "8"))) => {
                format!("admin-{level}")
            }
            (Some(&"protected_area" | &"national_park"), _) => "protected".to_owned(),
            _ => continue,
        };
        let Some(name) = tags.get("name") else { continue };
        let mut tell = |way_id: &str| {
            let by_class = names.entry(way_id.parse().unwrap()).or_default();
            by_class.entry(class.clone()).or_default().insert(plain(name));
        };
        if let Some(way) = line.strip_prefix('w') {
            let nodes: Vec<&str> = field('N').unwrap().split(',').collect();
            if nodes.first() == nodes.last() {
                tell(way.split(' ').next().unwrap());
            }
        } else if matches!(tags.get("type"), Some(&"boundary" | &"multipolygon")) {
            for member in field('M').unwrap().split(',') {
                let (way, role) = member.split_once('@').unwrap();
                if let (Some(way), "" | "outer" | "inner") = (way.strip_prefix('w'), role) {
                    tell(way);
                }
            }
        }
    }
    names
}

/// A country: the exported ways are exactly those that osmium lists, to the lattice's rounding,
/// with the names of the bounded areas.
#[test]
fn boundaries_of_a_country_are_the_ways_of_osmium() {
    let folder = tempfile::tempdir().unwrap();
    let osm = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let Some(opl) = opl_of_osmium(&osm, folder.path()) else {
        return skip("there is no program osmium (Debian: osmium-tool)");
    };
    let (ways, names) = (ways_of(&opl), names_of(&opl));
    let more = ["--max-error", "30", "--boundaries", "on", "--classes", "0"];
    let dem = sample("liechtenstein/liechtenstein-dem.tif");
    let package = built(folder.path(), &dem, &osm, &more);
    let file = folder.path().join("boundaries.fgb");
    let options = ["--crs", "EPSG:4326", "--osm", text(&osm)];
    let ran = export(&package, "boundaries", &file, &options);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let found = read(&file);
    assert!(found.len() > 60, "{} ways", found.len());
    let mut whole = 0;
    for (way_id, Exported { length_m: told_m, lines, names: told, .. }) in &found {
        let told = told.as_ref().map(|told| serde_json::from_str(told).unwrap());
        assert_eq!(told.as_ref(), names.get(way_id), "way {way_id}");
        let mut expected = ways[way_id].clone();
        expected.dedup();
        // A boundary that leaves the ground has several lines.
        if let [line] = &lines[..]
            && line.len() == expected.len()
        {
            assert!(is_same(line, &expected), "way {way_id}");
            let ratio = told_m / length_m(&expected);
            assert!((ratio - 1.0).abs() < 2e-3, "way {way_id}: {ratio}");
            whole += 1;
        }
    }
    assert!(whole * 10 > found.len() * 9, "{whole} of {} ways", found.len());
    let named = found.values().filter(|way| way.names.is_some()).count();
    assert!(named > 60, "{named} ways with names");
    let other = sample("pass/pass.osm.pbf");
    let ran = export(&package, "boundaries", &file, &["--osm", text(&other)]);
    assert!(ran.code == 2 && ran.err.contains("pass.osm.pbf"), "{}", ran.err);
}
