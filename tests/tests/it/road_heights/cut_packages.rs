//! Packages that are clipped to bounds or a polygon export, inside, the same heights, decks and
//! grades as the whole package.

use std::{collections::BTreeMap, fs, path::Path};

use e2e::{cases, real_data, text};

use super::{Line, Row, export, features, pass_inputs, succeed};

/// Tolerance, metres: clipped roads are measured from their clip, sums of lengths are rounded, and
/// decks are looked up by them.
const MOST_M: f64 = 1e-3;

/// Elevation files, an extract, and the rectangle with bridges and tunnels, degrees.
struct Region {
    dem: Vec<std::path::PathBuf>,
    osm: std::path::PathBuf,
    box_deg: [f64; 4],
}

/// The key columns of roads and edges.
const WAY: &[&str] = &["way_id"];
const EDGE: &[&str] = &["from_node", "to_node", "ways"];

/// The roads of a package by way.
type Roads = BTreeMap<String, (Row, Vec<Line>)>;

fn exported(package: &Path, what: &str, inputs: &[&str], keys: &[&str]) -> Roads {
    let target = package.with_extension("gpkg");
    succeed(export(package, what, &target, &[inputs, &["-O"]].concat()));
    let key = |row: &Row| keys.iter().map(|&key| row[key].as_str()).collect::<Vec<_>>().join(" ");
    features(&target).into_iter().map(|(row, lines)| (key(&row), (row, lines))).collect()
}

/// Heights of the vertices of all roads by way and place, to a tenth of a millimetre or so.
fn heights(roads: &Roads) -> BTreeMap<(&str, [i64; 2]), f64> {
    let scaled = |at: f64| (at * if at.abs() <= 360.0 { 1e9 } else { 1e4 }).round() as i64;
    let mut all = BTreeMap::new();
    for (way_id, (_, lines)) in roads {
        for &[x, y, z] in lines.iter().flatten() {
            all.insert((way_id.as_str(), [scaled(x), scaled(y)]), z);
        }
    }
    all
}

/// The number of compared vertices, and the largest difference, metres.
fn compare(whole: &Roads, part: &Roads) -> (usize, f64) {
    let [whole_m, part_m] = [whole, part].map(heights);
    let pairs: Vec<f64> = part_m
        .iter()
        .filter_map(|(place, own_m)| Some((own_m - whole_m.get(place)?).abs()))
        .collect();
    // Only clipped lines have other vertices.
    assert!(pairs.len() * 10 > part_m.len() * 9, "{} of {}", pairs.len(), part_m.len());
    // Ways that are completely inside have the same measures.
    for (way_id, (row, lines)) in part {
        let (of_whole, expected) = &whole[way_id];
        let is_same = |own: &Line, other: &Line| {
            own.len() == other.len()
                && own.iter().zip(other).all(|(one, of_whole)| {
                    (0..2).all(|axis| (one[axis] - of_whole[axis]).abs() < 1e-8)
                })
        };
        if lines.len() != expected.len()
            || !lines.iter().zip(expected).all(|(own, other)| is_same(own, other))
        {
            continue;
        }
        for (name, value) in row {
            // The triangles of other tiles differ.
            if name == "ground_tolerance_m" {
                continue;
            }
            match (value.parse::<f64>(), of_whole[name].parse::<f64>()) {
                (Ok(own), Ok(other)) => {
                    assert!((own - other).abs() < MOST_M, "{name}: {row:?} {of_whole:?}");
                }
                _ => assert_eq!(value, &of_whole[name], "{name}: {row:?}"),
            }
        }
    }
    (pairs.len(), pairs.into_iter().fold(0.0, f64::max))
}

