//! The tiles of a map: the streamer selects them, and a [`TileLoader`] loads them. Their ground is
//! kept for rays and heights.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use corniche_geom::TileId;
use corniche_viewer::{
    camera::Camera,
    gpu::tile_bytes,
    lod::{DrawnTile, Quality},
    pick,
    stream::{Plan, StreamBudget, Streamer, TileFacts},
    tiles::{LoadTileError, TileCatalog, TileGeometry},
};
use glam::DVec3;

use crate::controls::KnownGround;

/// The answer to a request for a tile.
pub struct Loaded {
    /// The requested tile.
    pub id: TileId,
    /// The decoded tile, or the reason why there is none.
    pub tile: Result<TileGeometry, LoadTileError>,
}

/// Loads tiles while drawing continues. Nothing here waits: tiles are requested in one frame and
/// taken in a later one.
pub trait TileLoader {
    /// Requests tiles, in order, after those requested before.
    fn request(&mut self, ids: &[TileId]);
    /// Drops the requests that have not been started.
    fn forget(&mut self);
    /// Cancels the loading of tiles that are no longer needed, as far as possible. Returns those
    /// that will not arrive.
    fn abandon(&mut self, ids: &[TileId]) -> Vec<TileId> {
        let _ = ids;
        Vec::new()
    }
    /// The tiles that have arrived since the last call.
    fn arrivals(&mut self) -> Vec<Loaded>;
}

/// All tiles, from the request to the drawing.
pub struct Tiles {
    catalog: Arc<dyn TileCatalog>,
    loader: Box<dyn TileLoader>,
    budget: StreamBudget,
    streamer: Streamer,
    /// Decoded tiles that are not on the GPU yet.
    waiting: BTreeMap<TileId, TileGeometry>,
    /// The ground of the tiles on the GPU.
    resident: BTreeMap<TileId, TileGeometry>,
    /// Tiles that are drawn.
    pub drawn: Vec<DrawnTile>,
    /// The number of tiles that the view needs and that are not on the GPU yet.
    pub missing: usize,
    loading: BTreeSet<TileId>,
    /// Whether the view needs more tiles than fit into the graphics memory, so that it is drawn
    /// more coarsely than requested.
    pub is_full: bool,
    /// Whether [`Tiles::take_first_time_full`] has returned true.
    was_full: bool,
}

/// The work of a frame on the GPU, in this order.
#[derive(Default)]
pub struct Changes {
    /// Tiles to remove.
    pub evict: Vec<TileId>,
    /// Tiles to upload, and then to pass to [`Tiles::keep_ground`].
    pub upload: Vec<TileGeometry>,
    /// Whether tiles were requested, uploaded or removed, so that the next frame may have more to
    /// do.
    pub is_under_way: bool,
}

impl Tiles {
    /// Creates an empty set of tiles.
    pub fn new(
        catalog: Arc<dyn TileCatalog>,
        loader: Box<dyn TileLoader>,
        budget: StreamBudget,
    ) -> Self {
        Self {
            catalog,
            loader,
            budget,
            streamer: Streamer::new(budget),
            waiting: BTreeMap::new(),
            resident: BTreeMap::new(),
            drawn: Vec::new(),
            missing: 0,
            loading: BTreeSet::new(),
            is_full: false,
            was_full: false,
        }
    }

    /// Takes the tiles that have arrived. Returns messages about tiles that cannot be loaded.
    ///
    /// A tile that cannot be loaded is treated as a tile without ground: finer tiles beneath it are
    /// shown if there are any, and a hole otherwise.
    pub fn take_arrivals(&mut self) -> Vec<String> {
        let mut defects = Vec::new();
        for loaded in self.loader.arrivals() {
            if !self.loading.remove(&loaded.id) {
                // The tile was requested before the device was lost, and again afterwards; this is
                // the second answer.
                continue;
            }
            let tile = loaded.tile.unwrap_or_else(|error| {
                let cause = std::error::Error::source(&error).map(ToString::to_string);
                defects.push(format!("{error}: {}", cause.unwrap_or_default()));
                TileGeometry::empty(loaded.id, self.catalog.frame())
            });
            let facts = TileFacts { ground: tile.summary, gpu_bytes: tile_bytes(&tile) };
            self.streamer.arrived(loaded.id, facts);
            self.waiting.insert(loaded.id, tile);
        }
        defects
    }

