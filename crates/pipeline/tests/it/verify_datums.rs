//! `verify` of a package from several bands in another datum, as it is and as an earlier version
//! would have written it.

#![allow(clippy::unwrap_used, reason = "helpers of tests may unwrap")]

use std::path::PathBuf;

use crate::support::{
    Options,
    parts::{MAX_ERROR_M, assert_broken, rehash, write},
    settings,
};
use corniche_geom::TileId;
use corniche_pipeline::build;
use corniche_testing::Raster;
use corniche_tileset::{FilePackage, Manifest};
use corniche_verify::{CheckId, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;
use tempfile::TempDir;

/// A package from the first of two bands in ETRS89, and its inputs.
struct OfTwoBands {
    folder: TempDir,
    dem: PathBuf,
    manifest: Manifest,
    tiles: Vec<(TileId, Vec<u8>)>,
}

impl OfTwoBands {
    /// The second band is zero everywhere.
    fn build() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let frame = [500_000.0, 30.0, 0.0, 5_200_000.0, 0.0, -30.0];
        let height = |[x, y]: [f64; 2]| (300.0 + (x / 100.0).sin() * 40.0 + y / 1e5) as f32;
        let dem =
            Raster::new(25832, [40, 40], frame).bands(2).write(folder.path(), "two.tif", height);
        let output = folder.path().join("sound.pmtiles");
        let mut asked = settings(dem.clone(), None, output.clone(), Options::plain(MAX_ERROR_M));
        asked.plan.terrain.open.band = Some(1);
        build(&asked, &Silent).unwrap();
        let package = FilePackage::open(&output).unwrap();
        let ids = package.tile_ids().unwrap().into_iter();
        let tiles = ids.map(|id| (id, package.tile(id).unwrap().unwrap())).collect();
        let manifest = package.manifest().clone();
        Self { folder, dem, manifest, tiles }
    }

    /// The report on the package with a changed manifest, against its elevation files.
    fn changed(&self, change: impl Fn(&mut Manifest)) -> VerifyReport {
        let mut manifest = self.manifest.clone();
        change(&mut manifest);
        rehash(&mut manifest);
        let path = self.folder.path().join("changed.pmtiles");
        write(&path, &manifest, &self.tiles).unwrap();
        let dem = vec![self.dem.clone()];
        let given = VerifySettings { dem, photo: Vec::new(), osm: None, threads: 2, polygon: None };
        verify(&FilePackage::open(&path).unwrap(), &given, &Silent).unwrap()
    }
}

/// Before the band was recorded, the first one was used, and files with several bands were
/// accepted.
#[test]
fn without_a_recorded_band_the_first_one_was_read() {
    let sound = OfTwoBands::build();
    assert_eq!(sound.manifest.settings.dem_band, Some(1));
    assert_broken(sound.changed(|manifest| manifest.settings.dem_band = None), &[]);
    let other = sound.changed(|manifest| manifest.settings.dem_band = Some(2));
    let nodes = other.checks.iter().find(|check| check.id == CheckId::Nodes).unwrap();
    assert!(!nodes.holds(), "heights are those of the second band");
}

/// Packages written before operations were recorded have the same `generator`.
#[test]
fn other_operations_between_datums_are_told_in_words_and_none_are_those_of_before() {
    let sound = OfTwoBands::build();
    assert_eq!(sound.manifest.datum_operations[0].operation, "ETRS89 to WGS 84 (1)");
    assert_broken(sound.changed(|manifest| manifest.datum_operations.clear()), &[]);
    let document =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/promises.md"))
            .unwrap();
    assert!(document.contains("| `datum_operations`, if left out | "), "docs/promises.md");
    let report = sound.changed(|manifest| {
        manifest.datum_operations[0].operation = "ETRS89 to WGS 84 (9)".to_owned();
    });
    let report = assert_broken(report, &[CheckId::Crs, CheckId::DemPlan]);
    for check in report.checks.iter().filter(|check| !check.holds()) {
        assert_eq!(
            check.examples,
            [
                "between geodetic datums, the package records \"ETRS89 to WGS 84 (9)\" from EPSG:25832 to EPSG:4326 (1 m); PROJ now uses \
              \"ETRS89 to WGS 84 (1)\" from EPSG:25832 to EPSG:4326 (1 m): one of its grids may have been installed or removed \
              since the build, so build the package again"
            ]
        );
    }
}
