//! Which tiles to load, to upload to the GPU and to evict while the camera moves.
//!
//! ```text
//!            load                arrived               upload
//!  listed ─────────► loading ─────────────► waiting ─────────────► resident ──► drawn
//!    ▲                                         │ cancel                │ evict
//!    └─────────────────────────────────────────┴───────────────────────┘
//! ```
//!
//! [`Streamer`] decides and remembers. It holds no tile, opens no file and does not access the GPU,
//! so that it can be tested without them; its only question to a package is which tiles exist. The
//! caller executes a [`Plan`] in the order of its fields, and reports the decoded tiles. Time is
//! counted in frames: the same camera and the same arrivals give the same plans.
//!
//! A tile is drawn only when it is resident, and a parent is drawn until all its existing children
//! are resident ([`lod::select`]). Drawn tiles are never evicted. Nor are their ancestors, which
//! may have to replace them, nor the siblings of any of these: children are drawn only together, so
//! an evicted one would be loaded again in the next frame, and with a budget that is too small this
//! would never end.
//!
//! No tile is resident without its parent: tiles are also shaded by the slopes of their ancestors.
//!
//! Source: Cozzi & Ring, *3D Engine Design for Virtual Globes* (2011), ch. 12: the least recently
//! used tiles are evicted first, and the requests of the present view come before those of the
//! coming one.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::TileId;

use crate::{
    camera::Camera,
    lod::{self, DrawnTile, GroundSummary, Quality, Request, Selection},
    tiles::{CatalogTree, TileCatalog},
};

/// Limits per frame, and for the tiles that are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StreamBudget {
    /// At most this many tiles are decoded at once.
    pub tiles_in_flight: usize,
    /// At most this many bytes are uploaded to the GPU per frame, but always at least one tile.
    pub upload_bytes_per_frame: u64,
    /// At most this many bytes are kept on the GPU.
    pub gpu_bytes: u64,
}

/// The streamer's data about a decoded tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileFacts {
    /// Errors and heights; `None` without ground.
    pub ground: Option<GroundSummary>,
    /// Bytes of the tile on the GPU.
    pub gpu_bytes: u64,
}

/// The actions of a frame, in this order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plan {
    /// Tiles to evict from the GPU.
    pub evict: Vec<TileId>,
    /// Tiles to upload to the GPU; all of them have arrived.
    pub upload: Vec<TileId>,
    /// Tiles to draw.
    pub drawn: Vec<DrawnTile>,
    /// Decoded tiles to drop, because they are no longer wanted.
    pub cancel: Vec<TileId>,
    /// Tiles to load, most urgent first.
    pub load: Vec<TileId>,
    /// Tiles that are being loaded and are no longer wanted. A caller that cancels a load reports
    /// it to [`Streamer::abandoned`]; otherwise the tile arrives.
    pub unwanted: Vec<TileId>,
    /// Number of tiles that this view needs next and that are not resident yet; their descendants
    /// are not counted.
    pub missing: usize,
}

/// Decides which tiles are loaded, resident and drawn.
#[derive(Debug, Clone)]
pub struct Streamer {
    budget: StreamBudget,
    frame: u64,
    loading: BTreeSet<TileId>,
    waiting: BTreeMap<TileId, TileFacts>,
    resident: BTreeMap<TileId, Resident>,
    /// Bytes of the tiles on the GPU.
    pub resident_bytes: u64,
}

#[derive(Debug, Clone, Copy)]
struct Resident {
    facts: TileFacts,
    last_used_frame: u64,
}

impl Streamer {
    /// A streamer without loaded tiles.
    #[must_use]
    pub fn new(budget: StreamBudget) -> Self {
        Self {
            budget,
            frame: 0,
            loading: BTreeSet::new(),
            waiting: BTreeMap::new(),
            resident: BTreeMap::new(),
            resident_bytes: 0,
        }
    }

    /// Reports that a tile of an earlier [`Plan::load`] is decoded.
    pub fn arrived(&mut self, id: TileId, facts: TileFacts) {
        if self.loading.remove(&id) {
            self.waiting.insert(id, facts);
        }
    }

    /// Reports that a tile of [`Plan::unwanted`] is no longer being loaded and will not arrive.
    pub fn abandoned(&mut self, id: TileId) {
        self.loading.remove(&id);
    }

    /// Plans the next frame, seen from `camera`. `ahead` is the camera's position in the near
    /// future: tiles for it are loaded in advance.
    pub fn plan(
        &mut self,
        catalog: &dyn TileCatalog,
        camera: &Camera,
        ahead: Option<&Camera>,
        quality: Quality,
    ) -> Plan {
        self.frame += 1;
        let mut plan = Plan::default();
        let before = self.select(catalog, camera, quality);
        self.touch(&before);
        let coming = ahead.map(|ahead| self.select(catalog, ahead, quality)).unwrap_or_default();

        // Tiles of the coming view may be evicted to make space for the present view, but not for
        // other tiles of the coming view.
        let mut left_bytes = self.budget.upload_bytes_per_frame;
        self.upload(&before.requests, &BTreeSet::new(), &mut left_bytes, &mut plan);
        let kept = self.in_use(&coming);
        self.upload(&coming.requests, &kept, &mut left_bytes, &mut plan);

        let shown = if plan.upload.is_empty() {
            before
        } else {
            let shown = self.select(catalog, camera, quality);
            self.touch(&shown);
            shown
        };
        self.load(&shown.requests, &coming.requests, &mut plan);
        plan.missing = shown.requests.len();
        plan.drawn = shown.drawn;
        plan
    }

