//! Packages as wide as the earth are built and verified: a strip around the equator, the globe with
//! its poles, and data at a pole.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{path::Path, sync::Mutex};

use crate::support::{Options, settings, write_samples};
use corniche_geom::Bounds;
use corniche_pipeline::build;
use corniche_spec::BuildObserver;
use corniche_tileset::{FilePackage, Manifest};
use corniche_verify::{VerifySettings, verify};
use corniche_work::Silent;

/// Metres per degree of the equator.
const DEGREE_M: f64 = 20_037_508.342_789_244 / 180.0;

/// Writes a raster in WGS84 with cells of one degree from `west` and `north`; samples are in the
/// middle of cells.
fn degrees(path: &Path, size: [usize; 2], [west, north]: [f64; 2]) {
    let first = [west + 0.5, north - 0.5];
    let height_m = |k: usize| ((k % size[0]) * 7 + (k / size[0]) * 11) % 900;
    let values = (0..size[0] * size[1]).map(|k| height_m(k) as f32).collect();
    write_samples(path, [size[0], size[1]], (4326, first, [1.0; 2]), values);
}

/// Builds and verifies with the DEM: no check is broken.
fn checked(dem: &Path, options: Options) -> Manifest {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("wide.pmtiles");
    build(&settings(dem.to_path_buf(), None, package.clone(), options), &Silent).unwrap();
    let asked = VerifySettings {
        dem: vec![dem.to_path_buf()],
        photo: Vec::new(),
        osm: None,
        threads: 2,
        polygon: None,
    };
    let report = verify(&FilePackage::open(&package).unwrap(), &asked, &Silent).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    FilePackage::open(&package).unwrap().manifest().clone()
}

fn check_bounds(manifest: &Manifest, expected: [f64; 4]) {
    let found = manifest.wgs84_bounds.to_array();
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{found}, not {expected}");
    }
}

/// The heights of a strip around the equator are the DEM's own samples, from the first column all
/// around to the same one.
#[test]
fn a_strip_around_the_equator_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("strip.tif");
    degrees(&dem, [360, 20], [-180.0, 10.0]);
    let manifest = checked(&dem, Options::plain(50.0));
    assert_eq!(manifest.crs, "EPSG:4326");
    assert!(manifest.nodes_are_samples);
    assert_eq!(manifest.counts.samples.with_data, 361 * 20);
    check_bounds(&manifest, [-179.5, -9.5, 180.5, 9.5]);
}

/// A globe in degrees, with samples between the poles and on them.
#[test]
fn the_globe_is_built_in_its_own_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let options = Options { crs: Some("dem"), ..Options::plain(50.0) };
    for (north, rows) in [(90.0, 180), (90.5, 181)] {
        let dem = folder.path().join(format!("{rows}.tif"));
        degrees(&dem, [360, rows], [-180.0, north]);
        let manifest = checked(&dem, options);
        assert_eq!(manifest.counts.samples.with_data, 361 * rows as u64);
        check_bounds(&manifest, [-179.5, 0.5 - north, 180.5, north - 0.5]);
        // The table for readers without PROJ extends around the data, but not beyond the poles.
        let table = &manifest.coordinates;
        let Bounds { min_y, max_y, .. } = table.bounds();
        for y in [min_y, max_y] {
            let [_, lat] = table.wgs84_from_working([0.0, y]);
            assert!(lat.abs() <= 90.0 + 1e-9, "the table reaches a latitude of {lat}");
        }
    }
}

/// A globe in a projection that reaches from −180 to 180, and a strip up to a pole.
#[test]
fn what_has_longitudes_all_over_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let options = Options { crs: Some("dem"), ..Options::plain(50.0) };
    let dem = folder.path().join("plate.tif");
    let north_west = [-179.5 * DEGREE_M, 89.5 * DEGREE_M];
    let values = (0..360 * 180).map(|k| (k % 77) as f32).collect();
    write_samples(&dem, [360, 180], (4087, north_west, [DEGREE_M; 2]), values);
    check_bounds(&checked(&dem, options), [-179.5, -89.5, 180.5, 89.5]);
    let dem = folder.path().join("arctic.tif");
    degrees(&dem, [360, 20], [-180.0, 90.0]);
    check_bounds(&checked(&dem, options), [-179.5, 70.5, 180.5, 89.5]);
}

/// Data that do not fit one package in any CRS are rejected with a way out, and without naming an
/// option that the user did not give.
#[test]
fn what_does_not_fit_one_package_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |dem: &Path, crs: Option<&'static str>| {
        let output = folder.path().join("none.pmtiles");
        let options = Options { crs, ..Options::plain(50.0) };
        build(&settings(dem.to_path_buf(), None, output, options), &Silent).unwrap_err().to_string()
    };
    let check = |text: &str, words: &[&str]| {
        for word in words {
            assert!(text.contains(word), "{word:?} is not in: {text}");
        }
    };
    let globe = folder.path().join("globe.tif");
    degrees(&globe, [360, 180], [-180.0, 90.0]);
    let text = refused(&globe, None);
    check(&text, &["globe.tif", "25000000 m", "equal-area", "pass --crs dem"]);
    assert!(!text.contains("--cell 25000000"), "{text}");
    // Around a pole, longitudes cannot be tabulated.
    let arctic = folder.path().join("arctic.tif");
    degrees(&arctic, [360, 20], [-180.0, 90.0]);
    check(&refused(&arctic, None), &["does not fit one package", "a pole", "--crs dem"]);
    let pole = folder.path().join("pole.tif");
    let values = vec![1.0; 101 * 101];
    write_samples(&pole, [101, 101], (3413, [-500_000.0, 500_000.0], [10_000.0; 2]), values);
    check(&refused(&pole, None), &["does not fit one package", "a pole"]);
}

/// Records warnings.
#[derive(Default)]
struct Heard(Mutex<Vec<String>>);

impl BuildObserver for Heard {}

impl corniche_work::Observer for Heard {
    fn warning(&self, words: &str) {
        self.0.lock().unwrap().push(words.to_owned());
    }
}

/// A scale latitude without effect, in a projection that is true to scale, causes a warning; one
/// with an effect does not.
#[test]
fn a_latitude_that_changes_nothing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    let values: Vec<f32> = (0..40 * 40).map(|k| (k % 77) as f32).collect();
    for (epsg, north_west, step, is_told) in
        [(32632, [500_000.0, 5_200_000.0], 10.0, true), (4326, [9.0, 47.0], 0.001, false)]
    {
        write_samples(&dem, [40, 40], (epsg, north_west, [step; 2]), values.clone());
        let output = folder.path().join(format!("{epsg}.pmtiles"));
        let mut asked = settings(dem.clone(), None, output, Options::plain(5.0));
        asked.plan.terrain.plan.scale_latitude_deg = Some(46.5);
        let heard = Heard::default();
        build(&asked, &heard).unwrap();
        let warnings = heard.0.into_inner().unwrap();
        let told = warnings.iter().any(|words| words.contains("--scale-latitude 46.5"));
        assert_eq!(told, is_told, "{epsg}: {warnings:?}");
    }
}
