//! The TINs of coarse tiles. Finest tiles need those of all their ancestors.

use corniche_geom::TileId;

use crate::{
    BuildError, Stage,
    artifacts::Kind,
    context::Context,
    heights::rasters,
    tile::mesh::{Meshed, mesh_tile},
    workers,
};

/// Triangulates the coarse tiles of some levels beneath and at `scope` that are not there yet.
pub(crate) fn make(
    context: &Context<'_>,
    scope: TileId,
    levels: std::ops::Range<u8>,
) -> Result<(), BuildError> {
    let store = context.store;
    let mut ids = Vec::new();
    let mut done = 0;
    for level in levels {
        for id in context.data().above(level).in_order_within(scope) {
            if store.has(Kind::Tin.of_tile(id)) {
                done += 1;
            } else if store.has(Kind::Raster.of_tile(id)) {
                ids.push(id);
            }
        }
    }
    context.observer.begin(Stage::CoarseTins, Some(ids.len() as u64 + done));
    context.observer.already(Stage::CoarseTins, done);
    workers::in_order_unless_cancelled(
        context.observer,
        context.threads(),
        ids.len(),
        || Ok(()),
        |(), index| {
            let id = ids[index];
            let meshed = match rasters::with_halo(store, id)? {
                Some(heights) => mesh_tile(&heights, id, context.levels)?,
                None => Meshed::default(),
            };
            meshed.put(store, id)
        },
        |_, ()| {
            context.observer.advance(Stage::CoarseTins, 1);
            Ok::<_, BuildError>(())
        },
    )?;
    context.observer.end(Stage::CoarseTins);
    Ok(())
}
