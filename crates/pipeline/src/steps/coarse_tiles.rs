//! The tiles above the finest level: their deviations are computed from the records of all finest
//! tiles beneath them.

use std::collections::BTreeMap;

use corniche_geom::TileId;
use corniche_ground::heights::{pyramid::all_there, rasters};
use corniche_spec::artifacts::{ArtifactError, ArtifactKind, damaged};
use corniche_work::Stage;

use super::top;
use crate::{
    BuildError,
    context::BuildContext,
    tile::{
        encode,
        mesh::Meshed,
        record::{TileDeviation, TileRecord, TinStatistics},
        relief,
    },
};

/// Creates the missing coarse tiles beneath and at `scope`. All finest tiles beneath must be
/// complete.
pub(crate) fn make(context: &BuildContext<'_>, scope: TileId) -> Result<(), BuildError> {
    let (store, data) = (context.store, context.data());
    let deviations = deviations(context, scope)?;
    let mut ids: Vec<TileId> = deviations.keys().copied().collect();
    ids.sort_unstable_by_key(|&id| corniche_tileset::pmtiles_order(id));
    let lacks = |kind: ArtifactKind, id: TileId| !store.has(kind.of_tile(id));
    let lacks_both = |&id: &TileId| lacks(ArtifactKind::Record, id) && lacks(ArtifactKind::Tin, id);
    // The TINs exist, unless the part that created them for the tiles beneath is not among the
    // stores.
    top::make_tins(context, ids.iter().copied().filter(lacks_both).collect())?;
    let step_m = top::height_step_m(context)?;
    context.make_missing(
        (Stage::CoarseTiles, ArtifactKind::Record),
        ids,
        || Ok(()),
        |(), id| {
            // According to the records of finest tiles it has ground.
            let empty = || damaged(ArtifactKind::Tin.of_tile(id), &"it has no ground");
            let meshed = Meshed::get(store, id)?.ok_or_else(empty)?;
            let deviation = deviations.get(&id).copied().unwrap_or_default();
            let heights = |halo| rasters::with_halo(store, &data, id, halo);
            // A tile without relief needs the heights only if it has roads.
            let (read, relief) = if context.has_relief(id) {
                let heights = heights(2)?.ok_or_else(empty)?;
                let relief = relief::of_tile(context, id, &heights, step_m)?;
                (Some(heights.inner(1)), relief)
            } else {
                (None, None)
            };
            let owned = || {
                let heights = if read.is_some() { read } else { heights(1)? };
                encode::owned_by_heights(context, id, heights.as_ref())
            };
            let tile = (meshed, relief);
            Ok(encode::with_ground(context, id, tile, deviation, None, owned)?.put(store, id)?)
        },
    )
}

/// Collects the deviations of the coarse tiles with ground beneath and at `scope` from the records
/// of finest tiles.
fn deviations(
    context: &BuildContext<'_>,
    scope: TileId,
) -> Result<BTreeMap<TileId, TileDeviation>, BuildError> {
    let store = context.store;
    let data = context.data();
    let is_missing = |id: TileId| {
        id.ancestor(scope.z()) == scope && !store.has(ArtifactKind::Record.of_tile(id))
    };
    all_there("the tiles", &data.missing(is_missing), "tiles")?;
    let mut coarse: BTreeMap<TileId, TinStatistics> = BTreeMap::new();
    // For each finest tile with ground, its own deviation.
    let mut finest_m: BTreeMap<TileId, f64> = BTreeMap::new();
    for id in data.in_order_within(scope) {
        let record = TileRecord::get(store, id)?
            .ok_or_else(|| ArtifactError::Missing { what: format!("tile {id}"), step: "tiles" })?;
        if let Some(ground) = record.ground {
            finest_m.insert(id, ground.deviation.geometric_error_m);
        }
        for (level, share) in (0..id.z()).zip(&record.levels) {
            if level >= scope.z() && share.has_ground {
                coarse.entry(id.ancestor(level)).or_default().merge(share.seen);
            }
        }
    }
    Ok(stored(&coarse, &finest_m))
}

/// Computes the geometric errors, from the finest level up: the maximum of the tile's own deviation
/// and those of all tiles beneath it.
///
/// A tile may lack ground although its children have some (an island too small for a cell of its
/// level). The tiles beneath it then count for the nearest tile above that exists.
fn stored(
    coarse: &BTreeMap<TileId, TinStatistics>,
    finest_m: &BTreeMap<TileId, f64>,
) -> BTreeMap<TileId, TileDeviation> {
    let own_m = |id: &TileId| {
        coarse.get(id).map(|seen| seen.max_abs_m).or_else(|| finest_m.get(id).copied())
    };
    let mut beneath_m: BTreeMap<TileId, f64> = BTreeMap::new();
    let pass_up = |id: TileId, error_m: f64, beneath_m: &mut BTreeMap<TileId, f64>| {
        let mut above = (0..id.z()).rev().map(|level| id.ancestor(level));
        if let Some(above) = above.find(|above| coarse.contains_key(above)) {
            let largest_m = beneath_m.entry(above).or_default();
            *largest_m = largest_m.max(error_m);
        }
    };
    for (&id, &error_m) in finest_m {
        pass_up(id, error_m, &mut beneath_m);
    }
    let mut by_tile = BTreeMap::new();
    // Ids sort by level first, so in reverse order children come before their parents.
    for (&id, &seen) in coarse.iter().rev() {
        let children_m = id.children().filter_map(|child| own_m(&child)).fold(0.0, f64::max);
        let beneath = beneath_m.get(&id).copied().unwrap_or_default();
        let deviation = TileDeviation::from_statistics(seen, beneath, children_m);
        pass_up(id, deviation.geometric_error_m, &mut beneath_m);
        by_tile.insert(id, deviation);
    }
    by_tile
}
