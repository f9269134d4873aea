//! Vector files of any bytes give lines or polygons, or are rejected.

use std::{fs, path::PathBuf, sync::LazyLock};

use corniche_gis::RegionPolygons;
use corniche_overlay::{LineFile, SavedLine, place, read};
use corniche_testing::package;
use corniche_tileset::Manifest;
use tempfile::TempDir;

/// The manifest of the small package, in a CRS that PROJ knows.
static MANIFEST: LazyLock<Manifest> = LazyLock::new(|| {
    let mut manifest = package::manifest();
    "EPSG:32632".clone_into(&mut manifest.crs_wkt);
    manifest
});

thread_local! {
    static FOLDER: TempDir = tempfile::tempdir().unwrap_or_else(|error| panic!("no temporary folder: {error}"));
}

/// Writes these bytes to a file; the first byte selects its extension, by which some programs
/// recognise the format.
fn file(data: &[u8]) -> Option<PathBuf> {
    let (&first, content) = data.split_first()?;
    let ending = ["geojson", "gpx", "kml", "csv"][usize::from(first % 4)];
    let path = FOLDER.with(|folder| folder.path().join(format!("a.{ending}")));
    fs::write(&path, content).ok()?;
    Some(path)
}

/// Reads or rejects these bytes as lines and places them on a package; a file of drawn lines is
/// saved as it was read.
///
/// # Panics
/// When a reader or the writer breaks a promise.
pub fn overlay(data: &[u8]) {
    let Some(path) = file(data) else { return };
    match read(&path, true) {
        Ok(found) => {
            assert!(!found.lines.is_empty() && found.notices().iter().all(|said| !said.is_empty()));
            let positions = found.lines.iter().flat_map(|line| &line.positions_deg);
            assert!(positions.flatten().all(|value| !value.is_infinite()), "infinite positions");
            match place(&found.lines, &MANIFEST) {
                Ok(placed) => {
                    assert!(placed.iter().all(|one| one.line < found.lines.len()));
                    assert!(placed.iter().all(|one| one.points.len() >= 2));
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    let Ok(drawn) = LineFile::read(&path) else { return };
    let lines = drawn.lines();
    let saved = |(number, shape, points): &(usize, _, Vec<[f64; 2]>)| SavedLine {
        feature: Some(*number),
        shape: *shape,
        points_deg: points.clone(),
        heights_m: None,
    };
    let text = drawn.text_with(&lines.iter().map(saved).collect::<Vec<_>>());
    if fs::write(&path, text).is_ok() {
        let again = LineFile::read(&path).map(|again| again.lines());
        assert!(again.is_ok_and(|again| again == lines), "the saved file differs");
    }
}

/// Reads or rejects these bytes as polygons; the same bytes always give the same polygons.
///
/// # Panics
/// When a reader breaks a promise.
pub fn polygon(data: &[u8]) {
    let Some(path) = file(data) else { return };
    match RegionPolygons::read(&path) {
        Ok(polygon) => {
            let again = RegionPolygons::read(&path).map(|again| again.canonical_bytes().to_vec());
            assert!(!polygon.canonical_bytes().is_empty());
            assert!(again.is_ok_and(|again| again == polygon.canonical_bytes()), "another polygon");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
