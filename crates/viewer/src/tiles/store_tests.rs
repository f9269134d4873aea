//! The tiles of a picture are loaded once each, by several threads, and only those that it needs.

#![allow(clippy::unwrap_used, reason = "a test may unwrap")]

use std::{
    cell::Cell,
    sync::atomic::{AtomicUsize, Ordering},
};

use corniche_geom::{GridFrame, NodeIndex};
use corniche_tileset::TileTerrain;
use corniche_tin::{Tin, TinVertex};

use super::*;
use crate::tiles::{TileCatalog, TileLines};

const LEVELS: u8 = 2;

/// Flat ground in all tiles of three levels, without a road. It counts its requests, and some tiles
/// are damaged.
struct Counted {
    frame: GridFrame,
    may_have_roads: bool,
    damaged: Vec<TileId>,
    loaded: AtomicUsize,
    slopes: AtomicUsize,
}

impl Counted {
    fn new() -> Self {
        let frame = GridFrame::new([0.0; 2], 10.0, NodeIndex { i: 0, j: 256 << LEVELS }, LEVELS);
        Self {
            frame: frame.unwrap(),
            may_have_roads: true,
            damaged: Vec::new(),
            loaded: AtomicUsize::new(0),
            slopes: AtomicUsize::new(0),
        }
    }

    /// Returns how many tiles were loaded completely, and how many for their slopes.
    fn counts(&self) -> [usize; 2] {
        [&self.loaded, &self.slopes].map(|count| count.load(Ordering::SeqCst))
    }

    fn tile(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        if self.damaged.contains(&id) {
            return Err(LoadTileError { id, source: "damaged".into() });
        }
        let vertex = |row, column| TinVertex { row, column, height_q: 100 };
        let corners = vec![vertex(0, 0), vertex(0, 256), vertex(256, 0), vertex(256, 256)];
        let terrain = TileTerrain {
            tin: Tin::new(corners, &[[0, 2, 1], [1, 2, 3]]).unwrap(),
            normals: vec![[0, 0]; 4],
            geometric_error_m: 1.0,
            height_range_m: [100.0, 100.0],
            uncovered_nodes: 0,
        };
        Ok(TileGeometry::assemble(id, Some(&terrain), &TileLines::default(), &self.frame, 1.0))
    }
}

impl TileCatalog for Counted {
    fn frame(&self) -> &GridFrame {
        &self.frame
    }

    fn exists(&self, id: TileId) -> bool {
        id.z() <= LEVELS
    }
}

impl TileSource for Counted {
    fn load(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.loaded.fetch_add(1, Ordering::SeqCst);
        self.tile(id)
    }

    fn summary(&self, id: TileId) -> Result<Option<GroundSummary>, LoadTileError> {
        Ok(self.tile(id)?.summary)
    }

    fn load_slopes(&self, id: TileId) -> Result<TileGeometry, LoadTileError> {
        self.slopes.fetch_add(1, Ordering::SeqCst);
        self.tile(id)
    }

    fn may_have_roads(&self) -> bool {
        self.may_have_roads
    }
}

fn drawn(z: u8, x: u32, y: u32) -> DrawnTile {
    DrawnTile { id: TileId::new(z, x, y).unwrap(), skirt_depth_m: 0.0 }
}

/// All tiles of the finest level, row by row.
fn finest() -> Vec<DrawnTile> {
    (0..4).flat_map(|y| (0..4).map(move |x| drawn(LEVELS, x, y))).collect()
}

#[test]
fn without_roads_no_level_is_searched_for_them() {
    let data = Bounds { min_x: 0.0, min_y: 0.0, max_x: 9_000.0, max_y: 5_000.0 };
    for (may_have_roads, loaded) in [(true, 1 + 4 + 16), (false, 0)] {
        let source = Counted { may_have_roads, ..Counted::new() };
        let extent = TileStore::new(&source).map_extent(data).unwrap().unwrap();
        assert_eq!(extent, MapExtent::of_data(data, [100.0, 100.0]));
        assert_eq!(source.counts(), [loaded, 0]);
    }
}

#[test]
fn tiles_that_are_drawn_and_slopes_above_them_are_loaded_once() {
    let source = Counted::new();
    let mut store = TileStore::new(&source);
    let drawn = [&finest()[..4], &finest()[..8]];
    for drawn in drawn {
        store.load_drawn::<LoadTileError>(drawn, || Ok(())).unwrap();
    }
    assert_eq!(source.counts(), [8, 3], "the root and two of its children are above them");
    assert!(drawn[1].iter().all(|drawn| store.get(drawn.id).is_some()));
    assert!(store.get(TileId::ROOT).is_none() && store.with_slopes(TileId::ROOT).is_some());
}

/// Whichever thread is faster, the error belongs to the first damaged tile in drawing order.
#[test]
fn the_first_damaged_tile_is_told() {
    let damaged = [9, 6, 12].map(|place| finest()[place].id).to_vec();
    let source = Counted { damaged, ..Counted::new() };
    for _ in 0..50 {
        let mut store = TileStore::new(&source);
        let error = store.load_drawn::<LoadTileError>(&finest(), || Ok(())).unwrap_err();
        assert_eq!(error.id, finest()[6].id);
    }
}

#[test]
fn a_picture_that_is_stopped_loads_no_more() {
    #[derive(Debug)]
    struct Stopped;
    impl From<LoadTileError> for Stopped {
        fn from(_: LoadTileError) -> Self {
            Self
        }
    }
    let source = Counted::new();
    let stopped = TileStore::new(&source).load_drawn(&finest(), || Err(Stopped));
    assert!(stopped.is_err());
    assert_eq!(source.counts(), [0, 0]);
    // Loading is stopped after the second tile.
    let asked = Cell::new(0);
    let mut store = TileStore::new(&source);
    let stopped = store.load_drawn(&finest(), || {
        asked.set(asked.get() + 1);
        if asked.get() < 3 { Ok(()) } else { Err(Stopped) }
    });
    assert!(stopped.is_err());
    let loaded = finest().iter().filter(|drawn| store.get(drawn.id).is_some()).count();
    assert_eq!([asked.get(), loaded], [3, 2]);
}
