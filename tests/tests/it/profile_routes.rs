//! Roads by their numbers and names, and the way from place to place: `corniche profile --ref`,
//! `--name`, `--from` and `--to`, and exports.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use corniche_testing::pbf::{self, PbfWay};
use e2e::{Ran, build_from, corniche, text, write_ascii_grid};
use serde_json::Value;

const LAT: f64 = 47.02;

/// Positions of nodes: the main road follows a parallel, with two carriageways between 2 and 3, a
/// roundabout between 4 and 5, and a square without a number between 6 and 7.
///
/// ```text
///        21 ────── 22                41                     71
///  1 ── 2              3 ── 4        5 ── 6 ‧‧‧‧‧ 7 ──────────── 8
///        23 ────── 24                42
/// ```
const NODES: [(i64, [f64; 2]); 22] = [
    (1, [9.005, LAT]),
    (2, [9.010, LAT]),
    (21, [9.011, LAT + 1e-4]),
    (22, [9.019, LAT + 1e-4]),
    (23, [9.011, LAT - 1e-4]),
    (24, [9.019, LAT - 1e-4]),
    (3, [9.020, LAT]),
    (4, [9.024, LAT]),
    (41, [9.0245, LAT + 3e-4]),
    (42, [9.0245, LAT - 3e-4]),
    (5, [9.025, LAT]),
    (6, [9.030, LAT]),
    (7, [9.0305, LAT]),
    (71, [9.0305, LAT + 1.5e-3]),
    (8, [9.040, LAT]),
    (101, [9.005, 47.04]),
    (102, [9.010, 47.04]),
    (103, [9.040, 47.005]),
    (104, [9.044, 47.005]),
    (105, [9.020, 47.04]),
    (106, [9.021, 47.04]),
    (107, [9.022, 47.04]),
];

fn inputs(folder: &Path) -> [PathBuf; 3] {
    let [dem, osm, package] =
        ["dem.asc", "roads.osm.pbf", "roads.pmtiles"].map(|name| folder.join(name));
    let place = "xllcorner 9\nyllcorner 47\ncellsize 0.0005";
    write_ascii_grid(&dem, [100, 100], place, |column, row| 500.0 + (column + row) as f64);
    let wgs84 = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;
    fs::write(dem.with_extension("prj"), wgs84).unwrap();
    let road = |id, more: &[(&'static str, &'static str)], node_ids: &[i64]| {
        let tags = [&[("highway", "secondary")], more].concat();
        PbfWay { id, tags, node_ids: node_ids.to_vec() }
    };
    let main = ("ref", "CG 2");
    let ways = [
        road(10, &[main, ("name", "Carrer Major")], &[1, 2]),
        road(11, &[main, ("oneway", "yes")], &[2, 23, 24, 3]),
        road(12, &[main, ("oneway", "yes")], &[3, 22, 21, 2]),
        road(13, &[main], &[4, 3]),
        // It begins within the followed road.
        road(14, &[main, ("junction", "roundabout")], &[42, 5, 41, 4, 42]),
        road(15, &[main], &[5, 6]),
        road(16, &[("name", "Square")], &[6, 7]),
        road(17, &[("ref", "CG-2;N 20")], &[7, 8]),
        road(18, &[("ref", "cg2")], &[7, 71]),
        road(20, &[("name", "Dorf-Strasse")], &[101, 102]),
        road(21, &[("name", "Dorfstrasse")], &[103, 104]),
        road(22, &[("ref", "X 1")], &[105, 106]),
        road(23, &[("ref", "X 1")], &[106, 107]),
    ];
    fs::write(&osm, pbf::network(&[], &NODES, &ways)).unwrap();
    build_from([&dem, &osm], &package, &["-q"]);
    [dem, osm, package]
}

