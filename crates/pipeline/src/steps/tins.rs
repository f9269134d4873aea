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

/// Triangulates those of some coarse tiles of the data that are not there yet.
pub(crate) fn make(context: &Context<'_>, mut ids: Vec<TileId>) -> Result<(), BuildError> {
    if ids.is_empty() {
        return Ok(());
    }
    let (store, data) = (context.store, context.data());
    let all = ids.len() as u64;
    ids.retain(|&id| !store.has(Kind::Tin.of_tile(id)));
    context.observer.begin(Stage::CoarseTins, Some(all));
    context.observer.already(Stage::CoarseTins, all - ids.len() as u64);
    workers::in_order_unless_cancelled(
        context.observer,
        context.threads(),
        ids.len(),
        || Ok(()),
        |(), index| {
            let id = ids[index];
            let meshed = match rasters::with_halo(store, &data, id)? {
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
