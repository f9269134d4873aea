//! A live map has the tiles that its views need, and tolerates corrupt tiles and the loss of the
//! device.

use std::{
    num::NonZeroUsize,
    time::{Duration, Instant},
};

use corniche_geom::{GridFrame, NodeIndex};
use corniche_tileset::TileTerrain;
use corniche_tin::{Tin, TinVertex};
use corniche_viewer::{
    camera::Orientation,
    tiles::{LoadTileError, PackageSource, TileLines, TileSource},
};
use glam::DVec2;

use super::*;
use crate::{
    loader_threads::LoaderThreads,
    polled_loader::{PolledLoader, late_package},
};

/// A package of two levels: ground at 100 m, 10 m higher in the finer level. One of its tiles is
/// corrupt.
struct Steps {
    frame: GridFrame,
}

const CELL_M: f64 = 10.0;
const DAMAGED: [u32; 2] = [1, 1];

impl TileCatalog for Steps {
    fn frame(&self) -> &GridFrame {
        &self.frame
    }

    fn exists(&self, id: TileId) -> bool {
        id.z() <= 1
    }
}

impl TileSource for Steps {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        if id.z() == 1 && [id.x(), id.y()] == DAMAGED {
            return Err(LoadTileError { id, source: "half of it is missing".into() });
        }
        let height_q = 100 + 10 * i32::from(id.z());
        let vertex = |row, column| TinVertex { row, column, height_q };
        let corners = vec![vertex(0, 0), vertex(0, 256), vertex(256, 0), vertex(256, 256)];
        let tin = Tin::new(corners, &[[0, 2, 1], [1, 2, 3]]);
        let tin = tin.unwrap_or_else(|error| panic!("{error}"));
        let terrain = TileTerrain {
            tin,
            normals: vec![[0, 0]; 4],
            geometric_error_m: if id.z() == 0 { 10.0 } else { 0.0 },
            height_range_m: [100.0, 110.0],
            uncovered_nodes: 0,
        };
        Ok(TileGeometry::assemble(id, Some(&terrain), &TileLines::default(), &self.frame, 1.0))
    }
}

fn tiles() -> Tiles {
    tiles_within(1 << 24)
}

fn tiles_within(gpu_bytes: u64) -> Tiles {
    let frame = GridFrame::new([0.0; 2], CELL_M, NodeIndex { i: 0, j: 512 }, 1);
    let source = Arc::new(Steps { frame: frame.unwrap_or_else(|error| panic!("{error}")) });
    let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(|| ());
    let loader = LoaderThreads::new(&source, NonZeroUsize::MIN, 8, &wake);
    let budget = StreamBudget { tiles_in_flight: 8, upload_bytes_per_frame: 1 << 20, gpu_bytes };
    let loader = Box::new(loader.unwrap_or_else(|error| panic!("{error}")));
    Tiles::new(source, loader, budget)
}

/// A camera that looks straight down on the middle of the package.
fn camera() -> Camera {
    let down = Orientation { heading_deg: 0.0, pitch_deg: 0.0 };
    Camera::look_at(DVec3::new(2560.0, 2560.0, 100.0), 7000.0, down, [400, 400])
}