/// Metres along the main road, by the radii of curvature of WGS84.
fn metres(nodes: &[[f64; 2]]) -> f64 {
    let (a, e2) = (6_378_137.0, 0.006_694_379_990_14);
    let w2 = 1.0 - e2 * LAT.to_radians().sin().powi(2);
    let north_m = a * (1.0 - e2) / w2.powf(1.5) * 1_f64.to_radians();
    let east_m = a / w2.sqrt() * LAT.to_radians().cos() * 1_f64.to_radians();
    let step = |pair: &[[f64; 2]; 2]| {
        ((pair[1][0] - pair[0][0]) * east_m).hypot((pair[1][1] - pair[0][1]) * north_m)
    };
    nodes.array_windows().map(step).sum()
}

fn place(id: i64) -> [f64; 2] {
    NODES.iter().find(|(own, _)| *own == id).unwrap().1
}

fn whole_m() -> f64 {
    metres(&[1, 2, 21, 22, 3, 4, 41, 5, 6, 7, 8].map(place))
}

fn profile(package: &Path, options: &[&str]) -> Ran {
    corniche(["profile", "-q", text(package)].iter().chain(options))
}

fn document(package: &Path, options: &[&str]) -> Value {
    let file = package.with_extension("json");
    let ran = profile(package, &[&["--json", text(&file), "-O"], options].concat());
    assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

fn assert_close(found: &Value, expected_m: f64) {
    let found_m = found["length_2d_m"].as_f64().unwrap();
    assert!((found_m - expected_m).abs() < 0.05, "{found_m} {expected_m}");
}

/// From end to end, with one carriageway and one arm of the roundabout, across the square, and
/// without the branch.
#[test]
fn a_road_by_its_number_is_as_long_as_the_road() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] = inputs(folder.path());
    let extract = ["--osm", text(&osm)];
    let both = ["--dem", text(&dem), "--osm", text(&osm)];
    for number in ["CG 2", "cg-2", "CG2", " c g 2"] {
        for inputs in [&[][..], &extract, &both] {
            let found = document(&package, &[&["--ref", number], inputs].concat());
            assert_close(&found, whole_m());
            assert_eq!(found["title"], "Road CG 2");
            assert_eq!(found["parts"].as_array().unwrap().len(), 1);
            let ways: Vec<i64> = found["legs"]
                .as_array()
                .unwrap()
                .iter()
                .map(|leg| leg["way_id"].as_i64().unwrap())
                .collect();
            assert!([10, 13, 14, 15, 16, 17].iter().all(|way| ways.contains(way)), "{ways:?}");
            assert!(!ways.contains(&18), "{ways:?}");
            assert_eq!(found["legs"][0]["name"], "Carrer Major");
        }
    }
    let said = profile(&package, &["--ref", "CG 2"]).out;
    assert!(said.contains("of other roads close gaps in this road"), "{said}");
    // A second number of a part, and a name of another.
    assert_close(&document(&package, &["--ref", "N20"]), metres(&[7, 8].map(place)));
    assert_close(&document(&package, &["--name", "carrer-major"]), metres(&[1, 2].map(place)));
    assert_close(
        &document(&package, &["--ref", "x1"]),
        metres(&[105, 106, 107].map(place)) * 0.99962,
    );
}

