//! Impossible heights are rejected before the build begins. The message gives value, count, file
//! and the option that helps.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use e2e::{Ran, corniche, manifest, real_data, sample, text, write_ascii_grid};

/// Samples on a side.
const SIDE: usize = 200;
const UTM: [&str; 2] = ["--dem-crs", "EPSG:32632"];

/// Writes an ESRI ASCII grid of 10 m in UTM 32 that declares no nodata value.
fn raster(folder: &Path, name: &str, height: impl Fn(usize, usize) -> f64) -> PathBuf {
    let path = folder.join(name);
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 10";
    write_ascii_grid(&path, [SIDE; 2], place, height);
    path
}

fn hill(column: usize, row: usize) -> f64 {
    400.0 + ((column * 7 + row * 3) % 400) as f64
}

/// A hill whose first `count` samples, row by row, are `value`.
fn with(folder: &Path, value: f64, count: usize) -> PathBuf {
    let name = format!("with{value}.asc");
    raster(
        folder,
        &name,
        |column, row| {
            if row * SIDE + column < count { value } else { hill(column, row) }
        },
    )
}

fn build(dem: &Path, package: &Path, options: &[&str]) -> Ran {
    let mut line = vec!["build", "--dem", text(dem), "-o", text(package), "--quiet"];
    line.extend(UTM);
    line.extend(options);
    corniche(line)
}

#[test]
fn an_undeclared_value_is_refused_with_its_count_at_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for (value, count) in [("-9999", 777), ("-32767", 5), ("65535", 40_000 / 3)] {
        let dem = with(folder.path(), value.parse().unwrap(), count);
        let said: Vec<String> = ["1", "2", "8"]
            .map(|threads| {
                let ran = build(&dem, &package, &["--threads", threads]);
                assert_eq!(ran.code, 2, "{value}: {}", ran.err);
                assert!(!package.exists(), "{value}");
                ran.err
            })
            .to_vec();
        assert!(said.iter().all(|one| *one == said[0]), "{said:?}");
        let name = format!("with{value}.asc");
        let (count, way_out) = (format!("{count} of 40000 samples"), format!("--nodata {value}"));
        for word in [&count, &way_out, &name, "--height-range"] {
            assert!(said[0].contains(word), "{value} says {:?}, not {word:?}", said[0]);
        }
        let ran = build(&dem, &package, &["--nodata", value]);
        assert_eq!(ran.code, 0, "{value}: {}", ran.err);
        assert_eq!(
            manifest(&package)["settings"]["nodata"],
            serde_json::json!([value.parse::<f64>().unwrap()])
        );
        fs::remove_file(&package).unwrap();
    }
}

/// One sample in a million is enough if its value is a usual nodata value: −9999 m would be ground
/// otherwise.
#[test]
fn a_single_usual_value_for_no_data_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for value in ["-9999", "-999", "-32767", "65535", "-99999"] {
        let dem = with(folder.path(), value.parse().unwrap(), 1);
        let ran = build(&dem, &package, &[]);
        assert_eq!(ran.code, 2, "{value}: {}", ran.err);
        for word in ["1 of 40000 samples", &format!("--nodata {value}"), "--height-range"] {
            assert!(ran.err.contains(word), "{value}: {}", ran.err);
        }
        assert!(!package.exists(), "{value}");
    }
}

