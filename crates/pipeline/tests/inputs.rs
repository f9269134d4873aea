//! Inputs that are unusual or cannot be used, through the whole pipeline.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

mod support;

use std::{fs, path::Path};

use corniche_pipeline::BuildError;
use support::{Options, Raster, build_files, build_raster, terrain::waves};

fn hills() -> Raster {
    Raster::new([300, 200], [5, 9], |column, row| 100.0 * waves(column, row))
}

/// Names that only GDAL understands: here a file inside another, as in an archive.
#[test]
fn a_raster_inside_another_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let [dem, container] = ["dem.tif", "container"].map(|name| folder.path().join(name));
    hills().write(&dem);
    let bytes = fs::read(&dem).unwrap();
    fs::write(&container, [b"padding".to_vec(), bytes.clone()].concat()).unwrap();
    let inside = format!("/vsisubfile/7_{},{}", bytes.len(), container.display());
    let built = build_files(Path::new(&inside), None, Options::plain(5.0)).unwrap();
    let plain = build_files(&dem, None, Options::plain(5.0)).unwrap();
    assert_eq!(built.tiles, plain.tiles);
    assert_eq!(built.manifest.inputs[0].sha256, "not hashed: virtual");
}

/// A raster is named inside its container; the container is hashed, and no folder gets into the package.
#[test]
fn a_raster_of_a_container_is_read_and_its_container_hashed() {
    let folder = tempfile::tempdir().unwrap();
    let dem = folder.path().join("dem.tif");
    hills().write(&dem);
    let inside = format!("GTIFF_DIR:1:{}", dem.display());
    let built = build_files(Path::new(&inside), None, Options::plain(5.0)).unwrap();
    let plain = build_files(&dem, None, Options::plain(5.0)).unwrap();
    assert_eq!(built.tiles, plain.tiles);
    let [inside, whole] = [&built, &plain].map(|built| &built.manifest.inputs[0]);
    assert_eq!((inside.name.as_str(), &inside.sha256), ("GTIFF_DIR:1:dem.tif", &whole.sha256));
}

/// Steps of 32 bits reach neither a sentinel that nobody declared nor, when they are tiny, any mountain.
#[test]
fn a_height_that_steps_do_not_reach_is_refused_as_bad_input() {
    for (height_m, max_error_m) in [(6e6_f32, 0.05), (-6e6, 0.05), (600.0, 1e-5)] {
        let mut raster = hills();
        raster.heights_m[150 * 300 + 100] = height_m;
        let refused = build_raster(&raster, Options::plain(max_error_m)).err().unwrap();
        assert!(refused.is_unusable_input(), "{height_m}: {refused}");
        let reason = std::error::Error::source(&refused).unwrap().to_string();
        assert!(reason.contains(&height_m.to_string()) && reason.contains("nodata"), "{reason}");
    }
}

#[test]
fn a_tolerance_beyond_what_numbers_hold_is_refused_as_such() {
    for max_error_m in [1.1e9, 1e308, 0.9e-9, 5e-324, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = build_raster(&hills(), Options::plain(max_error_m)).err().unwrap();
        assert!(matches!(refused, BuildError::MaxError { .. }), "{max_error_m}: {refused}");
    }
    // The largest that is not: a tile has its corners, and where the data end in it a few more.
    let built = build_raster(&hills(), Options::plain(1e9)).unwrap();
    assert!(built.grounds().all(|(_, ground)| (4..=9).contains(&ground.tin.vertices().len())));
    // The smallest: level ground needs no more.
    let level = Raster::new([300, 200], [5, 9], |_, _| 0.0);
    let built = build_raster(&level, Options::plain(1e-9)).unwrap();
    assert!(built.grounds().all(|(_, ground)| ground.geometric_error_m == 0.0));
}
