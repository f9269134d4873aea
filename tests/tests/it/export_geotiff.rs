//! `export geotiff`: rasters that GDAL reads, compared with `tile --json` and with the elevation
//! files.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use e2e::{
    Ran, corniche, ended, json, manifest, names, real_data, sample, text, unfinished,
    write_ascii_grid,
};
use gdal::{Dataset, Metadata as _};
use serde_json::Value;

fn succeed(ran: Ran) -> Ran {
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    ran
}

/// A raster as GDAL reads it.
struct Raster {
    columns: usize,
    rows: usize,
    crs_from_pixel: [f64; 6],
    /// Band by band, row by row from the north.
    bands: Vec<Vec<f64>>,
    dataset: Dataset,
}

impl Raster {
    fn open(path: &Path) -> Self {
        let dataset = Dataset::open(path).unwrap();
        let (columns, rows) = dataset.raster_size();
        let bands = dataset
            .rasterbands()
            .map(|band| band.unwrap().read_band_as::<f64>().unwrap().data().to_vec())
            .collect();
        Self { columns, rows, crs_from_pixel: dataset.geo_transform().unwrap(), bands, dataset }
    }

    fn item(&self, name: &str) -> String {
        self.dataset.metadata_item(name, "").unwrap_or_default()
    }

    /// The position of the centre of a pixel.
    fn middle(&self, column: usize, row: usize) -> [f64; 2] {
        let [x, east, _, y, _, south] = self.crs_from_pixel;
        [x + east * (column as f64 + 0.5), y + south * (row as f64 + 0.5)]
    }

    fn at(&self, band: usize, column: usize, row: usize) -> f64 {
        self.bands[band][row * self.columns + column]
    }

    /// The values that are not nodata.
    fn numbers(&self, band: usize) -> impl Iterator<Item = f64> + '_ {
        self.bands[band].iter().copied().filter(|number| !number.is_nan())
    }
}

fn export(package: &Path, name: &str, more: &[&str]) -> (Raster, String) {
    let path = package.with_file_name(name);
    let words = ["export", "geotiff", text(package), "-o", text(&path)];
    let ran = succeed(corniche([&words[..], more].concat()));
    (Raster::open(&path), ran.err)
}

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|axis: usize| value[axis].as_f64().unwrap())
}

/// The nodes of the finest level and the heights of a level's triangles there, from `tile --json`:
/// found triangle by triangle with barycentric coordinates.
fn heights_by_node(package: &Path, level: u64) -> HashMap<[i64; 2], f64> {
    let manifest = manifest(package);
    let (origin, cell) = (pair(&manifest["frame"]["origin_m"]), pair(&manifest["frame"]["cell_m"]));
    let mut heights = HashMap::new();
    let info = json(&["info", text(package), "--json"]);
    for id in info["tiles"].as_array().unwrap().iter().map(|id| id.as_str().unwrap()) {
        if !id.starts_with(&format!("{level}/")) {
            continue;
        }
        let tile = json(&["tile", text(package), id, "--json"]);
        let vertices: Vec<[f64; 3]> = tile["tin"]["vertices"]
            .as_array()
            .unwrap()
            .iter()
            .map(|at| {
                let at_m = [0, 1, 2].map(|axis: usize| at[axis].as_f64().unwrap());
                [(at_m[0] - origin[0]) / cell[0], (at_m[1] - origin[1]) / cell[1], at_m[2]]
            })
            .collect();
        for triangle in tile["tin"]["triangles"].as_array().unwrap() {
            let [a, b, c] =
                [0, 1, 2].map(|k: usize| vertices[triangle[k].as_u64().unwrap() as usize]);
            let range = |axis: usize| {
                let at = [a, b, c].map(|corner| corner[axis].round() as i64);
                at[0].min(at[1]).min(at[2])..=at[0].max(at[1]).max(at[2])
            };
            let whole = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            for j in range(1) {
                for i in range(0) {
                    let (x, y) = (i as f64 - a[0], j as f64 - a[1]);
                    let of_b = (x * (c[1] - a[1]) - y * (c[0] - a[0])) / whole;
                    let of_c = ((b[0] - a[0]) * y - (b[1] - a[1]) * x) / whole;
                    if of_b >= -1e-9 && of_c >= -1e-9 && of_b + of_c <= 1.0 + 1e-9 {
                        heights.insert([i, j], a[2] + of_b * (b[2] - a[2]) + of_c * (c[2] - a[2]));
                    }
                }
            }
        }
    }
    heights
}

