//! Several extracts give the same tiles as one extract with all their content; nothing depends on
//! their order.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test may unwrap, and says what it skips"
)]

use std::{
    collections::BTreeMap,
    fs,
    ops::RangeInclusive,
    path::{Path, PathBuf},
    process::Command,
};

use crate::support::{Options, Raster, extract::utm_to_degrees, settings, table, terrain::waves};
use corniche_geom::TileId;
use corniche_pipeline::build;
use corniche_plan::{BuildPlan, plan};
use corniche_spec::{BuildSettings, extract_bounds, inputs::extract_names};
use corniche_testing::{
    pbf::{BlockBuilder, plain_header, raw},
    real_data,
};
use corniche_tileset::{FilePackage, ManifestCounts};
use corniche_verify::{VerifyError, VerifyOsm, VerifyReport, VerifySettings, verify};
use corniche_work::Silent;

/// A raster, and roads with ids from 1 to 60 that share nodes; files hold some of them.
struct Files {
    folder: tempfile::TempDir,
    raster: Raster,
}

impl Files {
    fn new() -> Self {
        let raster = Raster::new([500, 400], [37, 90], |column, row| 300.0 * waves(column, row));
        let folder = tempfile::tempdir().unwrap();
        raster.write(&folder.path().join("dem.tif"));
        Self { folder, raster }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes the ways with these ids and all of their nodes: way k runs from west to east along
    /// nodes of a grid, and shares nodes with ways of other ids.
    fn extract(&self, name: &str, ids: RangeInclusive<i64>) -> PathBuf {
        let (mut block, mut nodes) = (BlockBuilder::new(), BTreeMap::new());
        for id in ids {
            let node_ids: Vec<i64> = (0..8).map(|k| 1 + (id * 3 + k * 7) % 97).collect();
            for &node in &node_ids {
                let at = [(node % 10) as f64 * 50.0 - 7.3, (node / 10) as f64 * 42.0 + 3.1];
                let [lon, lat] = utm_to_degrees(&[self.raster.position_m(at)])[0];
                let round = |deg: f64| (deg * 1e7).round() as i64;
                nodes.insert(node, (node, round(lat), round(lon)));
            }
            let highway = ["primary", "residential", "moat"][id as usize % 3];
            block.way(id, &[("highway", highway), ("name", "Weg")], &node_ids);
        }
        let mut of_nodes = BlockBuilder::new();
        of_nodes.dense(&nodes.into_values().collect::<Vec<_>>());
        let data = [of_nodes, block].map(|block| raw(b"OSMData", &block.bytes()));
        let path = self.at(name);
        fs::write(&path, [plain_header(), data.concat()].concat()).unwrap();
        path
    }

    fn settings(&self, name: &str, osm: &[PathBuf]) -> BuildSettings {
        let options = Options::plain(10.0);
        let mut settings = settings(self.at("dem.tif"), None, self.at(name), options);
        settings.plan.osm = extract_names(osm).unwrap();
        settings
    }
}

/// Reads the extracts of a package again.
fn verified(package: &Path, osm: &[PathBuf]) -> Result<VerifyReport, VerifyError> {
    let paths = extract_names(osm).unwrap();
    let settings = VerifySettings {
        dem: Vec::new(),
        photo: Vec::new(),
        osm: Some(VerifyOsm { paths, table: table(), memory_bytes: 64 << 20 }),
        threads: 2,
        polygon: None,
    };
    verify(&FilePackage::open(package)?, &settings, &Silent)
}

/// All tiles and counts of a package.
fn content(path: &Path) -> (BTreeMap<TileId, Vec<u8>>, ManifestCounts) {
    let package = FilePackage::open(path).unwrap();
    let ids = package.tile_ids().unwrap();
    let tiles = ids.into_iter().map(|id| (id, package.tile(id).unwrap().unwrap())).collect();
    (tiles, package.manifest().counts.clone())
}

fn made(settings: &BuildSettings) -> PathBuf {
    build(settings, &Silent).unwrap();
    settings.output.clone()
}

#[test]
fn overlapping_parts_make_the_tiles_and_counts_of_the_whole() {
    let files = Files::new();
    let whole = files.extract("whole.osm.pbf", 1..=60);
    let (east, west) =
        (files.extract("east.osm.pbf", 1..=40), files.extract("west.osm.pbf", 21..=60));
    let whole = made(&files.settings("whole.pmtiles", &[whole]));
    let (first, second) = ([east.clone(), west.clone()], [west.clone(), east.clone(), west]);
    let parts = made(&files.settings("parts.pmtiles", &first));
    let (tiles, counts) = content(&whole);
    let (of_parts, counts_of_parts) = content(&parts);
    assert!(of_parts == tiles, "tiles of two extracts");
    assert_eq!(counts_of_parts, counts);
    assert_eq!((counts.highways_in, counts.roads_in), (60, 40));
    // The order of the extracts changes no byte, and an extract that is named twice is read once.
    let turned = made(&files.settings("turned.pmtiles", &second));
    assert!(fs::read(&turned).unwrap() == fs::read(&parts).unwrap(), "another order");
    let inputs = FilePackage::open(&parts).unwrap().manifest().inputs.clone();
    let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(names, ["dem.tif", "east.osm.pbf", "west.osm.pbf"]);

    // Verify reads the extracts again, and needs all of them.
    let report = verified(&parts, &second).unwrap();
    let broken: Vec<_> = report.checks.iter().filter(|check| !check.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    for some in [&second[1..2], &[second[0].clone(), second[1].clone(), files.at("whole.osm.pbf")]]
    {
        let error = verified(&parts, some).unwrap_err();
        assert!(matches!(error, VerifyError::OtherOsm { .. }), "{error}");
    }
}

#[test]
fn a_plan_names_every_extract_and_sees_a_changed_one() {
    let files = Files::new();
    let (east, west) =
        (files.extract("east.osm.pbf", 1..=40), files.extract("west.osm.pbf", 21..=60));
    let settings = files.settings("a.pmtiles", &[west, east]);
    let planned = plan(&settings.plan, settings.resources, &Silent).unwrap().0;
    let read = BuildPlan::from_json(&planned.to_json().unwrap()).unwrap();
    assert_eq!(read.settings().unwrap().osm, settings.plan.osm);
    files.extract("west.osm.pbf", 22..=60);
    let said = BuildPlan::make(&settings.plan).unwrap().differences(&planned).join("; ");
    assert!(said.contains("west.osm.pbf has changed"), "{said}");
}

/// Cuts an extract into two that overlap, as a user would.
fn cut(osm: &Path, folder: &Path, boxes: [&str; 2]) -> Option<Vec<PathBuf>> {
    let cut = |(name, bounds): (&str, &str)| {
        let path = folder.join(name);
        let mut command = Command::new("osmium");
        command
            .args(["extract", "--set-bounds", "-s", "complete_ways", "-b", bounds, "-o"])
            .arg(&path)
            .arg(osm);
        let done = command.output().ok()?;
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        Some(path)
    };
    let cut: Option<Vec<PathBuf>> =
        ["south.osm.pbf", "north.osm.pbf"].into_iter().zip(boxes).map(cut).collect();
    if cut.is_none() {
        corniche_testing::skip("osmium is not installed");
    }
    cut
}

#[test]
fn a_country_in_two_parts_makes_the_tiles_of_the_whole() {
    let Some(osm) = real_data("liechtenstein/liechtenstein-2021-10-28.osm.pbf") else { return };
    let Some(dem) = real_data("liechtenstein/N47E009.hgt") else { return };
    let folder = tempfile::tempdir().unwrap();
    let boxes = ["9.0,46.5,10.0,47.17", "9.0,47.14,10.0,47.8"];
    let Some(parts) = cut(&osm, folder.path(), boxes) else { return };
    let build = |name: &str, osm: &[PathBuf]| {
        let mut settings =
            settings(dem.clone(), None, folder.path().join(name), Options::plain(30.0));
        settings.plan.osm = extract_names(osm).unwrap();
        settings.plan.terrain.plan.bounds_deg = Some([9.45, 47.04, 9.65, 47.28]);
        made(&settings)
    };
    let (whole, two) = (build("whole.pmtiles", &[osm]), build("two.pmtiles", &parts));
    let ((tiles, counts), (of_two, counts_of_two)) = (content(&whole), content(&two));
    assert!(counts.roads_in > 100, "{counts:?}");
    assert!(of_two == tiles, "tiles of two parts");
    assert_eq!(counts_of_two, counts);
    // Their bounds by their headers: around both boxes, with a margin.
    let [west, south, east, north] = extract_bounds(&parts).unwrap();
    assert!(west < 9.0 && south < 46.5 && east > 10.0 && north > 47.8);
    assert!(west > 8.9 && south > 46.4 && east < 10.1 && north < 47.9);
}