/// Another value may be a height: it is reported with its position, and with the option that
/// excludes it.
#[test]
fn a_single_sample_far_beyond_its_neighbours_is_told_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for (value, at) in [(5000.0, [50, 60]), (-1700.0, [0, 0]), (4000.0, [199, 7])] {
        let dem = raster(folder.path(), "spike.asc", |column, row| {
            if [column, row] == at { value } else { hill(column, row) }
        });
        let ran = build(&dem, &package, &["-O"]);
        assert_eq!(ran.code, 0, "{value}: {}", ran.err);
        // The grid's corner is at 500 000, 5 200 000, and its rows begin in the north.
        let [x, y] = [500_005 + 10 * at[0], 5_201_995 - 10 * at[1]];
        let place = format!("{value} m (stored as {value}) at {x}, {y} in EPSG:32632");
        let cell = format!("column {}, row {}", at[0], at[1]);
        for word in [&place, &cell, &format!("--nodata {value}"), "spike.asc"] {
            assert!(ran.err.contains(word), "{value}: {}", ran.err);
        }
        assert_eq!(ran.err.lines().count(), 1, "nothing else is said: {}", ran.err);
        let range = &manifest(&package)["vertical"]["range_m"];
        assert!(range[0] == value || range[1] == value, "{range}");
        let verified = corniche(["verify", text(&package), "--dem", text(&dem), "--quiet"]);
        assert_eq!((verified.code, &*verified.err), (0, ""), "{}", verified.out);
        let allowed = build(&dem, &package, &["-O", "--height-range", "-2000,9000"]);
        assert_eq!((allowed.code, &*allowed.err), (0, ""));
    }
}

/// Hawaii and Tenerife on a grid of half a degree: peaks of 4205 and 3715 m, whose neighbours are
/// sea floor of 4500 and 3500 m depth. The same heights a kilometre apart are outliers.
#[test]
fn islands_on_coarse_grids_are_no_single_samples() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    // In the last case, a mountain is higher than any on earth.
    for (degrees, peak_m, is_told) in
        [(0.5, 4205.0, false), (0.01, 4205.0, true), (0.5, 5500.0, true)]
    {
        let dem = folder.path().join("islands.asc");
        let place = format!("xllcorner -160\nyllcorner 0\ncellsize {degrees}");
        write_ascii_grid(&dem, [60, 60], &place, |column, row| match [column, row] {
            [9, 18] => peak_m,
            [50, 45] => 3715.0,
            [column, _] if column < 30 => -4500.0 - (column as f64),
            [column, row] => -3500.0 - (row as f64) - (column as f64) / 8.0,
        });
        let line = ["build", "-O", "--quiet", "--dem", text(&dem), "-o", text(&package)];
        let ran = corniche([&line[..], &["--dem-crs", "EPSG:4326", "--crs", "dem"]].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        assert_eq!(ran.err.contains("isolated samples"), is_told, "{degrees}: {}", ran.err);
    }
}

/// Samples outside the bounds do not count, however the file is stored; samples inside count as if
/// the file ended there.
#[test]
fn bounds_and_parts_are_judged_as_a_file_of_that_area() {
    let folder = tempfile::tempdir().unwrap();
    let [package, cut] = ["out.pmtiles", "cut.asc"].map(|name| folder.path().join(name));
    // Four samples in ten thousand of the west, one in ten thousand of the whole.
    let odd = |column: usize, row: usize| row == 100 && (20..24).contains(&column);
    let height = |column: usize, row: usize| {
        if odd(column, row) { -3000.0 } else { hill(column, row) }
    };
    let dem = raster(folder.path(), "whole.asc", height);
    let place = "xllcorner 500000\nyllcorner 5200000\ncellsize 10";
    write_ascii_grid(&cut, [100, SIDE], place, height);
    // West of 9.0131° E are 100 columns; east of 9.0145° E nothing is odd.
    let west = ["--bounds", "9.0,46.9,9.01309,47.0", "--fill-voids", "0"];
    let east = ["--bounds", "9.0145,46.9,9.03,47.0", "--fill-voids", "0"];
    let plain = ["--fill-voids", "0"];
    let of_cut = build(&cut, &package, &plain);
    assert!(of_cut.code == 2 && of_cut.err.contains("4 of 20000 samples"), "{}", of_cut.err);
    let of_bounds = build(&dem, &package, &west);
    assert!(of_bounds.code == 2 && of_bounds.err.contains("4 of 2"), "{}", of_bounds.err);
    assert_eq!(build(&dem, &package, &east).code, 0);
    // In the whole, 4 of 40 000 are no more than one in ten thousand, also if the work is split.
    let of_whole = build(&dem, &package, &["-O", "--fill-voids", "0"]);
    assert_eq!(of_whole.code, 0, "{}", of_whole.err);
    let inputs = [&["--dem", text(&dem), "--fill-voids", "0"][..], &UTM[..]].concat();
    assert!(e2e::built_in_parts(folder.path(), &inputs) == fs::read(&package).unwrap());
}