/// The node under the centre of each pixel, in cells, and the distance between both.
fn node_of(manifest: &Value, at: [f64; 2]) -> ([i64; 2], f64) {
    let (origin, cell) = (pair(&manifest["frame"]["origin_m"]), pair(&manifest["frame"]["cell_m"]));
    let unit = pair(&manifest["metres_per_unit"]);
    let cells = [0, 1].map(|axis: usize| (at[axis] * unit[axis] - origin[axis]) / cell[axis]);
    let node = cells.map(|at| at.round() as i64);
    let beside = [0, 1].map(|axis: usize| (cells[axis] - node[axis] as f64).abs());
    (node, beside[0].max(beside[1]))
}

/// Every pixel is the height of the package's triangles at its node, for every level; where there
/// are no triangles, it is nodata.
fn assert_is_ground(package: &Path, raster: &Raster, level: u64, most_m: f64) {
    let manifest = manifest(package);
    let mut wanted = heights_by_node(package, level);
    assert!(wanted.len() > 1000);
    for row in 0..raster.rows {
        for column in 0..raster.columns {
            let (node, beside) = node_of(&manifest, raster.middle(column, row));
            assert!(beside < 1e-6, "{beside} cells beside node {node:?}");
            let (found_m, known_m) = (raster.at(0, column, row), wanted.remove(&node));
            let is_same = match known_m {
                Some(known_m) => (found_m - known_m).abs() <= most_m,
                None => found_m.is_nan(),
            };
            assert!(is_same, "level {level}, node {node:?}: {found_m}, not {known_m:?}");
        }
    }
    assert!(wanted.is_empty(), "{} nodes with ground are beyond the raster", wanted.len());
}

#[test]
#[ignore = "slow: each node of several rasters"]
fn every_node_has_the_height_of_the_packages_triangles() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "5"]);
    let finest = manifest(&package)["frame"]["max_level"].as_u64().unwrap();
    for level in 0..finest {
        let (raster, _) = export(&package, "l.tif", &["--level", &level.to_string(), "-O"]);
        assert_eq!((raster.columns, raster.rows, raster.bands.len()), (1000, 1000, 1));
        // Pixels are f32: a rounding of 1e-4 m at 2 700 m.
        assert_is_ground(&package, &raster, level, 1.3e-4);
    }
    // Golden values, which come from no other program.
    let (raster, told) = export(&package, "finest.tif", &[]);
    assert_is_ground(&package, &raster, finest, 1.3e-4);
    assert!(told.contains("Float32") && told.contains("must be displayed"), "{told}");
    let mut crc = crc32fast::Hasher::new();
    raster.bands[0].iter().for_each(|height_m| crc.update(&(*height_m as f32).to_le_bytes()));
    let voids = raster.bands[0].iter().filter(|height_m| height_m.is_nan()).count();
    assert_eq!((crc.finalize(), voids), (GOLDEN_CRC, GOLDEN_VOIDS));
    let wanted = [534_000.0, 10.0, 0.0, 5_200_000.0, 0.0, -10.0_f64];
    assert_eq!(raster.crs_from_pixel.map(f64::to_bits), wanted.map(f64::to_bits));
    assert_eq!(raster.item("AREA_OR_POINT"), "Point");
    assert_eq!(
        (raster.item("PACKAGE"), raster.item("LEVEL")),
        ("pass.pmtiles".to_owned(), finest.to_string())
    );
    let levels = manifest(&package)["levels"].clone();
    let bound_m: f64 = raster.item("ERROR_BOUND_M").parse().unwrap();
    assert_eq!(Some(bound_m), levels[finest as usize]["geometric_error_m"].as_f64());
    assert!(
        raster.item("ATTRIBUTION").contains("OpenStreetMap contributors"),
        "{}",
        raster.item("ATTRIBUTION")
    );
    let band = raster.dataset.rasterband(1).unwrap();
    assert!(band.no_data_value().unwrap().is_nan());
    assert_eq!(band.block_size(), (256, 256));
    assert_eq!(band.description().unwrap(), "height of the TIN, metres");
    let structure = |name| raster.dataset.metadata_item(name, "IMAGE_STRUCTURE");
    assert_eq!(structure("COMPRESSION").as_deref(), Some("DEFLATE"));
    assert_eq!(names(folder.path()), ["finest.tif", "l.tif", "pass.pmtiles"], "one file each");
}

