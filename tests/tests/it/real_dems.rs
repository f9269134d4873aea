//! P2 on every real elevation model of the developers' data: no stored error is below the true one,
//! and few are far above it; and every unusable raster there is rejected by name.
//!
//! Each CI run checks some of them, different ones each day. The tests print one line per level:
//! the measured values, and the time. Some take minutes: `CORNICHE_TIER=full cargo test -p e2e
//! --test it real_dems -- --ignored --nocapture`.

use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use e2e::{corniche, real_data, some_of};
use serde_json::Value;

/// A DEM of one or more files below the data folder, and the options that `build` needs for it.
struct Dem {
    files: &'static [&'static str],
    options: &'static [&'static str],
}

const fn dem(files: &'static [&'static str], options: &'static [&'static str]) -> Dem {
    Dem { files, options }
}

/// A block of 4801 × 2401 samples.
const SRTM3_BLOCK: &[&str] = &[
    "srtm3-block/N47E007.hgt",
    "srtm3-block/N47E008.hgt",
    "liechtenstein/N47E009.hgt",
    "liechtenstein/N47E010.hgt",
    "srtm3-block/N48E007.hgt",
    "srtm3-block/N48E008.hgt",
    "srtm3-block/N48E009.hgt",
    "srtm3-block/N48E010.hgt",
];
/// 3601 × 3601 samples, read inside their archive; the northern half is void.
const JUAN_DE_FUCA: &[&str] = &["/vsizip/juan-de-fuca-1s/N48W125.hgt.zip"];

/// The path of a file as GDAL takes it; `None`, with a printed line, if the file is missing.
fn located(file: &str) -> Option<PathBuf> {
    let Some(archive) = file.strip_prefix("/vsizip/") else { return real_data(file) };
    let archive = real_data(archive)?;
    let inner = Path::new(archive.file_stem()?);
    // If the path of the archive begins with a slash, GDAL writes one more slash.
    Some(PathBuf::from(format!("/vsizip/{}/{}", archive.display(), inner.display())))
}

/// Builds a package at every sample of a DEM and verifies it against that DEM.
fn check(dem: &Dem) {
    let Some(files) = dem.files.iter().map(|file| located(file)).collect::<Option<Vec<_>>>() else {
        return;
    };
    let name = dem.files[0];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let package = folder.path().join("dem.pmtiles").display().to_string();
    let mut arguments = vec!["build".to_owned(), "--dem".to_owned()];
    let files = files.iter().map(|file| file.display().to_string());
    arguments.extend(files.clone());
    arguments.extend(dem.options.iter().map(|&option| option.to_owned()));
    arguments.extend(["-o", &package, "--quiet"].map(str::to_owned));
    let start = Instant::now();
    let ran = corniche(&arguments);
    assert_eq!(ran.code, 0, "{name}: {}", ran.err);
    let build_s = start.elapsed().as_secs_f64();

    let mut arguments = vec!["verify".to_owned(), package, "--dem".to_owned()];
    arguments.extend(files);
    arguments.extend(["--json", "--quiet"].map(str::to_owned));
    let start = Instant::now();
    let ran = corniche(&arguments);
    let report: Value = serde_json::from_str(&ran.out)
        .unwrap_or_else(|error| panic!("{name}: {error}: {}{}", ran.out, ran.err));
    let broken: Vec<&Value> =
        checks(&report).iter().filter(|check| check["holds"] == false).collect();
    assert!(broken.is_empty() && report["holds"] == true && ran.code == 0, "{name}: {broken:#?}");
    print_levels(name, &report, [build_s, start.elapsed().as_secs_f64()]);

    // A check without objects proves nothing.
    for id in ["P2.bound", "P2.tight", "P2.finest", "P2.samples"] {
        let looked_at = checks(&report)
            .iter()
            .any(|check| check["id"] == id && check["checked"].as_u64() > Some(0));
        assert!(looked_at, "{name}: {id} was not looked at");
    }
    let levels = report["errors"].as_array().expect("a list of levels");
    assert!(levels.last().is_some_and(|finest| finest["nodes"].as_u64() > Some(0)), "{name}");
    for level in levels {
        let ratio = &level["tightness"];
        let holds = |key: &str, range: std::ops::RangeInclusive<f64>| {
            ratio[key].as_f64().is_none_or(|ratio| range.contains(&ratio))
        };
        assert!(holds("min", 1.0 - 1e-6..=f64::MAX) && holds("p95", 0.0..=2.0), "{name}: {level}");
    }
}

