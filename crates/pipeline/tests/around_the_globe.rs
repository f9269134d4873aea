//! Packages as wide as the earth, built and verified: a strip around the equator, the globe with its poles, and what lies at
//! a pole.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod support;

use std::path::Path;

use corniche_pipeline::{Silent, VerifySettings, build, verify};
use corniche_tileset::{FilePackage, Manifest};
use support::{Options, settings, write_samples};

/// A raster in WGS84 of whole degrees from `west` and `north`, samples in the middle of their cells.
fn degrees(path: &Path, size: [usize; 2], [west, north]: [f64; 2]) {
    let first = [west + 0.5, north - 0.5];
    let height_m = |k: usize| ((k % size[0]) * 7 + (k / size[0]) * 11) % 900;
    let values = (0..size[0] * size[1]).map(|k| height_m(k) as f32).collect();
    write_samples(path, (size[0], size[1]), (4326, first, [1.0; 2]), values);
}

/// Builds and verifies with the DEM: no check is broken.
fn checked(dem: &Path, options: Options) -> Manifest {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("wide.pmtiles");
    build(&settings(dem.to_path_buf(), None, package.clone(), options), &Silent).unwrap();
    let asked = VerifySettings {
        package: package.clone(),
        dem: vec![dem.to_path_buf()],
        osm: None,
        threads: 2,
    };
    let report = verify(&asked, &Silent).unwrap();
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

/// Heights of a strip around the equator are the DEM's own samples, from one end of longitudes to the other.
#[test]
fn a_strip_around_the_equator_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("strip.tif");
    degrees(&dem, [360, 20], [-180.0, 10.0]);
    let manifest = checked(&dem, Options::plain(50.0));
    assert_eq!(manifest.crs, "EPSG:4326");
    assert!(manifest.nodes_are_samples);
    assert_eq!(manifest.counts.samples.with_data, 360 * 20);
    check_bounds(&manifest, [-179.5, -9.5, 179.5, 9.5]);
}

/// The globe in its own degrees, with samples between the poles and on them.
#[test]
fn the_globe_is_built_in_its_own_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let options = Options { crs: Some("dem"), ..Options::plain(50.0) };
    for (north, rows) in [(90.0, 180), (90.5, 181)] {
        let dem = folder.path().join(format!("{rows}.tif"));
        degrees(&dem, [360, rows], [-180.0, north]);
        let manifest = checked(&dem, options);
        assert_eq!(manifest.counts.samples.with_data, 360 * rows as u64);
        check_bounds(&manifest, [-179.5, 0.5 - north, 179.5, north - 0.5]);
    }
}