const GOLDEN_CRC: u32 = 808_173_356;
const GOLDEN_VOIDS: usize = 5_592;

/// The second band agrees with the figures of the command and of `info`.
#[test]
fn the_error_is_that_against_the_elevation_file() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "5"]);
    let dem = sample("pass/pass-dem.tif");
    let source = Raster::open(&dem);
    let levels = manifest(&package)["levels"].clone();
    for level in 0..levels.as_array().unwrap().len() {
        let name = format!("e{level}.tif");
        let (raster, told) =
            export(&package, &name, &["--level", &level.to_string(), "--dem", text(&dem)]);
        assert_eq!(raster.bands.len(), 2);
        let description = raster.dataset.rasterband(2).unwrap().description().unwrap();
        assert_eq!(description, "height of the TIN minus DEM, metres");
        assert_eq!(raster.item("DEM"), "pass-dem.tif");
        let (mut both, mut off) = (0_u64, 0_u64);
        for at in 0..source.bands[0].len() {
            let (sample_m, tin_m, error_m) =
                (source.bands[0][at], raster.bands[0][at], raster.bands[1][at]);
            let is_void = (sample_m - -9999.0).abs() < 0.5;
            if is_void || tin_m.is_nan() {
                assert!(error_m.is_nan(), "void at {at}");
                off += u64::from(!is_void);
                continue;
            }
            // Samples are whole sixteenths, so f32 holds them; heights of the TIN are rounded in
            // band 1 alone.
            assert!((tin_m - sample_m - error_m).abs() < 1.3e-4, "{tin_m} {sample_m} {error_m}");
            both += 1;
        }
        let said = &levels[level]["sample_error"];
        let figure = |name: &str| said[name].as_f64().unwrap();
        assert_eq!((said["on_tin"].as_u64(), said["off_tin"].as_u64()), (Some(both), Some(off)));
        let count = both as f64;
        let max_m = raster.numbers(1).fold(0.0, |most: f64, error_m| most.max(error_m.abs()));
        let rms_m =
            (raster.numbers(1).map(|error_m| error_m * error_m).sum::<f64>() / count).sqrt();
        let mut sorted: Vec<f64> = raster.numbers(1).map(f64::abs).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let p99_m = sorted[(0.99 * count).ceil() as usize - 1];
        let quantum_m = manifest(&package)["vertical"]["quantum_m"].as_f64().unwrap();
        assert!((max_m - figure("max_m")).abs() < 1e-5, "{max_m} {said}");
        assert!((rms_m - figure("rms_m")).abs() < quantum_m / 100.0, "{rms_m} {said}");
        assert!((0.0..=quantum_m + 1e-9).contains(&(figure("p99_m") - p99_m)), "{p99_m} {said}");
        let line = format!(
            "TIN minus DEM: max {:.3} m, RMS {:.3} m, p99 {:.3} m at ",
            figure("max_m"),
            figure("rms_m"),
            figure("p99_m")
        );
        assert!(told.contains(&line), "{line}\n{told}");
    }
}

/// The number of threads changes no byte.
#[test]
fn the_same_package_makes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let dem = sample("pass/pass-dem.tif");
    let bytes = ["1", "3"].map(|threads| {
        let name = format!("t{threads}.tif");
        let _ = export(&package, &name, &["--threads", threads, "--dem", text(&dem)]);
        fs::read(folder.path().join(name)).unwrap()
    });
    assert!(bytes[0] == bytes[1], "other bytes");
}

/// A clipped raster is a part of the whole one.
#[test]
fn bounds_take_the_nodes_inside() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("a.asc");
    write_degrees(&dem, [301, 201]);
    let package = folder.path().join("a.pmtiles");
    build(&package, &dem, &["--dem-crs", "EPSG:4326", "--max-error", "4"]);
    let (whole, _) = export(&package, "whole.tif", &[]);
    assert_eq!((whole.columns, whole.rows), (301, 201));
    // West and north between nodes, south and east on them.
    let (part, _) = export(&package, "part.tif", &["--bounds", "9.0505,47.02,9.2,47.0995"]);
    assert_eq!((part.columns, part.rows), (151, 81));
    for row in 0..part.rows {
        for column in 0..part.columns {
            let ([x, y], [lon, lat]) = (part.middle(column, row), [9.05, 47.1]);
            assert!((x - (lon + 0.001 * column as f64)).abs() < 1e-9, "{x}");
            assert!((y - (lat - 0.001 * row as f64)).abs() < 1e-9, "{y}");
            let known = whole.at(0, column + 50, row + 100);
            assert_eq!(part.at(0, column, row).to_bits(), known.to_bits());
        }
    }
}