fn checks(report: &Value) -> &[Value] {
    report["checks"].as_array().map_or(&[], Vec::as_slice)
}

#[expect(clippy::print_stdout, reason = "figures for whoever runs it with --nocapture")]
fn print_levels(name: &str, report: &Value, [build_s, verify_s]: [f64; 2]) {
    let mut text = format!("{name}: built in {build_s:.1} s, verified in {verify_s:.1} s\n");
    text += "  level  tiles       nodes  true error m  stored/true: min  median     p95     max  uncovered\n";
    for level in report["errors"].as_array().map_or(&[][..], Vec::as_slice) {
        let ratio = |key: &str| {
            level["tightness"][key].as_f64().map_or("–".to_owned(), |ratio| format!("{ratio:.4}"))
        };
        let count = |key: &str| level[key].to_string();
        let _ = writeln!(
            text,
            "  {:>5}  {:>5}  {:>10}  {:12.3}  {:>16}  {:>6}  {:>6}  {:>6}  {:>9}",
            count("level"),
            count("tiles"),
            count("nodes"),
            level["largest_true_m"].as_f64().unwrap_or(f64::NAN),
            ratio("min"),
            ratio("median"),
            ratio("p95"),
            ratio("max"),
            count("uncovered_nodes"),
        );
    }
    print!("{text}");
}

#[test]
#[ignore = "slow: builds and verifies real elevation models"]
fn errors_are_true_and_tight_in_the_alps() {
    let dems = [
        dem(&["liechtenstein/N47E009.hgt"], &[]),
        dem(&["liechtenstein/N47E010.hgt"], &[]),
        dem(&["tirol-5m/avaMal.tif"], &[]),
        dem(&["slovenia-1m/TM1_564_146.tif"], &[]),
        dem(&["registry/aletsch.tif"], &[]),
        dem(&["registry/zh_dem_25.tif"], &["--dem-crs", "EPSG:21781"]),
    ];
    some_of(&dems, [3, 3, 1]).for_each(check);
}

#[test]
fn errors_are_true_and_tight_elsewhere() {
    let dems = [
        dem(&["portland/portland-ned.tif"], &[]),
        dem(&["craterlake/craterlake-elev-16bit-30m.tif"], &["--nodata", "-32767"]),
        dem(&["swellendam/srtm_41_19_4326.tif"], &[]),
        dem(&["registry/N57E011.hgt"], &[]),
    ];
    some_of(&dems, [2, 2, 1]).for_each(check);
}

/// An image of 16 bits, used as heights because of its location; its nodata value is 1.
const DATELINE: &[&str] = &["--cell", "240", "--height-range", "0,65535"];

/// With voids of all kinds, in other units, upside down, across the antimeridian.
#[test]
#[ignore = "slow: builds and verifies real elevation models"]
fn errors_are_true_and_tight_on_awkward_rasters() {
    let dems = [
        dem(&["nasty/dem/portland-ned-nodata.tif"], &[]),
        dem(&["nasty/dem/qgis-dem_gaps.tif"], &[]),
        dem(&["nasty/dem/rasterio-float_raster_with_nodata.tif"], &[]),
        dem(&["nasty/dem/rio-tiler-cog_dateline.tif"], DATELINE),
        dem(&["nasty/derived-dem/feet.tif"], &[]),
        dem(&["nasty/derived-dem/nan-void-no-nodata-tag.tif"], &[]),
        dem(&["nasty/derived-dem/south-up.tif"], &[]),
        dem(&["nasty/derived-dem/void-32768-undeclared.tif"], &[]),
    ];
    some_of(&dems, [4, 4, 1]).for_each(check);
}

