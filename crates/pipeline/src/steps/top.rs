//! Step *top*: the sums over all subtrees of heights, and the rasters and TINs of the tiles above
//! them. Finest tiles need the TINs of all their ancestors.

use std::collections::BTreeSet;

use corniche_geom::TileId;
use corniche_ground::heights::rasters;
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_tileset::{pmtiles_order, tile_of_order};
use corniche_work::Stage;

use super::photos;
use crate::{
    BuildError,
    context::BuildContext,
    tile::mesh::{Meshed, mesh_tile},
};

/// Checks the heights of all subtrees, which must be complete, and creates the coarse tiles above
/// them.
pub(crate) fn make(context: &BuildContext<'_>) -> Result<(), BuildError> {
    let mut step_m = 0.0;
    if let Some(pyramid) = context.pyramid() {
        // The check comes before any tile, because no tile has ground if no node has a height.
        let patches = pyramid.all_patches()?;
        pyramid.check(&patches)?;
        pyramid.warn_of_spikes(&patches);
        let sums = pyramid.sums(&patches);
        step_m = sums.step_m;
        if sums.samples.with_data == 0 {
            return Err(BuildError::NoHeights { dem: context.settings.terrain_files() });
        }
        pyramid.make_rasters(TileId::ROOT)?;
        make_tins(context, above_subtrees(context))?;
    }
    photos::make_rasters(context, TileId::ROOT)?;
    Ok(context.store.put(ArtifactKind::Top.item(0), &step_m.to_le_bytes())?)
}

/// Fails if the step is not complete.
pub(crate) fn check_done(context: &BuildContext<'_>) -> Result<(), BuildError> {
    if context.store.has(ArtifactKind::Top.item(0)) {
        return Ok(());
    }
    let what = "the coarse tiles above the subtrees".to_owned();
    Err(ArtifactError::Missing { what, step: "top" }.into())
}

/// The smallest height step that the DEM can represent, metres
/// ([`corniche_dem::Audit::height_step_m`]). Fails if the step *top* is not complete.
pub(crate) fn height_step_m(context: &BuildContext<'_>) -> Result<f64, BuildError> {
    check_done(context)?;
    let key = ArtifactKind::Top.item(0);
    let bytes = context.store.get(key)?.unwrap_or_default();
    let bytes = <[u8; 8]>::try_from(&bytes[..]).map_err(|_| damaged(key, &"it is not a height"))?;
    Ok(f64::from_le_bytes(bytes))
}

/// The tiles above all subtrees for which heights were read, in package order.
fn above_subtrees(context: &BuildContext<'_>) -> Vec<TileId> {
    let items = context.store.items(ArtifactKind::Subtree as u8);
    let made: BTreeSet<TileId> = items.into_iter().filter_map(tile_of_order).collect();
    let is_in_another = |id: TileId| (0..id.z()).any(|level| made.contains(&id.ancestor(level)));
    let subtrees = made.iter().filter(|&&id| !is_in_another(id));
    let mut above: Vec<TileId> =
        subtrees.flat_map(|id| (0..id.z()).map(|level| id.ancestor(level))).collect();
    above.sort_unstable_by_key(|&id| pmtiles_order(id));
    above.dedup();
    above
}

/// Triangulates those coarse tiles of the data whose TINs are missing.
pub(crate) fn make_tins(context: &BuildContext<'_>, ids: Vec<TileId>) -> Result<(), BuildError> {
    if ids.is_empty() {
        return Ok(());
    }
    let (store, data) = (context.store, context.data());
    context.make_missing(
        (Stage::CoarseTins, ArtifactKind::Tin),
        ids,
        || Ok(()),
        |(), id| {
            let meshed = match rasters::with_halo(store, &data, id, 1)? {
                Some(heights) => mesh_tile(&heights, id, context.levels)?,
                None => Meshed::default(),
            };
            Ok(meshed.put(store, id)?)
        },
    )
}