/// An ASCII grid of heights in degrees, the south-western sample at 9° E, 47° N.
fn write_degrees(path: &Path, [columns, rows]: [usize; 2]) {
    let place = "xllcenter 9\nyllcenter 47\ncellsize 0.001\nNODATA_value -9999";
    write_ascii_grid(path, [columns, rows], place, |column, row| {
        // A void of 40 × 30 samples.
        if (100..140).contains(&column) && (60..90).contains(&row) {
            return -9999.0;
        }
        let (x, y) = (column as f64, (rows - 1 - row) as f64);
        (4.0 * (400.0 + 150.0 * (x * 0.21).sin() + 90.0 * (y * 0.33).cos())).round() / 4.0
    });
}

fn build(package: &Path, dem: &Path, options: &[&str]) {
    let words = ["build", "--dem", text(dem), "-o", text(package), "-q", "-O"];
    succeed(corniche([&words[..], options].concat()));
}

/// Centres of pixels are the samples of the file, for pixel-is-area and pixel-is-point and for
/// every unit of coordinates.
#[test]
fn pixels_are_the_samples_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("a.pmtiles");
    // By the file's header: the middle of the south-western sample, the cell, and a CRS: degrees,
    // metres, US survey feet.
    let degrees = ("EPSG:4326", "xllcenter 9\nyllcenter 47\ncellsize 0.001", [9.0, 47.0], 0.001);
    let metres = (
        "EPSG:32632",
        "xllcorner 500000\nyllcorner 5200000\ncellsize 25",
        [500_012.5, 5_200_012.5],
        25.0,
    );
    let feet = (
        "EPSG:2227",
        "xllcorner 6000000\nyllcorner 2000000\ncellsize 30",
        [6_000_015.0, 2_000_015.0],
        30.0,
    );
    let westwards = (
        "EPSG:2048",
        "xllcorner 10000\nyllcorner 3700000\ncellsize 20",
        [10_010.0, 3_700_010.0],
        20.0,
    );
    for (crs, place, first, cell) in [degrees, metres, feet, westwards] {
        let dem = folder.path().join("dem.asc");
        let height_m = |column: usize, row: usize| 500.0 + ((column * 7 + row * 3) % 90) as f64;
        write_ascii_grid(&dem, [120, 90], place, height_m);
        build(&package, &dem, &["--dem-crs", crs, "--max-error", "0.5"]);
        let (raster, told) = export(&package, "a.tif", &["-O", "--dem", text(&dem)]);
        let found = manifest(&package);
        assert_eq!(found["nodes_are_samples"], true, "{crs}");
        assert_eq!(raster.columns * raster.rows, 120 * 90, "{crs}");
        for row in 0..raster.rows {
            for column in 0..raster.columns {
                let [x, y] = raster.middle(column, row);
                let [across, up] = [(x - first[0]) / cell, (y - first[1]) / cell];
                let beside = (across - across.round()).abs().max((up - up.round()).abs());
                assert!(beside < 1e-6, "{crs}: {beside} cells beside a sample");
                let wanted = height_m(across.round() as usize, 89 - up.round() as usize);
                let (tin_m, error_m) = (raster.at(0, column, row), raster.at(1, column, row));
                assert!((tin_m - wanted).abs() <= 0.51, "{crs}: {tin_m}, not {wanted}");
                assert!(
                    (tin_m - error_m - wanted).abs() < 1e-4,
                    "{crs}: {tin_m} {error_m} {wanted}"
                );
            }
        }
        let code = raster.dataset.spatial_ref().unwrap().auth_code().unwrap();
        assert_eq!(format!("EPSG:{code}"), crs);
        assert!(!told.contains("warning"), "{told}");
    }
}

