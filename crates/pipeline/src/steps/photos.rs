//! Part of the steps *heights* and *top*: reads photos within a subtree, tile by tile, into
//! textures of finest tiles and rasters of all tiles.

use corniche_geom::TileId;
use corniche_ground::{
    heights::upwards,
    photos::{rasters, textures},
};
use corniche_photo::PhotoReader;
use corniche_spec::artifacts::ArtifactKind;
use corniche_work::Stage;

use crate::{BuildError, context::BuildContext};

/// Reads the missing photos beneath and at `scope`, and creates the rasters from there up to the
/// scope's own.
pub(crate) fn make(context: &BuildContext<'_>, scope: TileId) -> Result<(), BuildError> {
    let Some(photos) = context.opened.photo.files() else { return Ok(()) };
    context.make_missing(
        (Stage::Photos, ArtifactKind::PhotoRaster),
        context.data().in_order_within(scope),
        || Ok(PhotoReader::new(&photos.grid)),
        |reader, id| Ok(textures::make_finest(context.textures(), photos, reader, id)?),
    )?;
    make_rasters(context, scope)
}

/// Creates the missing rasters beneath and at `scope`, from those in the store upwards.
pub(crate) fn make_rasters(context: &BuildContext<'_>, scope: TileId) -> Result<(), BuildError> {
    if context.opened.photo.files().is_none() {
        return Ok(());
    }
    let (store, data) = (context.store, context.data());
    Ok(upwards::make_missing(
        (store, &data),
        (context.observer, context.threads()),
        ArtifactKind::PhotoRaster,
        scope,
        |id| rasters::put_from_children(store, &data, id),
    )?)
}
