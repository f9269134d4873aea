//! Step *heights*: the DEM, area by area, to the heights of finest tiles and the rasters above them, within a subtree.

use corniche_geom::TileId;

use crate::{BuildError, artifacts::Kind, context::Context};

/// Reads the heights beneath and at `scope` that are not there yet.
pub(crate) fn make(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    context.pyramid().make(scope)?;
    Ok(context.store.put(Kind::Subtree.of_tile(scope), &[])?)
}
