//! Estimates grow with the work and match the packages from which the rates were derived.

use std::path::PathBuf;

use corniche_dem::PlanOptions;
use corniche_roads::{ClassFilter, FrcTable};
use corniche_spec::{PhotoChoice, PlanSettings, RoadSettings, TerrainSettings};
use corniche_work::Silent;

use super::*;

/// A file of one band with this number of columns and rows, in blocks.
pub(crate) fn file(size: [u64; 2], block: [u64; 2], file_bytes: u64) -> FileBlocks {
    FileBlocks { path: PathBuf::from("dem.tif"), size, block, sample_bytes: 4, file_bytes }
}

pub(crate) fn estimate(tiles: Vec<u64>, files: &[FileBlocks], threads: u64) -> BuildEstimate {
    let memory = MemoryEstimate::new(files, tiles.iter().sum(), threads);
    let nodes = tiles.last().copied().unwrap_or(0) << 16;
    let costs = Ground::recorded(nodes, 0.25).costs(nodes, &tiles);
    BuildEstimate::put_together(nodes, tiles, memory, 0, costs)
}

#[test]
fn a_file_of_one_strip_needs_its_whole_image_for_each_thread() {
    const IMAGE: u64 = 20_000 * 10_000 * 4;
    let strip = file([20_000, 10_000], [20_000, 10_000], 1 << 20);
    let memory = |threads| MemoryEstimate::new(std::slice::from_ref(&strip), 100, threads);
    assert_eq!(memory(1).block_bytes, IMAGE + (1 << 20));
    assert_eq!(memory(1).block_row_bytes, IMAGE);
    let more = memory(3).least_bytes - memory(1).least_bytes;
    assert_eq!(more, 2 * (IMAGE + (1 << 20) + rates::THREAD_BYTES));
    assert_eq!(memory(1).block_file, "dem.tif");
}

#[test]
fn a_file_in_tiles_needs_little_and_a_row_of_blocks_is_as_wide_as_the_file() {
    let tiled = file([100_001, 100_000], [512, 512], 0);
    let memory = MemoryEstimate::new(&[tiled], 0, 4);
    assert_eq!(memory.block_bytes, 1 << 20);
    assert_eq!(memory.block_row_bytes, 196 << 20);
    // The smallest value that `--memory` accepts is enough for four threads and ordinary files.
    assert!(memory.least_bytes <= corniche_spec::machine::MIN_MEMORY_BYTES, "{memory:?}");
}

#[test]
fn four_times_the_tiles_take_four_times_the_disk() {
    let small = estimate(vec![0, 1000, 4000], &[], 1);
    let large = estimate(vec![0, 4000, 16_000], &[], 1);
    assert!(small.store_bytes > 4000 * rates::HEIGHTS_BYTES);
    for (small, large) in [
        (small.store_bytes, large.store_bytes),
        (small.package_bytes, large.package_bytes),
        (small.seconds.round() as u64, large.seconds.round() as u64),
    ] {
        assert!((4 * small).abs_diff(large) <= 8, "{small} {large}");
    }
}

#[test]
fn the_extract_takes_disk_too() {
    let memory = || MemoryEstimate::new(&[], 1, 2);
    let put = |extract_bytes| {
        let costs = Ground::recorded(1, 0.25).costs(1, &[1]);
        BuildEstimate::put_together(1, vec![1], memory(), extract_bytes, costs)
    };
    let extract = 1_u64 << 30;
    assert!(put(extract).store_bytes > put(0).store_bytes + extract);
    assert!(put(extract).package_bytes > put(0).package_bytes + extract / 4);
}

/// The packages from which the rates were derived (docs/lab/build-costs.md): nodes, triangles of
/// all levels and bytes of ground.
#[test]
fn recorded_rates_fit_what_they_were_taken_from() {
    for (name, nodes, tolerance_cells, triangles, bytes) in [
        ("N47E009, a 4th", 1_442_401, 0.25, 332_000.0, 432_000.0),
        ("N47E009, 10 m", 1_442_401, 0.159, 559_000.0, 651_000.0),
        ("N47E009, 5 m", 1_442_401, 0.0796, 1_079_000.0, 1_113_000.0),
        ("N47E009, a 16th", 1_442_401, 0.0625, 1_353_620.0, 1_364_000.0),
        ("eight squares, a 16th", 11_527_201, 0.0625, 9_562_000.0, 9_333_000.0),
        ("Tirol, a 16th", 446_229, 0.0625, 317_800.0, 354_400.0),
        ("Liechtenstein", 2_883_601, 0.25, 849_000.0, 1_096_000.0),
    ] {
        let ground = Ground::recorded(nodes, tolerance_cells);
        let all = ground.triangles_per_node * nodes as f64 * rates::ALL_PER_FINEST;
        assert!((0.75..1.35).contains(&(all / triangles)), "{name}: {all}");
        let memory = MemoryEstimate::new(&[], 39, 1);
        let costs = ground.costs(nodes, &[39]);
        let package = BuildEstimate::put_together(nodes, vec![39], memory, 0, costs).package_bytes;
        assert!((0.75..1.35).contains(&(package as f64 / bytes)), "{name}: {package}");
    }
}

/// Half of the tiles of the sample are enough to estimate the triangles of the finest level: 158
/// 772 (`corniche info`).
#[test]
fn some_tiles_tell_how_the_ground_is() {
    let table = FrcTable::new("one", vec![("motorway".to_owned(), 0)], Vec::new(), 0).unwrap();
    let settings = PlanSettings {
        dem: vec![corniche_testing::sample("pass/pass-dem.tif")],
        terrain_of: None,
        osm: Vec::new(),
        terrain: TerrainSettings {
            plan: PlanOptions { fill_voids: 32, ..PlanOptions::default() },
            max_error_m: Some(2.5),
            ..TerrainSettings::default()
        },
        roads: RoadSettings {
            table,
            filter: ClassFilter::usual(),
            simplify_cells: 0.25,
            spans: false,
        },
        photo: PhotoChoice::Off,
        layers: Vec::new(),
        attribution: Vec::new(),
        generator: "tests".to_owned(),
    };
    let opened = Opened::new(&settings).unwrap();
    let GroundSource::Dem(dem) = &opened.source else { panic!("it is a DEM") };
    let rectangles = dem.file_nodes(&opened.grid).unwrap();
    let finest = CoveredTiles::finest(&opened.grid.frame, &rectangles);
    assert_eq!(finest.count(), 25);
    let ground = Ground::sampled(&opened, dem, &finest, 1_000_000, &Silent).unwrap();
    assert_eq!(ground.rates, Rates::Sampled { tiles: 12 });
    let triangles = ground.triangles_per_node * 1e6;
    assert!((triangles / 158_772.0 - 1.0).abs() < 0.2, "{triangles}");
    assert!(ground.core_seconds > 0.0);

    // The complete estimate, as the program makes it: the data are too small to be sampled.
    let resources = Resources { threads: 2, memory_bytes: 1 << 30 };
    let estimate = BuildEstimate::from_opened(&opened, resources, &Silent).unwrap();
    assert_eq!((estimate.nodes, estimate.tiles.as_slice()), (1_000_000, &[1, 4, 9, 25][..]));
    assert_eq!(estimate.rates, Rates::Recorded);
    // The real package has 352 kB of ground.
    assert!((0.8..1.2).contains(&(estimate.package_bytes as f64 / 352_000.0)), "{estimate:?}");
}
