//! The TINs of coarse tiles. Finest tiles need those of all their ancestors.

use corniche_geom::TileId;
use corniche_ground::heights::rasters;
use corniche_spec::artifacts::Kind;
use corniche_work::{Stage, workers};

use crate::{
    BuildError,
    context::Context,
    tile::mesh::{Meshed, mesh_tile},
};

/// Triangulates those of some coarse tiles of the data that are not there yet.
pub(crate) fn make(context: &Context<'_>, mut ids: Vec<TileId>) -> Result<(), BuildError> {
    if ids.is_empty() {
        return Ok(());
    }
    let (store, data) = (context.store, context.data());
    let all = ids.len();
    ids.retain(|&id| !store.has(Kind::Tin.of_tile(id)));
    workers::make_missing(
        context.observer,
        Stage::CoarseTins,
        context.threads(),
        (&ids, all),
        || Ok(()),
        |(), &id| -> Result<(), BuildError> {
            let meshed = match rasters::with_halo(store, &data, id, 1)? {
                Some(heights) => mesh_tile(&heights, id, context.levels)?,
                None => Meshed::default(),
            };
            Ok(meshed.put(store, id)?)
        },
    )
}
