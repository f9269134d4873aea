//! Step *heights*: reads the DEM within a subtree, patch by patch, into the heights of finest tiles
//! and the rasters above them.

use corniche_geom::TileId;
use corniche_spec::artifacts::ArtifactKind;

use super::photos;
use crate::{BuildError, context::BuildContext};

/// Reads the missing heights and photos beneath and at `scope`. If the terrain comes from a
/// package, there are only photos.
pub(crate) fn make(context: &BuildContext<'_>, scope: TileId) -> Result<(), BuildError> {
    if let Some(pyramid) = context.pyramid() {
        pyramid.make(scope)?;
    }
    photos::make(context, scope)?;
    Ok(context.store.put(ArtifactKind::Subtree.of_tile(scope), &[])?)
}
