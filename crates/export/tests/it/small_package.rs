//! The exports of a package of four tiles, and their documentation.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use corniche_export::{
    ErrorKind, ExportSummary, FeatureCoordinates, FeatureField, FeatureRequest, FeaturesError,
    HeightSource, RoadFeatures, RoadHeights, VectorFormat, WayGrowth, edge_fields, export_roads,
    growth_by_way, road_fields,
};
use corniche_roads::FunctionalRoadClass;
use corniche_testing::{package, root};
use corniche_tileset::{FilePackage, InputRecord, payload_sizes};
use corniche_work::{Observer, Silent};

/// The small package with a CRS that PROJ reads and an extract among its inputs.
fn small_package(folder: &Path) -> PathBuf {
    let mut manifest = package::manifest();
    manifest.crs_wkt = String::from("EPSG:32632");
    manifest.inputs = vec![InputRecord {
        kind: "osm".to_owned(),
        name: "roads.osm.pbf".to_owned(),
        bytes: 1,
        sha256: String::new(),
    }];
    let tiles = package::ids().into_iter().map(|id| (id, package::encoded(id)));
    let path = folder.join("small.pmtiles");
    fs::write(&path, package::written_with(&manifest, tiles)).unwrap();
    path
}

fn request(memory_bytes: u64) -> FeatureRequest<FunctionalRoadClass> {
    FeatureRequest {
        format: VectorFormat::Csv,
        level: None,
        classes: FunctionalRoadClass::all().collect(),
        bounds: None,
        coordinates: FeatureCoordinates::Package,
        memory_bytes,
    }
}

fn export_pieces(
    package: &FilePackage,
    memory_bytes: u64,
    path: &Path,
    observer: &dyn Observer,
) -> Result<ExportSummary, FeaturesError> {
    let request = request(memory_bytes);
    let heights = RoadHeights::default();
    export_roads(package, &request, RoadFeatures::Pieces, None, heights, path, observer)
}

/// The file is the same, however little memory sorting has.
#[test]
fn memory_does_not_change_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&small_package(folder.path())).unwrap();
    let [one, two] = [500, 1 << 30].map(|memory_bytes| {
        let path = folder.path().join(format!("{memory_bytes}.csv"));
        let summary = export_pieces(&package, memory_bytes, &path, &Silent).unwrap();
        assert!(summary.features > 2 && summary.ways == 1, "{summary:?}");
        fs::read(path).unwrap()
    });
    assert!(one == two, "the bytes differ");
}

/// The growth of each way: on all levels, in the order of the ways, however little memory sorting
/// has.
#[test]
fn each_way_is_reported_once_with_all_levels() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&small_package(folder.path())).unwrap();
    let [one, two] = [500, 1 << 30].map(|memory_bytes| {
        let mut ways: Vec<WayGrowth> = Vec::new();
        growth_by_way(&package, folder.path(), memory_bytes, &Silent, |way| {
            ways.push(way.clone());
            Ok::<(), FeaturesError>(())
        })
        .unwrap();
        ways
    });
    assert_eq!(one, two);
    assert!(!one.is_empty() && one.is_sorted_by(|one, other| one.way_id < other.way_id), "{one:?}");
    let mut by_level = vec![0; usize::from(package::MAX_LEVEL) + 1];
    for id in package::ids() {
        for road in package::payload(id).roads_geo {
            by_level[usize::from(id.z())] += road.line.vertices.len() as u64;
        }
    }
    let told = |level: usize| one.iter().map(|way| way.geo_vertices[level]).sum::<u64>();
    assert_eq!((0..by_level.len()).map(told).collect::<Vec<u64>>(), by_level);
    assert!(by_level.iter().all(|&vertices| vertices > 0), "{by_level:?}");
    let refused =
        growth_by_way(&package, folder.path(), 500, &Silent, |_| Err(FeaturesError::Interrupted));
    assert!(matches!(refused, Err(FeaturesError::Interrupted)), "an error of the receiver ends it");
    let nowhere = folder.path().join("nowhere");
    let refused = growth_by_way(&package, &nowhere, 500, &Silent, |_| Ok::<(), FeaturesError>(()));
    assert!(matches!(refused, Err(FeaturesError::Sort { .. })), "{refused:?}");
}

/// Continues a number of times, then requests a stop.
struct Impatient {
    asks: AtomicU32,
}

impl Observer for Impatient {
    fn is_cancelled(&self) -> bool {
        let ask = |left: u32| left.checked_sub(1);
        self.asks.fetch_update(Ordering::Relaxed, Ordering::Relaxed, ask).is_err()
    }
}

/// An export stops whenever this is requested, while it reads and while it writes.
#[test]
fn an_export_stops_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let package = FilePackage::open(&small_package(folder.path())).unwrap();
    let mut stopped = 0;
    for asks in 0..20 {
        let path = folder.path().join(format!("{asks}.csv"));
        let impatient = Impatient { asks: AtomicU32::new(asks) };
        match export_pieces(&package, 1 << 20, &path, &impatient) {
            Err(FeaturesError::Interrupted) => stopped += 1,
            Ok(_) => break,
            Err(error) => panic!("{error}"),
        }
    }
    // Two finest tiles and one way.
    assert_eq!(stopped, 3);
}

/// A corrupt tile is named, and its error means that the package cannot be used.
#[test]
fn a_damaged_tile_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = small_package(folder.path());
    let package = FilePackage::open(&path).unwrap();
    let id = *package.tile_ids().unwrap().last().unwrap();
    // SV roads (roads drawn by shadow volumes), which are not exported, are the last section.
    let sv_tail = payload_sizes(&package.tile(id).unwrap().unwrap(), id).unwrap().sv_tail;
    let mut bytes = fs::read(&path).unwrap();
    let place = bytes.len() - sv_tail as usize - 10;
    bytes[place] ^= 0x55;
    fs::write(&path, bytes).unwrap();
    let package = FilePackage::open(&path).unwrap();
    let target = folder.path().join("a.csv");
    let error = export_pieces(&package, 1 << 20, &target, &Silent).unwrap_err();
    assert!(error.kind() == ErrorKind::Unusable && error.to_string().contains("2/"), "{error}");
}

/// The tables of fields in the documentation agree with the program.
#[test]
fn the_documentation_has_every_field() {
    let page = fs::read_to_string(root().join("docs/export-roads.md")).unwrap();
    let ground = road_fields(true, HeightSource::Ground);
    let dem = road_fields(true, HeightSource::Dem);
    let only_dem = dem.into_iter().filter(|field| !ground.contains(field)).collect();
    for fields in [ground.clone(), only_dem, edge_fields()] {
        let row = |field: &FeatureField| {
            let unit = if field.unit.is_empty() { "–" } else { field.unit };
            format!("| `{}` | {} | {unit} | {} |", field.name, field.kind.name(), field.meaning)
        };
        let table = fields.iter().map(row).collect::<Vec<String>>().join("\n");
        assert!(page.contains(&table), "docs/export-roads.md has another table than\n{table}");
    }
}