/// Cells several samples wide: heights are area averages.
#[test]
#[ignore = "slow: builds and verifies real elevation models"]
fn errors_are_true_and_tight_when_averaged() {
    let dems = [
        dem(SRTM3_BLOCK, &["--cell", "250"]),
        dem(JUAN_DE_FUCA, &["--cell", "120"]),
        dem(&["slovenia-1m/TM1_564_146.tif"], &["--cell", "4"]),
    ];
    some_of(&dems, [3, 3, 1]).for_each(check);
}

#[test]
#[ignore = "slow: a minute or two"]
fn errors_are_true_and_tight_at_full_resolution() {
    if !e2e::is_full("a minute or two") {
        return;
    }
    check(&dem(SRTM3_BLOCK, &[]));
    check(&dem(JUAN_DE_FUCA, &[]));
    check(&dem(&["nasty/dem/rio-tiler-cog_dateline.tif"], &["--height-range", "0,65535"]));
}

/// A tolerance far below the height steps of the data: nearly every node is a vertex.
#[test]
#[ignore = "slow: a minute or two"]
fn errors_are_true_and_tight_when_hardly_any_is_allowed() {
    if !e2e::is_full("a minute or two") {
        return;
    }
    check(&dem(&["liechtenstein/N47E009.hgt"], &["--max-error", "0.5"]));
    check(&dem(&["slovenia-1m/TM1_564_146.tif"], &["--max-error", "0.01"]));
    check(&dem(&["tirol-5m/avaMal.tif"], &["--max-error", "0.05"]));
}

/// Unusable rasters, with the words that must be in the message together with the name of the file.
#[test]
fn what_cannot_be_used_is_refused_by_name() {
    let cases = [
        ("nasty/dem/BigTIFF.tif", "not a DEM"),
        ("nasty/dem/BigTIFFMotorola.tif", "not a DEM"),
        ("nasty/dem/libtiff-test_ifd_loop_to_self.tif", "georeference"),
        ("nasty/dem/rasterio-all-nodata.tif", "not a DEM"),
        ("nasty/dem/rasterio-corrupt.tif", "not a DEM"),
        ("nasty/dem/rasterio-float_nan.tif", "--dem-crs"),
        ("nasty/dem/rasterio-rotated.tif", "--dem-crs"),
        (
            "nasty/dem/georef/austrian_capitals_model_tie_point_and_pixel_scale_pixel_is_area.tif",
            "no cell",
        ),
        (
            "nasty/dem/georef/austrian_capitals_model_tie_point_and_pixel_scale_pixel_is_point.tif",
            "no cell",
        ),
        ("nasty/dem/georef/austrian_capitals_model_tie_points_pixel_is_area.tif", "no cell"),
        ("nasty/dem/georef/austrian_capitals_model_tie_points_pixel_is_point.tif", "no cell"),
        ("nasty/dem/georef/austrian_capitals_model_transformation_pixel_is_area.tif", "no cell"),
        ("nasty/dem/georef/austrian_capitals_model_transformation_pixel_is_point.tif", "no cell"),
        ("nasty/derived-dem/1x1.tif", "at least 2 × 2"),
        ("nasty/derived-dem/1x512.tif", "at least 2 × 2"),
        ("nasty/derived-dem/all-void.tif", "every node is void"),
        ("nasty/derived-dem/N47E009.hgt", "whole .hgt files"),
        ("nasty/derived-dem/truncated-half.tif", "corrupt"),
        ("nasty/derived-dem/truncated-header-6-bytes.tif", "not a raster"),
        ("nasty/derived-dem/zero-bytes.tif", "empty"),
        ("nasty/osm/empty.osm.pbf", "raster"),
        ("craterlake/craterlake-imagery-30m.tif", "not a DEM"),
        ("registry/zh_dem_25.tif", "--dem-crs"),
    ];
    for (file, words) in cases {
        let Some(path) = real_data(file) else { continue };
        let folder = tempfile::tempdir().unwrap();
        let package = folder.path().join("dem.pmtiles");
        let ran = corniche([
            Path::new("build"),
            Path::new("--dem"),
            &path,
            Path::new("-o"),
            &package,
            Path::new("--quiet"),
        ]);
        assert_eq!(ran.code, 2, "{file}: {}", ran.err);
        assert!(ran.err.contains(file) && ran.err.contains(words), "{file}: {}", ran.err);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{file} left something behind");
    }
}
