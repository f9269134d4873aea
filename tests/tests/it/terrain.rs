//! Terrain with known heights, from rasters that the tests write themselves (ASCII grids, which
//! GDAL reads).

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{corniche, json, sample, text, write_ascii_grid};

/// Writes an ASCII grid of 10 m cells whose south-western sample is at a node that is a tile
/// corner.
fn write_grid(folder: &Path, side: usize, height_m: impl Fn(usize, usize) -> f64) -> PathBuf {
    let corner_m = 256.0 * 10.0 * 100.0 - 5.0;
    let place =
        format!("xllcorner {corner_m}\nyllcorner {corner_m}\ncellsize 10\nNODATA_value -9999");
    let path = folder.join("grid.asc");
    write_ascii_grid(&path, [side; 2], &place, height_m);
    path
}

fn build(folder: &Path, dem: &Path, options: &[&str]) -> PathBuf {
    let package = folder.join("grid.pmtiles");
    let mut arguments = vec!["build", "--dem", text(dem), "-o", text(&package), "--quiet"];
    arguments.extend(["--dem-crs", "EPSG:32632"]);
    arguments.extend(options);
    let ran = corniche(arguments);
    assert_eq!(ran.code, 0, "{}", ran.err);
    package
}

#[test]
fn a_raster_without_crs_is_refused_with_the_option_that_helps() {
    let folder = tempfile::tempdir().unwrap();
    let dem = write_grid(folder.path(), 20, |_, _| 5.0);
    let package = folder.path().join("grid.pmtiles");
    let ran = corniche(["build", "--dem", text(&dem), "-o", text(&package)]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("--dem-crs") && ran.err.contains("grid.asc"), "{}", ran.err);
    assert!(!package.exists());
}

#[test]
fn a_flat_tile_has_four_vertices_and_two_triangles() {
    let folder = tempfile::tempdir().unwrap();
    let dem = write_grid(folder.path(), 257, |_, _| 1234.5);
    let package = build(folder.path(), &dem, &[]);
    let tile = json(&["tile", text(&package), "0/0/0", "--json"]);
    assert_eq!(tile["tin"]["vertices"].as_array().unwrap().len(), 4);
    assert_eq!(tile["tin"]["triangles"].as_array().unwrap().len(), 2);
    assert_eq!(tile["geometric_error_m"], 0.0);
    assert_eq!(tile["bounds"], serde_json::json!([256_000.0, 256_000.0, 258_560.0, 258_560.0]));
    for vertex in tile["tin"]["vertices"].as_array().unwrap() {
        assert_eq!(vertex[2], 1234.5);
    }
}

/// A plane is its own TIN on every level: no error anywhere, and the corner heights are the
/// plane's.
#[test]
fn a_plane_is_reproduced_on_every_level() {
    let folder = tempfile::tempdir().unwrap();
    let plane = |column: usize, row: usize| 500.0 + 0.5 * column as f64 - 0.25 * row as f64;
    let dem = write_grid(folder.path(), 513, plane);
    let package = build(folder.path(), &dem, &["--max-error", "1"]);
    let report = json(&["verify", text(&package), "--dem", text(&dem), "--json", "--quiet"]);
    assert_eq!(report["holds"], true, "{report}");
    for level in report["errors"].as_array().unwrap() {
        assert!(level["largest_true_m"].as_f64() < Some(0.02), "{level}");
    }
}

/// Data that ends one cell beyond a tile: the coarser level has no cell there, and nothing breaks.
#[test]
fn ground_that_no_coarser_tile_covers_is_still_accounted_for() {
    let folder = tempfile::tempdir().unwrap();
    let waves = |column: usize, row: usize| {
        900.0 + 40.0 * (column as f64 * 0.07).sin() * (row as f64 * 0.05).cos()
    };
    for side in [514, 258] {
        let dem = write_grid(folder.path(), side, waves);
        let package = build(folder.path(), &dem, &["-O"]);
        let report = json(&["verify", text(&package), "--dem", text(&dem), "--json", "--quiet"]);
        assert_eq!(report["holds"], true, "{side}: {report}");
    }
}

/// A target that cannot grow beyond 100 kB, as on a full disk: exit code 1, and no files remain.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    let script = "trap '' XFSZ; ulimit -f 200; exec \"$0\" build --dem \"$1\" -o \"$2\" --quiet";
    let output = std::process::Command::new("sh")
        .args(["-c", script, text(&e2e::binary()), text(&dem), text(&package)])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("limit on the size of files"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn an_input_is_never_replaced_by_the_package() {
    let folder = tempfile::tempdir().unwrap();
    let dem = write_grid(folder.path(), 40, |_, _| 5.0);
    let before = fs::read(&dem).unwrap();
    let ran =
        corniche(["build", "--dem", text(&dem), "-o", text(&dem), "-O", "--dem-crs", "EPSG:32632"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert_eq!(fs::read(&dem).unwrap(), before);
}

/// `verify` reports another raster on the same grid as another input, not as a broken package.
#[test]
fn verify_refuses_other_heights_than_those_it_was_made_from() {
    let folder = tempfile::tempdir().unwrap();
    let dem = write_grid(folder.path(), 257, |_, _| 5.0);
    let package = build(folder.path(), &dem, &[]);
    let other = write_grid(folder.path(), 257, |_, _| 6.0);
    let ran = corniche(["verify", text(&package), "--dem", text(&other), "--quiet"]);
    assert_eq!(ran.code, 2, "{}{}", ran.out, ran.err);
    assert!(ran.err.contains("grid.asc"), "{}", ran.err);
}
