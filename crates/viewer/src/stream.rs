//! Which tiles to load, to hand to the graphics card and to forget while the camera moves.
//!
//! ```text
//!            load                arrived               upload
//!  listed ─────────► loading ─────────────► waiting ─────────────► resident ──► drawn
//!    ▲                                         │ cancel                │ evict
//!    └─────────────────────────────────────────┴───────────────────────┘
//! ```
//!
//! [`Streamer`] decides and remembers. It holds no tile, opens no file and knows no graphics card, so that it can be tested
//! without them; of a package it asks only which tiles there are. The caller does what a [`Plan`] says, in the order of its
//! fields, and reports the tiles that were decoded. Time is counted in frames: the same camera and the same arrivals give
//! the same plans.
//!
//! A tile is drawn only when it is resident, and a parent is drawn until all its children that exist are resident
//! ([`lod::select`]). Tiles that are drawn are never evicted. Nor are the tiles above them, which may have to take their
//! place, nor the siblings of any of these: children are drawn only together, so if one were evicted it would be loaded
//! again in the next frame, and with a budget that is too small this would never end.
//!
//! No tile is resident without its parent: tiles are shaded by the slopes of those above them, too.
//!
//! Source: Cozzi & Ring, *3D Engine Design for Virtual Globes* (2011), ch. 12: the least recently used tiles are evicted
//! first, and the requests of the present view come before those of the coming one.

use std::collections::{BTreeMap, BTreeSet};

use corniche_geom::{Bounds, TileId};

use crate::{
    camera::Camera,
    lod::{self, Drawn, GroundSummary, Node, Quality, Request, Selection, TileTree},
    tiles::TileCatalog,
};

/// How much may be done in a frame, and how much may be kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StreamBudget {
    /// At most this many tiles are decoded at once.
    pub tiles_in_flight: usize,
    /// At most this much is uploaded to the graphics card in a frame, but always at least one tile.
    pub upload_bytes_per_frame: u64,
    /// At most this much is kept on the graphics card.
    pub gpu_bytes: u64,
}

/// What the streamer knows of a decoded tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileFacts {
    /// Errors and heights; `None` without ground.
    pub ground: Option<GroundSummary>,
    /// What it takes on the graphics card.
    pub gpu_bytes: u64,
}

/// What to do in this frame, in this order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plan {
    /// Tiles to remove from the graphics card.
    pub evict: Vec<TileId>,
    /// Tiles to upload to the graphics card; all of them have arrived.
    pub upload: Vec<TileId>,
    /// Tiles to draw.
    pub drawn: Vec<Drawn>,
    /// Decoded tiles to drop, because they are no longer wanted.
    pub cancel: Vec<TileId>,
    /// Tiles to load, most urgent first.
    pub load: Vec<TileId>,
    /// Tiles that are being loaded and are not wanted any more. Who can stop that tells [`Streamer::abandoned`]; else they arrive.
    pub unwanted: Vec<TileId>,
    /// How many tiles this view needs next that are not resident yet; the tiles beneath them are not counted.
    pub missing: usize,
}

/// Decides what is loaded, resident and drawn.
#[derive(Debug, Clone)]
pub struct Streamer {
    budget: StreamBudget,
    frame: u64,
    loading: BTreeSet<TileId>,
    waiting: BTreeMap<TileId, TileFacts>,
    resident: BTreeMap<TileId, Resident>,
    /// How many bytes of tiles are on the graphics card.
    pub resident_bytes: u64,
}

#[derive(Debug, Clone, Copy)]
struct Resident {
    facts: TileFacts,
    last_used_frame: u64,
}

impl Streamer {
    /// Nothing loaded yet.
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

    /// A tile of an earlier [`Plan::load`] is decoded.
    pub fn arrived(&mut self, id: TileId, facts: TileFacts) {
        if self.loading.remove(&id) {
            self.waiting.insert(id, facts);
        }
    }

    /// A tile of [`Plan::unwanted`] is not loaded any more and will not arrive.
    pub fn abandoned(&mut self, id: TileId) {
        self.loading.remove(&id);
    }

    /// Plans the next frame, seen from `camera`. `ahead` is where the camera will be soon: tiles for it are loaded in
    /// advance.
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

        // Tiles of the coming view may be evicted to make room for the present view, but not for more of the coming one.
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
        lod::select(&ResidentTree { catalog, resident: &self.resident }, camera, quality)
    }

    /// The resident tiles without which a selection would change: the tiles drawn, the tiles above them, and all children
    /// of these, in view or not, because a parent is drawn in place of its children when one of them is not resident.
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

    /// Tiles above one that is used are used, so that they are not evicted before it.
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
            // A tile of the coming view, whose parent had to make room for the present one.
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

    /// Evicts the least recently used tiles until `wanted_bytes` more fit; evicts nothing where that is impossible.
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
        // Of tiles that were used last in the same frame, the finest is evicted first: a coarse one can replace more.
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
        // Tiles that wait because there is no room for them must not become more and more.
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

/// The package's tiles, of which those on the graphics card count as loaded.
struct ResidentTree<'a> {
    catalog: &'a dyn TileCatalog,
    resident: &'a BTreeMap<TileId, Resident>,
}

impl TileTree for ResidentTree<'_> {
    fn node(&self, id: TileId) -> Node {
        match self.resident.get(&id) {
            Some(tile) => Node::Loaded(tile.facts.ground),
            None if self.catalog.exists(id) => Node::Listed,
            None => Node::Absent,
        }
    }

    fn plan_bounds(&self, id: TileId) -> Bounds {
        self.catalog.frame().tile_bounds(id)
    }

    fn max_level(&self) -> u8 {
        self.catalog.frame().max_level()
    }
}

#[cfg(test)]
#[path = "stream_tests.rs"]
mod tests;
