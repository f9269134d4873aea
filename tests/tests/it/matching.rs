//! `corniche match`: offsets of photos and benches that were deliberately shifted from roads are
//! found.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{fs, path::Path};

use corniche_testing::{ColourImage, Raster};
use e2e::{Ran, corniche, json, real_data, sample, text};
use gdal::{Dataset, DriverManager, cpl::CslStringList};

/// The offset of the roads in the image from the true roads: metres east and north.
const OFFSET_M: [f64; 2] = [12.0, -7.0];
/// Around a junction of the sample `pass`, UTM zone 32.
const WEST_M: f64 = 541_800.0;
const NORTH_M: f64 = 5_199_300.0;
const SIDE_M: f64 = 1_600.0;
const PIXEL_M: f64 = 2.0;

type Segment = [[f64; 2]; 2];

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// The roads of all finest tiles of the sample near the image.
fn roads(folder: &Path) -> Vec<Segment> {
    let package = folder.join("plain.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "10"]);
    let info = json(&["info", text(&package), "--json"]);
    let ids: Vec<String> = info["tiles"]
        .as_array()
        .unwrap()
        .iter()
        .map(|tile| tile.as_str().unwrap_or_else(|| tile["id"].as_str().unwrap()).to_owned())
        .collect();
    let finest = ids.iter().map(|id| id.split('/').next().unwrap().parse::<u8>().unwrap()).max();
    let mut segments = Vec::new();
    for id in ids.iter().filter(|id| id.starts_with(&format!("{}/", finest.unwrap()))) {
        let tile = json(&["tile", text(&package), id, "--json"]);
        for road in tile["roads_sv"].as_array().unwrap() {
            let line: Vec<[f64; 2]> = serde_json::from_value(road["line"].clone()).unwrap();
            segments.extend(line.array_windows::<2>().copied().filter(|segment| {
                let is_near = |axis: usize, low: f64| {
                    segment.iter().any(|at| (at[axis] - low - SIDE_M / 2.0).abs() < SIDE_M)
                };
                is_near(0, WEST_M) && is_near(1, NORTH_M - SIDE_M)
            }));
        }
    }
    assert!(segments.len() > 50, "{}", segments.len());
    segments
}

/// Distance of a point from the nearest road, shifted by the offset.
fn distance_m(segments: &[Segment], place: [f64; 2]) -> f64 {
    let place = [place[0] - OFFSET_M[0], place[1] - OFFSET_M[1]];
    let of = |[from, to]: &Segment| {
        let [along_x, along_y] = [to[0] - from[0], to[1] - from[1]];
        let [x, y] = [place[0] - from[0], place[1] - from[1]];
        let share =
            ((x * along_x + y * along_y) / (along_x.hypot(along_y).powi(2))).clamp(0.0, 1.0);
        (x - share * along_x).hypot(y - share * along_y)
    };
    segments.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// East, north and confidence in the row "all".
fn all(answer: &str) -> [f64; 3] {
    let row =
        answer.lines().find(|line| line.starts_with("all ")).unwrap_or_else(|| panic!("{answer}"));
    let cells: Vec<f64> =
        row.split_whitespace().filter_map(|cell| cell.replace(',', "").parse().ok()).collect();
    [cells[1], cells[2], cells[3]]
}

fn assert_found(answer: &str, tolerance_m: f64) {
    let [east, north, confidence] = all(answer);
    assert!(confidence >= 6.0, "{answer}");
    assert!(
        (east - OFFSET_M[0]).abs() < tolerance_m && (north - OFFSET_M[1]).abs() < tolerance_m,
        "{answer}"
    );
}

#[test]
fn a_photo_that_lies_beside_the_roads() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let segments = roads(folder.path());
    let package = at("plain.pmtiles");
    let photo = |name: &str, shows_roads: bool| {
        let grey = |[x, y]: [f64; 2]| {
            // Fields of different brightness with sharp edges, which are not lines.
            let field = ((x / 130.0).floor() * 7.0 + (y / 90.0).floor() * 13.0).rem_euclid(5.0);
            let noise = ((x * 12.9 + y * 78.2).sin() * 43_758.5).rem_euclid(1.0) * 40.0;
            let is_road = shows_roads && distance_m(&segments, [x, y]) < 4.0;
            let value = if is_road { 60.0 } else { 100.0 + 20.0 * field };
            vec![(value + noise) as u8; 3]
        };
        ColourImage {
            epsg: 32632,
            size: [(SIDE_M / PIXEL_M) as usize; 2],
            transform: [WEST_M, PIXEL_M, 0.0, NORTH_M, 0.0, -PIXEL_M],
            value: &grey,
            interpretations: &ColourImage::RGB,
        }
        .write(folder.path(), name, |_| {})
    };
    let shown = photo("shown.tif", true);
    let (list, map) = (at("ways.csv"), at("map.svg"));
    let words = ["match", text(&package), "--photo", text(&shown), "--region", "800"];
    let ran =
        succeed(corniche([&words[..], &["--csv", text(&list), "--svg", text(&map)]].concat()));
    assert_found(&ran.out, 1.0);
    // Each way with a reliable offset has its part of the total offset.
    let mut reader = fs::read_to_string(&list).unwrap();
    assert!(
        reader.starts_with("way_id,class,name,ref,length_m,samples,east_m,north_m,"),
        "{reader}"
    );
    reader = reader.lines().filter(|line| line.ends_with(",1")).collect::<Vec<_>>().join("\n");
    assert!(reader.lines().count() >= 3, "{reader}");
    let map = fs::read_to_string(&map).unwrap();
    assert!(map.contains("OpenStreetMap contributors") && map.ends_with("</svg>\n"));
    // A photo without roads gives no offsets.
    let bare = photo("bare.tif", false);
    let ran = succeed(corniche(["match", text(&package), "--photo", text(&bare)]));
    let [.., confidence] = all(&ran.out);
    println!("{}", ran.out);
    assert!(confidence < 6.0, "{}", ran.out);
    // The package may come after the photos.
    let again = succeed(corniche(["match", "--photo", text(&bare), text(&package)]));
    assert_eq!(again.out, ran.out);
    let ran = corniche(["match", "--photo", text(&bare)]);
    assert!(ran.code == 2 && ran.err.contains("write the package first"), "{}", ran.err);
    // Nothing is overwritten without a request.
    let ran = corniche(["match", text(&package), "--photo", text(&bare), "--csv", text(&list)]);
    assert_eq!(ran.code, 3, "{}", ran.err);
}

#[test]
fn benches_in_a_hillside_beside_the_roads() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let segments = roads(folder.path());
    let place = [WEST_M + 1.0, PIXEL_M, 0.0, NORTH_M - 1.0, 0.0, -PIXEL_M];
    let raster = Raster::new(32632, [(SIDE_M / PIXEL_M) as usize; 2], place);
    let dem = raster.write(folder.path(), "benches.tif", |[x, y]| {
        // A slope of 25 degrees with hollows; a road is level across, seven metres wide.
        let hill = |x: f64, y: f64| 900.0 + 0.47 * (y - NORTH_M) + 6.0 * (x / 160.0).sin();
        let away = distance_m(&segments, [x, y]);
        let flat = (1.0 - (away - 3.5).max(0.0) / 3.0).max(0.0);
        // Level across: it is mixed with the height of the hill some metres below.
        (hill(x, y) * (1.0 - flat) + (hill(x, y) / 3.0).round() * 3.0 * flat) as f32
    });
    let (package, osm) = (at("benches.pmtiles"), sample("pass/pass.osm.pbf"));
    let words = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--max-error", "1", "-o"];
    succeed(corniche([&words[..], &[text(&package)]].concat()));
    let ran = succeed(corniche(["match", text(&package), "--slope"]));
    assert_found(&ran.out, 2.0);
    // Slopes are computed from the relief.
    let bare = at("bare.pmtiles");
    let words = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "--relief", "off", "-o"];
    succeed(corniche([&words[..], &[text(&bare)]].concat()));
    let ran = corniche(["match", text(&bare), "--slope"]);
    assert!(ran.code == 2 && ran.err.contains("has no relief"), "{}", ran.err);
}

