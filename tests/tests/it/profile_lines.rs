//! `corniche profile --line`: lines of files on the package's triangles and on elevation files, in
//! any format and CRS.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use e2e::{Ran, corniche, text, write_ascii_grid};

/// WGS84 as a `.prj` file has it.
const WGS84: &str = r#"GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]]"#;

fn succeed(ran: Ran) -> String {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran.out
}

/// Hills from 1.47° to 1.63° east and 42.47° to 42.59° north, and a package of them.
fn hills(folder: &Path) -> [PathBuf; 2] {
    let [dem, package] = ["hills.asc", "hills.pmtiles"].map(|name| folder.join(name));
    let place = "xllcorner 1.47\nyllcorner 42.47\ncellsize 0.00125";
    write_ascii_grid(&dem, [128, 96], place, |column, row| {
        1500.0 + 200.0 * (column as f64 / 11.0).sin() + 150.0 * (row as f64 / 7.0).cos()
    });
    fs::write(dem.with_extension("prj"), WGS84).unwrap();
    succeed(corniche(["build", "-q", "--dem", text(&dem), "-o", text(&package)]));
    [dem, package]
}

fn write_line(path: &Path, points: &[[f64; 2]]) {
    let document = serde_json::json!({ "type": "LineString", "coordinates": points });
    fs::write(path, document.to_string()).unwrap();
}

/// The printed length in plan, and the positions of all vertices.
fn profile(package: &Path, options: &[&str]) -> (f64, Vec<[f64; 2]>) {
    let list = package.with_extension("csv");
    let words = ["profile", "-q", text(package), "--csv", text(&list), "-O"];
    let said = succeed(corniche(words.iter().chain(options)));
    let length = said.strip_prefix("Length").unwrap().split(" m in plan").next().unwrap();
    let rows = fs::read_to_string(&list).unwrap();
    let place = |row: &str| {
        let fields: Vec<&str> = row.split(',').collect();
        [5, 6].map(|at| fields[at].parse().unwrap())
    };
    (length.trim().parse().unwrap(), rows.lines().skip(1).map(place).collect())
}

/// Over hills, on the triangles and on the elevation files: the profile passes through each point,
/// and has the same length.
fn assert_same_in_plan(inputs: &[PathBuf; 2], line: &Path, points: &[[f64; 2]]) -> f64 {
    let [dem, package] = inputs;
    let (on_tin_m, on_tin) = profile(package, &["--line", text(line)]);
    let (on_dem_m, on_dem) = profile(package, &["--line", text(line), "--dem", text(dem)]);
    assert!((on_tin_m - on_dem_m).abs() < 0.11, "{}: {on_tin_m} {on_dem_m}", line.display());
    for [lon, lat] in points {
        for vertices in [&on_tin, &on_dem] {
            let is_near = |at: &[f64; 2]| (at[0] - lon).abs().max((at[1] - lat).abs()) < 2e-7;
            assert!(vertices.iter().any(is_near), "{}: {lon} {lat}", line.display());
        }
    }
    on_dem_m
}

/// The value from the issue: 13 817.0 m by geodesics, where the straight line from end to end has 8
/// 219.9.
const BENT: [[f64; 2]; 3] = [[1.50, 42.50], [1.55, 42.55], [1.60, 42.50]];

#[test]
fn a_line_is_as_long_on_the_elevation_files_in_any_format_and_crs() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = hills(folder.path());
    let line = folder.path().join("line.geojson");
    write_line(&line, &BENT);
    let mut lines = vec![line.clone()];
    for (driver, ending, crs) in [
        ("GPX", "gpx", "EPSG:4326"),
        ("GPKG", "gpkg", "EPSG:4326"),
        ("GPKG", "utm.gpkg", "EPSG:25831"),
        ("ESRI Shapefile", "shp", "EPSG:3857"),
        ("FlatGeobuf", "fgb", "EPSG:2154"),
        ("KML", "kml", "EPSG:4326"),
        ("GML", "gml", "EPSG:4258"),
    ] {
        let other = folder.path().join(format!("line.{ending}"));
        let of_gpx = ["-nln", "tracks", "-nlt", "MULTILINESTRING"];
        let cut = Command::new("ogr2ogr")
            .args(["-f", driver, "-t_srs", crs])
            .args(if driver == "GPX" { &of_gpx[..] } else { &[] })
            .args([&other, &line])
            .output()
            .unwrap();
        assert!(cut.status.success(), "{driver}: {}", String::from_utf8_lossy(&cut.stderr));
        lines.push(other);
    }
    for line in lines {
        let length_m = assert_same_in_plan(&inputs, &line, &BENT);
        assert!((length_m - 13_817.0).abs() < 0.15, "{}: {length_m}", line.display());
    }
}

#[test]
fn lines_that_come_back_wind_or_have_parts_keep_all_their_points() {
    let folder = tempfile::tempdir().unwrap();
    let inputs = hills(folder.path());
    let line = |name: &str| folder.path().join(name);
    // There and back, on the same line: twice as long.
    let back = [BENT[0], BENT[1], BENT[0]];
    write_line(&line("back.geojson"), &back);
    let length_m = assert_same_in_plan(&inputs, &line("back.geojson"), &back);
    write_line(&line("half.geojson"), &BENT[..2]);
    let half_m = assert_same_in_plan(&inputs, &line("half.geojson"), &BENT[..2]);
    assert!((length_m - 2.0 * half_m).abs() < 0.15, "{length_m} {half_m}");
    // Around a square, to its beginning.
    let ring = [[1.5, 42.5], [1.52, 42.5], [1.52, 42.52], [1.5, 42.52], [1.5, 42.5]];
    write_line(&line("ring.geojson"), &ring);
    assert_same_in_plan(&inputs, &line("ring.geojson"), &ring);
    // Bends within cells of the elevation files, which are 100 m and 140 m wide.
    let winding: Vec<[f64; 2]> =
        (0..300).map(|k| [1.5 + 2e-4 * f64::from(k), 42.52 + 3e-4 * f64::from(k % 2)]).collect();
    write_line(&line("winding.geojson"), &winding);
    assert_same_in_plan(&inputs, &line("winding.geojson"), &winding);
    // Two lines, of which the second continues where the first ends.
    let parts =
        serde_json::json!({ "type": "MultiLineString", "coordinates": [BENT[..2], BENT[1..]] });
    fs::write(line("parts.geojson"), parts.to_string()).unwrap();
    let length_m = assert_same_in_plan(&inputs, &line("parts.geojson"), &BENT);
    assert!((length_m - 13_817.0).abs() < 0.15, "{length_m}");
}