/// Heights of a file in feet are exported in metres; a vertical datum is named if the package has
/// one.
#[test]
fn heights_are_metres_above_the_packages_datum() {
    let folder = tempfile::tempdir().unwrap();
    let (package, dem) = (folder.path().join("a.pmtiles"), folder.path().join("a.asc"));
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 25";
    let height_ft = |column: usize, row: usize| 2000.0 + ((column * 7 + row * 3) % 90) as f64;
    write_ascii_grid(&dem, [60, 60], place, height_ft);
    let options = ["--dem-crs", "EPSG:32632", "--max-error", "0.2"];
    build(&package, &dem, &options);
    let (raster, told) = export(&package, "a.tif", &[]);
    let reference = raster.dataset.spatial_ref().unwrap();
    assert!(!reference.is_compound() && reference.is_projected());
    assert!(told.contains("datum of the package: unknown"), "{told}");
    assert!((raster.at(0, 3, 5) - height_ft(3, 5)).abs() < 0.21);
    // NAVD88 in US survey feet.
    build(&package, &dem, &[&options[..], &["--dem-vertical-crs", "EPSG:6360"]].concat());
    let (raster, _) = export(&package, "a.tif", &["-O"]);
    let reference = raster.dataset.spatial_ref().unwrap();
    assert!(reference.is_compound(), "{}", reference.to_wkt().unwrap());
    let wkt = reference.to_wkt().unwrap();
    assert!(wkt.contains("North American Vertical Datum 1988"), "{wkt}");
    let wanted = height_ft(3, 5) * 1200.0 / 3937.0;
    assert!((raster.at(0, 3, 5) - wanted).abs() < 0.21, "{} {wanted}", raster.at(0, 3, 5));
}

/// If f32 would lose more than a tenth of the height quantum, pixels are f64.
#[test]
fn fine_heights_are_written_as_f64() {
    let folder = tempfile::tempdir().unwrap();
    let (package, dem) = (folder.path().join("a.pmtiles"), folder.path().join("a.asc"));
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 25";
    let height_m = |column: usize, row: usize| 3000.0 + ((column * 7 + row * 3) % 90) as f64 / 64.0;
    write_ascii_grid(&dem, [60, 60], place, height_m);
    build(&package, &dem, &["--dem-crs", "EPSG:32632", "--max-error", "0.02"]);
    let (raster, told) = export(&package, "a.tif", &[]);
    assert!(told.contains("Float64"), "{told}");
    let level = manifest(&package)["frame"]["max_level"].as_u64().unwrap();
    assert_is_ground(&package, &raster, level, 1e-9);
}

#[test]
fn what_cannot_be_a_raster_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let other = folder.path().join("other.tif");
    fs::copy(sample("pass/pass-dem.tif"), &other).unwrap();
    // The same region with other heights.
    let dataset = Dataset::open_ex(
        &other,
        gdal::DatasetOptions {
            open_flags: gdal::GdalOpenFlags::GDAL_OF_UPDATE,
            ..gdal::DatasetOptions::default()
        },
    )
    .unwrap();
    dataset
        .rasterband(1)
        .unwrap()
        .write((5, 5), (1, 1), &mut gdal::raster::Buffer::new((1, 1), vec![1000.0_f32]))
        .unwrap();
    dataset.close().unwrap();
    let taken = folder.path().join("taken.tif");
    fs::write(&taken, "mine").unwrap();
    let dem = sample("pass/pass-dem.tif");
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let before = names(folder.path());
    let cases: &[(&str, &[&str], i32, &str)] = &[
        ("a.png", &[], 2, "extension .tif"),
        ("a.tif", &["--level", "30"], 2, "has no level 30"),
        ("a.tif", &["--bounds", "1,1,2,2"], 2, "no ground in the requested area"),
        (
            "a.tif",
            &["--dem", text(&other)],
            2,
            "not the elevation files that the package was built from",
        ),
        ("a.tif", &["--dem", "nothing.tif"], 2, "nothing.tif"),
        ("a.tif", &["--polygon", text(&other)], 2, "--dem"),
        ("taken.tif", &[], 3, "already exists"),
    ];
    for (name, more, code, words) in cases {
        let ran =
            corniche([&["export", "geotiff", text(&package), "-o", &at(name)], *more].concat());
        assert_eq!(ran.code, *code, "{name} {more:?}: {}", ran.err);
        assert!(ran.err.contains(words), "{name} {more:?}: {}", ran.err);
        assert_eq!(names(folder.path()), before, "{name} {more:?}");
    }
    // An input is never overwritten.
    let copy = folder.path().join("copy.tif");
    fs::copy(&dem, &copy).unwrap();
    let words =
        ["export", "geotiff", text(&package), "-O", "-o", text(&copy), "--dem", text(&copy)];
    assert_eq!(corniche(words).code, 2);
    assert_eq!(fs::read(&copy).unwrap(), fs::read(&dem).unwrap());
    assert_eq!(fs::read(&taken).unwrap(), b"mine");
}

