//! The grounds of coarse tiles, ready to be measured, shared by all threads.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError},
};

use corniche_geom::TileId;
use corniche_tin::{Placement, Surface, Tin, TriangleBuckets};

use super::mesh::Meshed;
use crate::{BuildError, context::Context};

/// Bytes that a triangle takes in buckets, and again in a surface.
const TRIANGLE_BYTES: u64 = 120;

/// A tile's ground.
pub(crate) struct Ground {
    pub(crate) buckets: TriangleBuckets,
    /// Only where samples are not nodes: samples are looked up by their place.
    pub(crate) surface: Option<Surface>,
    bytes: u64,
}

impl Ground {
    pub(crate) fn new(context: &Context<'_>, id: TileId, tin: &Tin) -> Self {
        let quantum_m = context.levels.quantum_m();
        let surface = (!context.grid.nodes_are_samples())
            .then(|| Surface::new(tin, Placement::of_tile(context.frame(), id, quantum_m)));
        let uses = 1 + u64::from(surface.is_some());
        Self {
            buckets: TriangleBuckets::new(tin, quantum_m),
            surface,
            bytes: tin.triangles().len() as u64 * TRIANGLE_BYTES * uses,
        }
    }
}

/// Grounds by tile: those used last, within a budget of memory.
///
/// Finest tiles are worked on in package order, along a Hilbert curve, so a coarse tile is needed for a while and then never
/// again.
pub(crate) struct Grounds<'a> {
    context: &'a Context<'a>,
    budget_bytes: u64,
    kept: Mutex<Kept>,
}

#[derive(Default)]
struct Kept {
    /// The grounds with the time of last use. `None` for a tile without ground.
    by_tile: BTreeMap<TileId, (u64, Option<Arc<Ground>>)>,
    bytes: u64,
    clock: u64,
}

impl<'a> Grounds<'a> {
    pub(crate) fn new(context: &'a Context<'a>) -> Self {
        let budget_bytes = context.memory().grounds;
        Self { context, budget_bytes, kept: Mutex::default() }
    }

    /// The ground of a coarse tile; `None` where it has none.
    pub(crate) fn of(&self, id: TileId) -> Result<Option<Arc<Ground>>, BuildError> {
        {
            let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.clock += 1;
            let now = kept.clock;
            if let Some((used, ground)) = kept.by_tile.get_mut(&id) {
                *used = now;
                return Ok(ground.clone());
            }
        }
        // Outside the lock: two threads may load the same ground, which is less than making all others wait.
        let meshed = Meshed::get(self.context.store, id)?;
        let ground = meshed.map(|meshed| Arc::new(Ground::new(self.context, id, &meshed.tin)));
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.insert(id, ground.clone(), self.budget_bytes);
        Ok(ground)
    }
}

/// What an entry takes even where there is no ground.
const ENTRY_BYTES: u64 = 64;

impl Kept {
    fn insert(&mut self, id: TileId, ground: Option<Arc<Ground>>, budget_bytes: u64) {
        let size = |ground: &Option<Arc<Ground>>| {
            ENTRY_BYTES + ground.as_ref().map_or(0, |ground| ground.bytes)
        };
        self.bytes += size(&ground);
        let now = self.clock;
        if let Some((_, before)) = self.by_tile.insert(id, (now, ground)) {
            self.bytes -= size(&before);
        }
        while self.bytes > budget_bytes && self.by_tile.len() > 1 {
            let oldest = self.by_tile.iter().filter(|&(&other, _)| other != id);
            let oldest = oldest.min_by_key(|(_, (used, _))| *used).map(|(&id, _)| id);
            let Some((_, gone)) = oldest.and_then(|oldest| self.by_tile.remove(&oldest)) else {
                return;
            };
            self.bytes -= size(&gone);
        }
    }
}