/// The error lists those of several files that have the value; also one without other values.
#[test]
fn the_files_that_hold_the_value_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let [good, bad] = ["good.asc", "bad.asc"].map(|name| folder.path().join(name));
    raster(folder.path(), "good.asc", hill);
    for (void_rows, count, of) in [(3, 600, 40_000), (SIDE, 40_000, 80_000)] {
        raster(
            folder.path(),
            "bad.asc",
            |column, row| {
                if row < void_rows { -9999.0 } else { hill(column, row) }
            },
        );
        let files = ["--dem", text(&good), text(&bad)];
        let rest = ["build", "-o", text(&package), "--quiet"];
        let ran = corniche(rest.into_iter().chain(UTM).chain(files));
        assert_eq!(ran.code, 2, "{}", ran.err);
        let said = format!("{count} of {of} samples of {bad:?} hold -9999");
        assert!(ran.err.contains(&said), "{} is not {said}", ran.err);
    }
}

#[test]
fn several_values_may_mean_no_data() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = raster(folder.path(), "two.asc", |column, row| match row {
        0..10 => -9999.0,
        10..20 => -32_767.0,
        _ => hill(column, row),
    });
    let ran = build(&dem, &package, &["--nodata", "-32767"]);
    assert!(ran.code == 2 && ran.err.contains("--nodata -9999"), "{}", ran.err);
    let both = ["--nodata", "-32767", "--nodata", "-9999", "--fill-voids", "0"];
    let ran = build(&dem, &package, &both);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let made = manifest(&package);
    assert_eq!(made["settings"]["nodata"], serde_json::json!([-32_767.0, -9999.0]));
    assert_eq!(made["counts"]["samples"]["void"], 20 * SIDE);
    let verified = corniche(["verify", text(&package), "--dem", text(&dem), "--quiet"]);
    assert_eq!(verified.code, 0, "{}{}", verified.out, verified.err);

    let config = folder.path().join("settings.toml");
    fs::write(&config, "[terrain]\nnodata = [-32767, -9999]\nfill-voids = 0\n").unwrap();
    let by_file = folder.path().join("by-file.pmtiles");
    let ran = build(&dem, &by_file, &["--config", text(&config)]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(fs::read(&package).unwrap(), fs::read(&by_file).unwrap());
}

#[test]
fn heights_outside_the_earths_are_refused_unless_a_range_allows_them() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    for (height, range) in
        [("9001", "0,9001"), ("-12000.5", "-12000.5,9000"), ("21229", "-8000,22000")]
    {
        let dem = with(folder.path(), height.parse().unwrap(), 1);
        let ran = build(&dem, &package, &[]);
        assert_eq!(ran.code, 2, "{height}: {}", ran.err);
        for word in ["1 of 40000 samples", height, ".asc", "--height-range", "--nodata"] {
            assert!(ran.err.contains(word), "{height} says {:?}, not {word:?}", ran.err);
        }
        let ran = build(&dem, &package, &["--height-range", range]);
        assert_eq!(ran.code, 0, "{height}: {}", ran.err);
        assert_eq!(ran.err, "", "what is allowed is no warning");
        let ends: Vec<f64> = range.split(',').map(|end| end.parse().unwrap()).collect();
        assert_eq!(manifest(&package)["settings"]["height_range_m"], serde_json::json!(ends));
        fs::remove_file(&package).unwrap();
    }
    // All heights in a range given with --height-range are accepted; the range may also be narrower
    // than the default.
    let dem = with(folder.path(), -9999.0, 500);
    assert_eq!(build(&dem, &package, &["--height-range", "-9999,9000"]).code, 0);
    let ran = build(&dem, &package, &["-O", "--height-range", "0,600"]);
    assert!(ran.code == 2 && ran.err.contains("-9999"), "{}", ran.err);
    for bad in ["5", "9000,0", "a,b", "0,inf"] {
        assert_eq!(build(&dem, &package, &["-O", "--height-range", bad]).code, 2, "{bad}");
    }
}