    /// Selects the tiles to draw, keep and load.
    pub fn choose(&mut self, camera: &Camera, ahead: Option<&Camera>, quality: Quality) -> Changes {
        let plan = self.streamer.plan(self.catalog.as_ref(), camera, ahead, quality);
        let Plan { evict, upload, drawn, cancel, load, missing, unwanted } = plan;
        for id in &evict {
            self.resident.remove(id);
        }
        let mut uploaded = Vec::with_capacity(upload.len());
        for id in upload {
            uploaded.extend(self.waiting.remove(&id));
        }
        for id in &cancel {
            self.waiting.remove(id);
        }
        for id in self.loader.abandon(&unwanted) {
            self.streamer.abandoned(id);
            self.loading.remove(&id);
        }
        self.loader.request(&load);
        self.loading.extend(&load);
        self.drawn = drawn;
        self.missing = missing;
        let is_under_way = !(evict.is_empty() && uploaded.is_empty() && load.is_empty());
        // Tiles wait for memory that no other tile frees, and nothing is being loaded.
        self.is_full = missing > 0 && !is_under_way && self.loading.is_empty();
        Changes { evict, upload: uploaded, is_under_way }
    }

    /// Keeps the ground of uploaded tiles, for rays and heights. Their roads, which are most of a
    /// tile in a town, are dropped: only the GPU needs them.
    pub fn keep_ground(&mut self, uploaded: Vec<TileGeometry>) {
        for tile in uploaded {
            self.resident.insert(tile.id, tile.without_roads());
        }
    }

    /// The ground of the tiles on the GPU.
    pub fn resident(&self) -> impl Iterator<Item = &TileGeometry> {
        self.resident.values()
    }

    /// Handles the loss of everything on the GPU: all tiles are requested again.
    pub fn begin_again(&mut self) {
        self.loader.forget();
        self.loading.clear();
        self.streamer = Streamer::new(self.budget);
        self.waiting.clear();
        self.resident.clear();
        self.drawn.clear();
        self.is_full = false;
    }

    /// The number of tiles being loaded.
    #[must_use]
    pub fn loading(&self) -> usize {
        self.loading.len()
    }

    /// Returns true once: when [`Tiles::is_full`] first becomes true.
    pub fn take_first_time_full(&mut self) -> bool {
        self.is_full && !std::mem::replace(&mut self.was_full, true)
    }

    /// The bytes used on the GPU, and the limit.
    #[must_use]
    pub fn bytes_of_budget(&self) -> [u64; 2] {
        [self.streamer.resident_bytes, self.budget.gpu_bytes]
    }

    /// The drawn ground; outside the view, the other ground on the GPU.
    ///
    /// `height_range_m` are the true heights between which all ground lies.
    #[must_use]
    pub fn ground(&self, vertical_scale: f64, height_range_m: [f64; 2]) -> ShownGround<'_> {
        ShownGround { tiles: self, vertical_scale, height_range_m }
    }
}

/// The ground as the camera's controls see it, in world heights: true heights times
/// `vertical_scale`.
pub struct ShownGround<'a> {
    tiles: &'a Tiles,
    vertical_scale: f64,
    height_range_m: [f64; 2],
}

impl KnownGround for ShownGround<'_> {
    fn hit(&self, eye_in_world: DVec3, ray_in_world: DVec3) -> Option<DVec3> {
        let drawn = self.tiles.drawn.iter().filter_map(|drawn| self.tiles.resident.get(&drawn.id));
        pick::ground_at(drawn, self.vertical_scale, eye_in_world, ray_in_world)
            .map(|hit| hit.at_in_world)
    }

    fn height(&self, at: [f64; 2]) -> Option<f64> {
        let mut found = None;
        let mut next = self.tiles.resident.get(&TileId::ROOT);
        while let Some(tile) = next {
            found = tile.ground_height_m(at).or(found);
            // On a border the place is in two children, at the same height.
            next = tile
                .id
                .children()
                .filter_map(|child| self.tiles.resident.get(&child))
                .find(|child| holds(child, at));
        }
        found.map(|height_m| height_m * self.vertical_scale)
    }

    fn base_height(&self) -> f64 {
        let [lowest_m, highest_m] = self.height_range_m;
        f64::midpoint(lowest_m, highest_m) * self.vertical_scale
    }

    fn heights(&self) -> [f64; 2] {
        self.height_range_m.map(|height_m| height_m * self.vertical_scale)
    }
}

fn holds(tile: &TileGeometry, at: [f64; 2]) -> bool {
    (0..2).all(|axis| (at[axis] - tile.reference_m[axis]).abs() <= tile.size_m[axis] / 2.0)
}

#[cfg(test)]
#[path = "tiles_tests.rs"]
mod tests;