    fn select(&self, catalog: &dyn TileCatalog, camera: &Camera, quality: Quality) -> Selection {
        let ground_of = |id: TileId| self.resident.get(&id).map(|tile| tile.facts.ground);
        lod::select(&CatalogTree { catalog, ground_of }, camera, quality)
    }

    /// The resident tiles that the selection depends on: the drawn tiles, their ancestors, and all
    /// children of these ancestors, in view or not, because a parent is drawn in place of its
    /// children when one of them is not resident.
    fn in_use(&self, selection: &Selection) -> BTreeSet<TileId> {
        let mut refined = BTreeSet::new();
        let drawn = selection.drawn.iter().map(|drawn| drawn.id);
        let wanted = selection.requests.iter().map(|request| request.id);
        for id in drawn.clone().chain(wanted) {
            let mut next = id.parent();
            while let Some(id) = next.filter(|id| refined.insert(*id)) {
                next = id.parent();
            }
        }
        let children: Vec<TileId> = refined.iter().flat_map(|id| id.children()).collect();
        let mut used = refined;
        used.extend(drawn.chain(children));
        used.retain(|id| self.resident.contains_key(id));
        used
    }

    fn touch(&mut self, selection: &Selection) {
        for id in self.in_use(selection) {
            if let Some(tile) = self.resident.get_mut(&id) {
                tile.last_used_frame = self.frame;
            }
        }
    }

    /// Marks the ancestors of a used tile as used, so that they are not evicted before it.
    fn touch_above(&mut self, id: TileId) {
        let mut next = id.parent();
        while let Some(id) = next {
            if let Some(tile) = self.resident.get_mut(&id) {
                tile.last_used_frame = self.frame;
            }
            next = id.parent();
        }
    }

    fn upload(
        &mut self,
        requests: &[Request],
        kept: &BTreeSet<TileId>,
        left_bytes: &mut u64,
        plan: &mut Plan,
    ) {
        for Request { id, .. } in requests {
            let Some(&facts) = self.waiting.get(id) else { continue };
            // A tile of the coming view, whose parent was evicted for the present view.
            if id.parent().is_some_and(|parent| !self.resident.contains_key(&parent)) {
                continue;
            }
            let fits = facts.gpu_bytes <= *left_bytes || plan.upload.is_empty();
            if !fits || !self.make_room(facts.gpu_bytes, kept, plan) {
                return;
            }
            *left_bytes = left_bytes.saturating_sub(facts.gpu_bytes);
            self.waiting.remove(id);
            self.resident_bytes += facts.gpu_bytes;
            self.resident.insert(*id, Resident { facts, last_used_frame: self.frame });
            self.touch_above(*id);
            plan.upload.push(*id);
        }
    }

    /// Evicts the least recently used tiles until `wanted_bytes` more fit; evicts nothing if that
    /// is impossible.
    fn make_room(&mut self, wanted_bytes: u64, kept: &BTreeSet<TileId>, plan: &mut Plan) -> bool {
        let excess_bytes =
            (self.resident_bytes + wanted_bytes).saturating_sub(self.budget.gpu_bytes);
        if excess_bytes == 0 {
            return true;
        }
        let mut idle: Vec<(u64, TileId)> = self
            .resident
            .iter()
            .filter(|(id, tile)| tile.last_used_frame < self.frame && !kept.contains(id))
            .map(|(id, tile)| (tile.last_used_frame, *id))
            .collect();
        // Among tiles last used in the same frame, the finest is evicted first: a coarse tile can
        // replace more.
        idle.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.cmp(&a.1)));
        let mut freed_bytes = 0;
        let enough = idle.iter().position(|(_, id)| {
            freed_bytes += self.resident[id].facts.gpu_bytes;
            freed_bytes >= excess_bytes
        });
        let Some(last) = enough else { return false };
        for (_, id) in &idle[..=last] {
            if let Some(tile) = self.resident.remove(id) {
                self.resident_bytes -= tile.facts.gpu_bytes;
                plan.evict.push(*id);
            }
        }
        true
    }

    fn load(&mut self, now: &[Request], coming: &[Request], plan: &mut Plan) {
        let wanted: BTreeSet<TileId> = now.iter().chain(coming).map(|request| request.id).collect();
        plan.cancel = self.waiting.keys().filter(|id| !wanted.contains(id)).copied().collect();
        for id in &plan.cancel {
            self.waiting.remove(id);
        }
        plan.unwanted = self.loading.difference(&wanted).copied().collect();
        // The number of tiles that wait for space must not grow without limit.
        let room = self.budget.tiles_in_flight.saturating_sub(self.waiting.len());
        let coming = coming.iter().take(room);
        for Request { id, .. } in now.iter().chain(coming) {
            let is_new = !self.resident.contains_key(id) && !self.waiting.contains_key(id);
            if is_new
                && self.loading.len() < self.budget.tiles_in_flight
                && self.loading.insert(*id)
            {
                plan.load.push(*id);
            }
        }
    }
}

#[cfg(test)]
#[path = "stream_tests.rs"]
mod tests;
