//! The TIN can be restored from a drawn tile, and lines that are draped later are on it.

use corniche_testing::package::written;
use corniche_tileset::{FilePackage, Sections};

use super::*;
use crate::tiles::{LineMethods, PackageSource, StyledLine, TileSource as _};

/// The restored vertices and triangles are those of the package.
#[test]
fn a_drawn_tile_gives_its_tin_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, written()).unwrap();
    let package = FilePackage::open(&path).unwrap();
    let source = PackageSource::open(&path).unwrap();
    let mut compared = 0;
    for id in package.tile_ids().unwrap() {
        let payload = package.payload(id, Sections::TERRAIN).unwrap().unwrap();
        let Some(terrain) = payload.terrain else { continue };
        let manifest = package.manifest();
        let tile = source.load(id).unwrap().without_roads();
        let found = tin_of(&tile, &manifest.frame, manifest.vertical.quantum_m).unwrap();
        assert_eq!(found.vertices(), terrain.tin.vertices(), "{id}");
        assert_eq!(found.triangles(), terrain.tin.triangles(), "{id}");
        compared += 1;
    }
    assert!(compared > 3, "{compared} tiles");
}

/// A line across the package is on the ground of every tile of every level, to a centimetre.
#[test]
fn a_drawn_line_lies_on_the_ground_of_every_level() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, written()).unwrap();
    let package = FilePackage::open(&path).unwrap();
    let source = PackageSource::open(&path).unwrap();
    let manifest = package.manifest();
    let bounds = manifest.data_bounds;
    let at = |x: f64, y: f64| {
        let place = [bounds.min_x + x * bounds.width(), bounds.min_y + y * bounds.height()];
        manifest.frame.snap(place).unwrap()
    };
    let points = vec![at(0.05, 0.1), at(0.6, 0.35), at(0.31, 0.77), at(0.98, 0.9)];
    let lines = [StyledLine { id: 1, style: 0, points }];
    let mut levels = std::collections::BTreeMap::new();
    for id in package.tile_ids().unwrap() {
        let tile = source.load(id).unwrap().without_roads();
        let Some(surface) = TileSurface::from_geometry(&tile, manifest) else { continue };
        let laid = surface.lay(&lines, LineMethods::Geometry).unwrap();
        for segment in laid.segments.all() {
            let along = |axis: usize| {
                let [from, to] = [segment.start_in_tile[axis], segment.end_in_tile[axis]];
                f64::from(from + segment.shares[0] * (to - from)) + tile.reference_m[axis]
            };
            let height_m = f64::from(segment.height_in_tile) + tile.reference_m[2];
            let ground_m = tile.ground_height_m([along(0), along(1)]).unwrap();
            // On a steep slope, rounding plan positions to f32 changes heights by some millimetres.
            assert!((height_m - ground_m).abs() <= 0.01, "{id}: {height_m} over {ground_m}");
            *levels.entry(id.z()).or_insert(0) += 1;
        }
    }
    assert!(levels.len() >= 2 && levels.values().all(|laid| *laid > 20), "{levels:?}");
}