/// A real photo, and a copy of it with another georeference: the offsets of both differ by the
/// shift.
#[test]
fn a_real_photo_that_was_moved() {
    let Some(dem) = real_data("swellendam/srtm_41_19_4326.tif") else { return };
    let Some(osm) = real_data("swellendam/swellendam-roads.osm.pbf") else { return };
    let Some(photo) = real_data("swellendam/3420B_2010_328_RGB_LATLNG.tif") else { return };
    let folder = tempfile::tempdir().unwrap();
    let (package, moved) = (folder.path().join("s.pmtiles"), folder.path().join("moved.vrt"));
    let words = ["build", "-q", "--dem", text(&dem), "--osm", text(&osm), "-o", text(&package)];
    succeed(corniche(words));
    // Metres in degrees at 34° south (Snyder 1987, table 3).
    let degrees = [OFFSET_M[0] / 92_250.0, OFFSET_M[1] / 110_920.0];
    let dataset = Dataset::open(&photo).unwrap();
    let driver = DriverManager::get_driver_by_name("VRT").unwrap();
    let mut copy = dataset.create_copy(&driver, &moved, &CslStringList::new()).unwrap();
    let mut place = dataset.geo_transform().unwrap();
    place[0] += degrees[0];
    place[3] += degrees[1];
    copy.set_geo_transform(&place).unwrap();
    drop(copy);
    let offset = |photo: &Path| {
        let ran = succeed(corniche(["match", text(&package), "--photo", text(photo)]));
        all(&ran.out)
    };
    let ([east, north, sure], [moved_east, moved_north, moved_sure]) =
        (offset(&photo), offset(&moved));
    assert!(sure >= 6.0 && moved_sure >= 6.0, "{sure} {moved_sure}");
    let found = [moved_east - east, moved_north - north];
    assert!(
        (found[0] - OFFSET_M[0]).abs() < 2.0 && (found[1] - OFFSET_M[1]).abs() < 2.0,
        "{found:?}"
    );
}
