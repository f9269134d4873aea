//! The grounds of coarse tiles, ready to be measured, shared by all threads.

use std::sync::Arc;

use corniche_geom::TileId;
use corniche_tin::{Placement, Surface, Tin, TriangleBuckets};
use corniche_work::Recent;

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
    /// `None` for a tile without ground.
    recent: Recent<TileId, Option<Ground>>,
}

impl<'a> Grounds<'a> {
    pub(crate) fn new(context: &'a Context<'a>) -> Self {
        Self { context, recent: Recent::new(context.memory().grounds) }
    }

    /// What is known of a coarse tile: its ground, or that it has none.
    pub(crate) fn of(&self, id: TileId) -> Result<Arc<Option<Ground>>, BuildError> {
        let make = || {
            let meshed = Meshed::get(self.context.store, id)?;
            Ok(meshed.map(|meshed| Ground::new(self.context, id, &meshed.tin)))
        };
        self.recent.get(id, make, |ground| ground.as_ref().map_or(0, |ground| ground.bytes))
    }
}