/// Draws frames until nothing more happens; returns the errors.
fn settle(tiles: &mut Tiles, screen_space_error_px: f64) -> Vec<String> {
    let quality = Quality::by_error(screen_space_error_px, 1.0);
    let begun = Instant::now();
    let mut defects = Vec::new();
    loop {
        defects.extend(tiles.take_arrivals());
        let changes = tiles.choose(&camera(), None, quality);
        tiles.keep_ground(changes.upload);
        if !changes.is_under_way && tiles.missing == 0 && tiles.loading() == 0 {
            return defects;
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{} missing", tiles.missing);
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn heights_and_rays_find_the_ground_that_is_drawn() {
    let mut tiles = tiles();
    assert!(settle(&mut tiles, 1e6).is_empty());
    assert_eq!(tiles.drawn.len(), 1);
    let eye = camera().eye_in_world;
    let ground = tiles.ground(2.0, [100.0, 110.0]);
    let near = |height: Option<f64>, expected: f64| {
        assert!((height.unwrap() - expected).abs() < 1e-3, "{height:?}");
    };
    near(ground.height([2000.0, 3000.0]), 200.0);
    near(ground.hit(eye, DVec3::NEG_Z).map(|at| at.z), 200.0);
    assert_eq!(ground.height([9000.0, 0.0]), None, "beside the data");
    assert_eq!(ground.hit(eye, DVec3::Z), None, "the sky");
    near(Some(ground.base_height()), 210.0);

    settle(&mut tiles, 0.01);
    assert_eq!(tiles.drawn.len(), 3, "one of the four is damaged");
    let ground = tiles.ground(1.0, [100.0, 110.0]);
    near(ground.height([1000.0, 4000.0]), 110.0);
    near(ground.hit(eye - DVec3::X * 500.0, DVec3::NEG_Z).map(|at| at.z), 110.0);
}

#[test]
fn a_damaged_tile_is_told_of_once_and_the_others_are_shown() {
    let mut tiles = tiles();
    let defects = settle(&mut tiles, 0.01);
    assert_eq!(defects.len(), 1, "{defects:?}");
    assert!(defects[0].contains("1/1/1") && defects[0].contains("missing"), "{defects:?}");
    assert!(settle(&mut tiles, 0.01).is_empty());
}

#[test]
fn a_view_that_wants_more_than_may_be_held_is_full_and_another_is_not() {
    let root_bytes = {
        let mut tiles = tiles();
        settle(&mut tiles, 1e6);
        tiles.bytes_of_budget()[0]
    };
    let mut tiles = tiles_within(root_bytes + root_bytes / 2);
    settle(&mut tiles, 1e6);
    assert!(!tiles.is_full, "the root alone fits");
    let quality = Quality::by_error(0.01, 1.0);
    let begun = Instant::now();
    while !tiles.is_full {
        tiles.take_arrivals();
        let changes = tiles.choose(&camera(), None, quality);
        tiles.keep_ground(changes.upload);
        assert!(begun.elapsed() < Duration::from_secs(30), "{} missing", tiles.missing);
    }
    assert!(tiles.missing > 0 && tiles.loading() == 0);
    settle(&mut tiles, 1e6);
    assert!(!tiles.is_full, "the root alone still fits");
}

#[test]
fn after_a_loss_everything_is_asked_for_again() {
    let mut tiles = tiles();
    settle(&mut tiles, 0.01);
    let before = tiles.drawn.clone();
    let [bytes, _] = tiles.bytes_of_budget();
    tiles.begin_again();
    assert!(tiles.drawn.is_empty());
    assert_eq!(tiles.bytes_of_budget()[0], 0);
    settle(&mut tiles, 0.01);
    assert_eq!((&tiles.drawn, tiles.bytes_of_budget()[0]), (&before, bytes));
}

#[test]
fn what_arrives_from_before_a_loss_does_not_count_twice() {
    let mut tiles = tiles();
    let quality = Quality::by_error(0.01, 1.0);
    // The root is requested, forgotten, and requested again while it may still be loading.
    tiles.choose(&camera(), None, quality);
    tiles.begin_again();
    settle(&mut tiles, 0.01);
    assert_eq!((tiles.drawn.len(), tiles.loading()), (3, 0));
    assert!(tiles.waiting.is_empty(), "{:?}", tiles.waiting.keys());
}

/// The drawn tiles of the small package once nothing is missing, and their bytes.
fn shown(catalog: Arc<dyn TileCatalog>, loader: Box<dyn TileLoader>) -> (Vec<DrawnTile>, u64) {
    let bounds = catalog.frame().tile_bounds(TileId::ROOT);
    let middle = DVec3::from((DVec2::from(bounds.center()), 0.0));
    let down = Orientation { heading_deg: 0.0, pitch_deg: 0.0 };
    let camera = Camera::look_at(middle, 2.0 * bounds.width(), down, [400, 400]);
    let quality = Quality::by_error(0.01, 1.0);
    let budget =
        StreamBudget { tiles_in_flight: 8, upload_bytes_per_frame: 1 << 20, gpu_bytes: 1 << 24 };
    let mut tiles = Tiles::new(catalog, loader, budget);
    let begun = Instant::now();
    loop {
        let defects = tiles.take_arrivals();
        assert!(defects.is_empty(), "{defects:?}");
        let changes = tiles.choose(&camera, None, quality);
        tiles.keep_ground(changes.upload);
        if !changes.is_under_way && tiles.missing == 0 && tiles.loading() == 0 {
            return (tiles.drawn.clone(), tiles.bytes_of_budget()[0]);
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{} missing", tiles.missing);
    }
}

#[test]
fn tiles_that_nothing_waits_for_are_shown_as_those_on_disk() {
    let late = late_package(corniche_testing::package::written());
    let found = shown(late.clone(), Box::new(PolledLoader::new(&late)));
    assert!(found.0.len() > 1, "{found:?}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.pmtiles");
    std::fs::write(&path, corniche_testing::package::written()).unwrap();
    let on_disk = Arc::new(PackageSource::open(&path).unwrap());
    let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(|| ());
    let threads = LoaderThreads::new(&on_disk, NonZeroUsize::MIN, 8, &wake).unwrap();
    assert_eq!(found, shown(on_disk, Box::new(threads)));
}