/// Heights are checked after conversion to metres: the same stored numbers are rejected as metres
/// and accepted as feet.
#[test]
fn heights_are_judged_in_metres_and_named_as_stored() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = with(folder.path(), 15_000.0, 1);
    let in_feet = folder.path().join("feet.vrt");
    let vrt = |unit: &str| {
        format!(
            "<VRTDataset rasterXSize=\"{SIDE}\" rasterYSize=\"{SIDE}\"><SRS>EPSG:32632</SRS>\
             <GeoTransform>500000, 10, 0, 5202000, 0, -10</GeoTransform>\
             <VRTRasterBand dataType=\"Float64\" band=\"1\"><UnitType>{unit}</UnitType><SimpleSource>\
             <SourceFilename relativeToVRT=\"1\">{}</SourceFilename><SourceBand>1</SourceBand>\
             </SimpleSource></VRTRasterBand></VRTDataset>",
            dem.file_name().unwrap().display()
        )
    };
    fs::write(&in_feet, vrt("ft")).unwrap();
    assert_eq!(build(&in_feet, &package, &[]).code, 0);
    fs::write(&in_feet, vrt("m")).unwrap();
    assert_eq!(build(&in_feet, &package, &["-O"]).code, 2);
    with(folder.path(), 15_000.0, 0);
    let sentinel = with(folder.path(), -9999.0, 100);
    fs::write(&in_feet, vrt("ft").replace("with15000", "with-9999")).unwrap();
    let ran = build(&in_feet, &package, &["-O"]);
    assert!(sentinel.exists() && ran.code == 2, "{}", ran.err);
    assert!(ran.err.contains("--nodata -9999") && ran.err.contains("-3047.6"), "{}", ran.err);
}

/// Many samples are 0 m (the sea), and land heights follow directly above.
#[test]
fn much_repeated_sea_level_is_ground() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = raster(folder.path(), "coast.asc", |column, row| match column {
        0..56 => 0.0,
        _ => ((column - 56) * 30 + row % 5) as f64,
    });
    assert_eq!(build(&dem, &package, &[]).code, 0);
}

#[test]
fn warnings_are_told_to_whoever_asks_for_silence() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    let dem = sample("pass/pass-dem.tif");
    for silence in ["--quiet", "--json-progress"] {
        let line =
            ["build", "--dem", text(&dem), "-O", "-o", text(&package), "--vertical-shift", "20000"];
        let ran = corniche(line.into_iter().chain([silence]));
        assert_eq!(ran.code, 0, "{}", ran.err);
        let warnings = ran.err.lines().filter(|line| line.contains("implausible height")).count();
        assert_eq!(warnings, 1, "{silence}: {}", ran.err);
        if silence == "--quiet" {
            assert_eq!(ran.err.lines().count(), 1, "nothing else is said: {}", ran.err);
        }
    }
}

/// Real cases: −32 767, which Crater Lake does not declare, and the sea of Juan de Fuca, 28 % of
/// its samples.
#[test]
fn real_rasters_are_judged_rightly() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("out.pmtiles");
    if let Some(dem) = real_data("craterlake/craterlake-elev-16bit-30m.tif") {
        let ran = corniche(["build", "--dem", text(&dem), "-o", text(&package), "--quiet"]);
        assert_eq!(ran.code, 2, "{}", ran.err);
        for word in ["39489 of 119691 samples", "--nodata -32767", "craterlake-elev-16bit-30m.tif"]
        {
            assert!(ran.err.contains(word), "{}", ran.err);
        }
    }
    if let Some(archive) = real_data("juan-de-fuca-1s/N48W125.hgt.zip") {
        let dem = format!("/vsizip/{}/N48W125.hgt", text(&archive));
        let ran =
            corniche(["build", "--dem", &dem, "--cell", "500", "-o", text(&package), "--quiet"]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        // The hash is that of the bytes that GDAL delivers.
        let input = &manifest(&package)["inputs"][0];
        assert_eq!(
            (input["name"].as_str(), input["bytes"].as_u64()),
            (Some("N48W125.hgt"), Some(25_934_402))
        );
        assert_eq!(input["sha256"].as_str().map(|hash| &hash[..12]), Some("048071e593e4"));
    }
}
