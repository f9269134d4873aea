//! Part of the steps *heights* and *top*: photos, tile by tile, to textures of finest tiles and rasters of all tiles, within a
//! subtree.

use corniche_geom::TileId;
use corniche_ground::{
    heights::upwards,
    photos::{rasters, textures},
};
use corniche_photo::PhotoReader;
use corniche_spec::artifacts::Kind;
use corniche_work::Stage;

use crate::{BuildError, context::Context};

/// Reads the photos beneath and at `scope` that are not there yet, and makes the rasters from there up to the scope's own.
pub(crate) fn make(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    let Some(photos) = context.opened.photo.files() else { return Ok(()) };
    context.make_missing(
        (Stage::Photos, Kind::PhotoRaster),
        context.data().in_order_within(scope),
        || Ok(PhotoReader::new(&photos.grid)),
        |reader, id| Ok(textures::make_finest(context.textures(), photos, reader, id)?),
    )?;
    make_rasters(context, scope)
}

/// Makes the rasters that are missing beneath and at `scope`, from those that are there up.
pub(crate) fn make_rasters(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    if context.opened.photo.files().is_none() {
        return Ok(());
    }
    let (store, data) = (context.store, context.data());
    Ok(upwards::make_missing(
        (store, &data),
        (context.observer, context.threads()),
        Kind::PhotoRaster,
        scope,
        |id| rasters::put_from_children(store, &data, id),
    )?)
}