#[test]
fn the_way_from_place_to_place_is_the_shortest() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] = inputs(folder.path());
    let both = ["--dem", text(&dem), "--osm", text(&osm)];
    let [from, to] = [[9.007, LAT], [9.035, LAT]];
    let nodes = [2, 21, 22, 3, 4, 41, 5, 6, 7].map(place);
    let expected_m = metres(&[&[from], &nodes[..], &[to]].concat());
    for inputs in [&[][..], &both] {
        for road in [&[][..], &["--ref", "CG 2"]] {
            // Ten metres off the road, and back again.
            for ends in [["9.007,47.0201", "9.035,47.02"], ["9.035,47.02", "9.007,47.0201"]] {
                let options = [&["--from", ends[0], "--to", ends[1]], road, inputs].concat();
                let found = document(&package, &options);
                assert_close(&found, expected_m);
                let first = &found["parts"][0]["points"][0]["position_deg"];
                let lon: f64 = ends[0].split_once(',').unwrap().0.parse().unwrap();
                assert!((first[0].as_f64().unwrap() - lon).abs() < 1e-6, "{first}");
            }
        }
    }
    // Within one stretch, and along a branch.
    let short = document(&package, &["--from", "9.032,47.02", "--to", "9.034,47.02"]);
    assert_close(&short, metres(&[[9.032, LAT], [9.034, LAT]]));
    let branch = document(&package, &["--from", "9.032,47.02", "--to", "9.0305,47.0215"]);
    assert_close(&branch, metres(&[[9.032, LAT], place(7), place(71)]));
}

#[test]
fn what_is_not_clear_is_told_with_what_would_be() {
    let folder = tempfile::tempdir().unwrap();
    let [_, osm, package] = inputs(folder.path());
    let refused = |options: &[&str], words: &[&str]| {
        let ran = profile(&package, options);
        assert_eq!(ran.code, 2, "{options:?}: {}{}", ran.out, ran.err);
        for word in words {
            assert!(ran.err.contains(word), "{word}: {}", ran.err);
        }
    };
    refused(&["--name", "DORFSTRASSE"], &["--way 20", "--way 21", "2 roads", "--from"]);
    refused(&["--ref", "CG 3"], &["no road with ref \"CG 3\"", "CG 2"]);
    refused(&["--ref", "--"], &["--ref"]);
    refused(&["--from", "9.007,47.03", "--to", "9.035,47.02"], &["within 500 m", "9.007,47.03"]);
    refused(&["--from", "47.02,9.007", "--to", "9.035,47.02"], &["longitude comes first"]);
    refused(&["--from", "9.007,47.02", "--to", "9.008,47.04"], &["lead from", "9.008,47.04"]);
    refused(&["--from", "9.007,47.02", "--to", "9.007,47.02"], &["one place"]);
    refused(&["--from", "9.007,47.02"], &["--to"]);
    refused(&["--ref", "CG 2", "--way", "10"], &["--way"]);
    refused(&["--way", "10", "--osm", text(&osm)], &["--dem"]);
}

#[test]
fn exports_take_the_roads_that_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, osm, package] = inputs(folder.path());
    let list = folder.path().join("list.csv");
    let export = |what: &str, options: &[&str]| {
        let words = ["export", what, "-q", text(&package), "-o", text(&list), "-O"];
        corniche(words.iter().chain(options))
    };
    let column = |name: &str| -> BTreeSet<String> {
        let rows = fs::read_to_string(&list).unwrap();
        let mut rows = rows.lines().map(|row| {
            let line_ends = row.rfind(")\",").map_or(0, |at| at + 3);
            row[line_ends..].split(',').map(str::to_owned).collect::<Vec<_>>()
        });
        let names = rows.next().unwrap();
        let at = names.iter().position(|own| own == name).unwrap() - 1;
        rows.map(|row| row[at].trim_matches('"').to_owned()).collect()
    };
    let ran = export("roads", &["--ref", "cg 2"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let expected = ["10", "11", "12", "13", "14", "15", "17", "18"].map(str::to_owned);
    assert_eq!(column("way_id"), expected.into());
    let both = ["--dem", text(&dem), "--osm", text(&osm)];
    let ran = export("edges", &[&["--name", "dorfstrasse"][..], &both].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(column("ways"), ["20f", "21f"].map(str::to_owned).into());
    let before = fs::read(&list).unwrap();
    let ran = export("roads", &["--ref", "CG 9"]);
    assert!(ran.code == 2 && ran.err.contains("CG 2"), "{}", ran.err);
    assert_eq!(fs::read(&list).unwrap(), before);
}