/// On a full disk, wherever the writing fails, no file remains that looks like a raster.
#[test]
#[cfg(target_os = "linux")]
fn a_raster_that_cannot_be_written_to_its_end_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "20"]);
    let target = folder.path().join("a.tif");
    let _ = export(&package, "a.tif", &[]);
    let whole = fs::metadata(&target).unwrap().len();
    fs::remove_file(&target).unwrap();
    for limit in [0, whole / 3, whole * 9 / 10, whole - 5000, whole - 1] {
        let mut limited = Command::new("prlimit");
        limited.arg(format!("--fsize={limit}")).arg(e2e::binary());
        limited.args(["export", "geotiff", text(&package), "-o", text(&target)]);
        let ran = Ran::from(limited.output().unwrap());
        assert_eq!(ran.code, 1, "{limit} of {whole}: {}{}", ran.out, ran.err);
        assert!(ran.err.contains("ulimit -f") && ran.err.contains("a.tif"), "{}", ran.err);
        assert!(!ran.err.contains("disk"), "{}", ran.err);
        assert_eq!(names(folder.path()), ["pass.pmtiles"]);
    }
}

/// After Ctrl-C at any moment, the file is either complete or does not exist.
#[test]
#[cfg(unix)]
fn an_interrupted_export_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("pass.pmtiles");
    e2e::copy_pass(&package, &["--max-error", "5"]);
    let target = folder.path().join("a.tif");
    let mut interrupted = 0;
    for round in 0..8 {
        let mut child = Command::new(e2e::binary())
            .args(["export", "geotiff", text(&package), "-o", text(&target), "--threads", "1"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while unfinished(folder.path()).is_none() && child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
            thread::sleep(Duration::from_millis(1));
        }
        // A little later in every round.
        thread::sleep(Duration::from_millis(10 * round));
        let _ = e2e::send_signal(&child, "INT");
        let ran = ended(&mut child);
        match ran.code {
            0 => {
                assert_eq!(Raster::open(&target).columns, 1000);
                fs::remove_file(&target).unwrap();
            }
            4 => interrupted += 1,
            code => panic!("exit code {code}: {}", ran.err),
        }
        assert_eq!(names(folder.path()), ["pass.pmtiles"], "round {round}");
    }
    assert!(interrupted > 0, "every export was faster than the signal");
}

/// Real heights: a square degree in degrees, and 1/3 arc second with a vertical datum.
#[test]
fn real_elevation_files_give_the_figures_of_info() {
    let cases = [("liechtenstein/N47E009.hgt", "30"), ("portland/portland-ned.tif", "3")];
    for (name, max_error) in cases {
        let Some(dem) = real_data(name) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let package: PathBuf = folder.path().join("a.pmtiles");
        build(&package, &dem, &["--max-error", max_error]);
        let source = Raster::open(&dem);
        let found = manifest(&package);
        assert_eq!(found["nodes_are_samples"], true, "{name}");
        for level in [2, found["frame"]["max_level"].as_u64().unwrap()] {
            let (raster, told) = export(
                &package,
                "a.tif",
                &["-O", "--level", &level.to_string(), "--dem", text(&dem)],
            );
            let said = &found["levels"][level as usize]["sample_error"];
            let figure = |key: &str| said[key].as_f64().unwrap();
            let line = format!(
                "max {:.3} m, RMS {:.3} m, p99 {:.3} m",
                figure("max_m"),
                figure("rms_m"),
                figure("p99_m")
            );
            assert!(told.contains(&line), "{name}: {line}\n{told}");
            // A node on a border whose own tile has no ground there has a height of the other tile.
            let borrowed = raster.numbers(1).count() as u64 - said["on_tin"].as_u64().unwrap();
            assert!(borrowed < 100, "{name}: {borrowed}");
            let count = format!("at {} samples", said["on_tin"]);
            assert!(told.contains(&count), "{name}: {count}\n{told}");
            for axis in 0..6 {
                let (own, of_file) = (raster.crs_from_pixel[axis], source.crs_from_pixel[axis]);
                let cell = source.crs_from_pixel[1];
                assert!((own - of_file).abs() < 1e-6 * cell, "{name}: {own}, not {of_file}");
            }
        }
    }
}