fn cut_packages_export_the_whole(name: &str, region: &Region) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let Region { dem, osm, box_deg: [west, south, east, north] } = region;
    let mut inputs = vec!["--dem"];
    inputs.extend(dem.iter().map(|path| text(path)));
    inputs.extend(["--osm", text(osm)]);
    let whole = at("whole.pmtiles");
    let built = |package: &Path, more: &[&str]| {
        let words = [&["build", "-q", "-O", "-o", text(package)], &inputs[..], more].concat();
        succeed(e2e::corniche(words));
    };
    built(&whole, &[]);
    let roads_of_whole = exported(&whole, "roads", &inputs, WAY);
    let edges_of_whole = exported(&whole, "edges", &inputs, EDGE);
    let count = cases(1, 2, 10);
    let (mut vertices, mut most_m) = (0, 0.0_f64);
    for number in 0..count {
        // Strips across the region, alternating along both axes.
        let share = (f64::from(number) + 0.5) / f64::from(count);
        let (lon, lat) = (west + share * (east - west), south + share * (north - south));
        let [w, h] = [0.3 * (east - west), 0.3 * (north - south)];
        let bounds = if number % 2 == 0 {
            [lon - w, *south, lon + w, *north]
        } else {
            [*west, lat - h, *east, lat + h]
        };
        let part = at("part.pmtiles");
        let [w0, s0, e0, n0] = bounds;
        built(&part, &[&format!("--bounds={w0},{s0},{e0},{n0}")]);
        let (compared, differs_m) =
            compare(&roads_of_whole, &exported(&part, "roads", &inputs, WAY));
        (vertices, most_m) = (vertices + compared, most_m.max(differs_m));
        for (ways, (row, lines)) in exported(&part, "edges", &inputs, EDGE) {
            let (of_whole, expected) = &edges_of_whole[&ways];
            assert_eq!(lines.len(), expected.len(), "{row:?} {of_whole:?}");
            let pairs = lines.iter().flatten().zip(expected.iter().flatten());
            most_m =
                pairs.fold(most_m, |most_m, (own, other)| most_m.max((own[2] - other[2]).abs()));
        }
        let polygon = at("polygon.geojson");
        let ring = [
            [w0, s0 + 0.1 * h],
            [e0, s0],
            [e0 - 0.1 * w, n0],
            [w0 + 0.1 * w, n0],
            [w0, s0 + 0.1 * h],
        ];
        let ring: Vec<String> = ring.iter().map(|[x, y]| format!("[{x},{y}]")).collect();
        let json = format!(r#"{{"type":"Polygon","coordinates":[[{}]]}}"#, ring.join(","));
        fs::write(&polygon, json).unwrap();
        let cut = ["--polygon", text(&polygon)];
        built(&part, &cut);
        let with_polygon = [&inputs[..], &cut].concat();
        let (compared, differs_m) =
            compare(&roads_of_whole, &exported(&part, "roads", &with_polygon, WAY));
        (vertices, most_m) = (vertices + compared, most_m.max(differs_m));
    }
    assert!(vertices > 100 && most_m < MOST_M, "{name}: {vertices} vertices, {most_m} m");
}

#[test]
fn cut_packages_of_the_pass_export_the_whole() {
    let [dem, osm] = pass_inputs();
    let region = Region { dem: vec![dem], osm, box_deg: [9.47, 46.86, 9.6, 46.97] };
    cut_packages_export_the_whole("pass", &region);
}

#[test]
fn cut_packages_of_portland_export_the_whole() {
    let files = ["portland-ned.tif", "portland-central-filtered.osm.pbf"]
        .map(|name| real_data(&format!("portland/{name}")));
    let [Some(dem), Some(osm)] = files else { return };
    let region = Region { dem: vec![dem], osm, box_deg: [-122.7, 45.5, -122.64, 45.54] };
    cut_packages_export_the_whole("portland", &region);
}

#[test]
fn cut_packages_of_liechtenstein_export_the_whole() {
    let files = ["N47E009.hgt", "N47E010.hgt", "liechtenstein-2021-10-28.osm.pbf"]
        .map(|name| real_data(&format!("liechtenstein/{name}")));
    let [Some(one), Some(two), Some(osm)] = files else { return };
    let region = Region { dem: vec![one, two], osm, box_deg: [9.48, 47.05, 9.62, 47.26] };
    cut_packages_export_the_whole("liechtenstein", &region);
}
