//! Step *heights*: the DEM, patch by patch, to the heights of finest tiles and the rasters above them, within a subtree.

use corniche_geom::TileId;
use corniche_spec::artifacts::Kind;

use super::photos;
use crate::{BuildError, context::Context};

/// Reads the heights and photos beneath and at `scope` that are not there yet. Where the terrain comes from a package, there are only photos.
pub(crate) fn make(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    if let Some(pyramid) = context.pyramid() {
        pyramid.make(scope)?;
    }
    photos::make(context, scope)?;
    Ok(context.store.put(Kind::Subtree.of_tile(scope), &[])?)
}
