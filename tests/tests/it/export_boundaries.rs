//! Exported lines of a layer, boundaries, read back by OGR and compared with those that osmium
//! finds in the extract.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{Ran, corniche, extract_with_boundaries, json, objects, sample, skip, text};
use gdal::{
    Dataset,
    vector::{FieldValue, LayerAccess as _},
};

type Line = Vec<[f64; 2]>;

/// A feature: class, name, length, lines.
#[derive(Debug, PartialEq)]
struct Exported {
    class: String,
    name: Option<String>,
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

fn export(package: &Path, layer: &str, file: &Path, more: &[&str]) -> Ran {
    corniche([&["export", "layer", layer, text(package), "-O", "-o", text(file)], more].concat())
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
        let word = |name: &str| match of(name)? {
            FieldValue::StringValue(word) => Some(word),
            other => panic!("{name} is {other:?}"),
        };
        assert_eq!(word("object").as_deref(), Some("way"));
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
        let (class, name) = (word("class").expect("a class"), word("name"));
        (number("id").unwrap(), Exported { class, name, length_m, lines })
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

/// Whether a line has these points in their order, to 0.1 m and the rounding of the lattice, and
/// between them only points on the straight lines, where it meets the sides of triangles.
fn is_same(found: &[[f64; 2]], points: &[[f64; 2]]) -> bool {
    let near = |one: [f64; 2], other: [f64; 2]| length_m(&[one, other]) < 0.11;
    let mut next = points.iter().copied().peekable();
    let mut from = points[0];
    for &at in found {
        if next.next_if(|&point| near(at, point)).is_some() {
            from = at;
            continue;
        }
        let Some(&to) = next.peek() else { return false };
        let metres = |place: [f64; 2]| {
            let east = (place[0] - from[0]) * 111_320.0 * from[1].to_radians().cos();
            [east, (place[1] - from[1]) * 111_170.0]
        };
        let ([x, y], [east, north]) = (metres(at), metres(to));
        // A parallel of 3 km is 0.2 m beside the straight line.
        if ((x * north - y * east) / east.hypot(north)).abs() > 0.3 {
            return false;
        }
    }
    next.peek().is_none()
}

/// Across borders of tiles each way comes back unchanged, once, in each format.
#[test]
fn boundaries_come_back_whole_in_each_format() {
    let folder = tempfile::tempdir().unwrap();
    let osm = extract_with_boundaries(folder.path());
    let more = ["--max-error", "10", "--layers", "boundaries"];
    let package = built(folder.path(), &sample("pass/pass-dem.tif"), &osm, &more);
    let place = |x: i32, y: i32| [9.5 + 0.005 * f64::from(x), 46.87 + 0.004 * f64::from(y)];
    let expected: [(i64, &str, Line); 3] = [
        (2, "admin-2", vec![place(1, 2), place(4, 4), place(8, 3)]),
        (3, "admin-6", vec![place(8, 3), place(7, 8), place(2, 7), place(1, 2)]),
        (4, "protected", vec![place(4, 4), place(6, 5), place(5, 7), place(4, 4)]),
    ];
    for ending in ["gpkg", "fgb", "csv", "geojson"] {
        let file = folder.path().join(format!("boundaries.{ending}"));
        let ran = export(&package, "boundaries", &file, &["--crs", "EPSG:4326"]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert!(ran.err.contains("3 objects of layer boundaries on level"), "{}", ran.err);
        assert!(ran.err.contains("3 lines"), "{}", ran.err);
        assert!(ran.err.contains("© OpenStreetMap contributors"), "{}", ran.err);
        let found = read(&file);
        assert_eq!(found.len(), 3, "{ending}");
        for (way_id, class, line) in &expected {
            let way = &found[way_id];
            assert_eq!((way.class.as_str(), &way.name), (*class, &None), "{ending}");
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
    refused(export(&package, "areas", &file, &[]), "\"areas\"; its layers are boundaries");
    let geojson = folder.path().join("boundaries.geojson");
    refused(export(&package, "boundaries", &geojson, &["--crs", "package"]), "RFC 7946");
}

/// Both segments of way 2, whose line in the package's CRS is this one, are in the JSON of finest
/// tiles, with the way's class.
fn tiles_have_the_parts(package: &Path, line: &[[f64; 2]]) {
    let info = json(&["info", text(package), "--json"]);
    let ids = info["tiles"].as_array().unwrap().iter().map(|id| id.as_str().unwrap());
    let level = |id: &str| id.split('/').next().unwrap().parse::<u8>().unwrap();
    let finest = ids.clone().map(level).max();
    let mut found = BTreeSet::new();
    for id in ids.filter(|id| Some(level(id)) == finest) {
        let document = json(&["tile", text(package), id, "--json", "--coordinates", "crs"]);
        for part in objects(&document, "boundaries").iter().filter(|part| part["id"] == 2) {
            assert_eq!((&part["object"], &part["class"]), (&"way".into(), &"admin-2".into()));
            let points: Line = serde_json::from_value(part["line"].clone()).unwrap();
            let place = |point: &[f64; 2]| {
                let is_near = |at: &[f64; 2]| (at[0] - point[0]).hypot(at[1] - point[1]) < 1e-6;
                line.iter().position(is_near).expect("a vertex of the exported line")
            };
            found.extend(points.array_windows::<2>().map(|ends| ends.each_ref().map(place)));
        }
    }
    let found: Vec<[usize; 2]> = found.into_iter().collect();
    let [[0, middle], [again, last]] = found[..] else { panic!("{found:?}") };
    assert_eq!((middle, last), (again, line.len() - 1));
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

/// The name of each way: that of the object that gives its class. The way itself comes before
/// relations, and a relation with a lower id before others.
fn names_of(opl: &str) -> BTreeMap<i64, Option<String>> {
    // OPL escapes its special characters, and those beyond ASCII, as numbers between percent signs.
    let plain = |text: &str| -> String {
        let part = |(place, part): (usize, &str)| match place % 2 {
            0 => part.to_owned(),
            _ => u32::from_str_radix(part, 16).ok().and_then(char::from_u32).unwrap().to_string(),
        };
        text.split('%').enumerate().map(part).collect()
    };
    let mut names: BTreeMap<i64, (String, i64, Option<String>)> = BTreeMap::new();
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
        let name = tags.get("name").map(|name| plain(name));
        let mut tell = |way_id: &str, relation_id: i64| {
            let own = (class.clone(), relation_id, name.clone());
            let known = names.entry(way_id.parse().unwrap()).or_insert_with(|| own.clone());
            if (&own.0, own.1) < (&known.0, known.1) {
                *known = own;
            }
        };
        let id = line[1..].split(' ').next().unwrap();
        if line.starts_with('w') {
            tell(id, 0);
        } else if matches!(tags.get("type"), Some(&"boundary" | &"multipolygon")) {
            for member in field('M').unwrap().split(',') {
                let (way, role) = member.split_once('@').unwrap();
                if let (Some(way), "" | "outer" | "inner") = (way.strip_prefix('w'), role) {
                    tell(way, id.parse().unwrap());
                }
            }
        }
    }
    names.into_iter().map(|(way_id, (.., name))| (way_id, name)).collect()
}

/// A country: the exported ways are those that osmium lists, to the lattice's rounding, with the
/// names of the objects that give their classes.
#[test]
fn boundaries_of_a_country_are_the_ways_of_osmium() {
    let folder = tempfile::tempdir().unwrap();
    let osm = sample("liechtenstein/liechtenstein-2013-08-03.osm.pbf");
    let Some(opl) = opl_of_osmium(&osm, folder.path()) else {
        return skip("there is no program osmium (Debian: osmium-tool)");
    };
    let (ways, names) = (ways_of(&opl), names_of(&opl));
    let more = ["--max-error", "30", "--layers", "boundaries", "--classes", "0"];
    let dem = sample("liechtenstein/liechtenstein-dem.tif");
    let package = built(folder.path(), &dem, &osm, &more);
    let file = folder.path().join("boundaries.fgb");
    let ran = export(&package, "boundaries", &file, &["--crs", "EPSG:4326"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let found = read(&file);
    assert!(found.len() > 60, "{} ways", found.len());
    let mut whole = 0;
    for (way_id, Exported { length_m: told_m, lines, name, .. }) in &found {
        assert_eq!(name, &names[way_id], "way {way_id}");
        let mut expected = ways[way_id].clone();
        expected.dedup();
        // A boundary that leaves the ground has several lines, or ends there.
        if let [line] = &lines[..]
            && is_same(line, &expected)
        {
            let ratio = told_m / length_m(&expected);
            assert!((ratio - 1.0).abs() < 2e-3, "way {way_id}: {ratio}");
            whole += 1;
        }
    }
    assert!(whole * 10 > found.len() * 9, "{whole} of {} ways", found.len());
    let named = found.values().filter(|way| way.name.is_some()).count();
    assert!(named > 30, "{named} ways with names");
}
