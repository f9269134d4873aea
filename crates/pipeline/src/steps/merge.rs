//! Step *merge*: the coarse tiles above all subtrees, the sums over all records, the manifest, the package.

use std::path::Path;

use corniche_geom::TileId;
use corniche_store::Scratch;
use corniche_tileset::{InputRecord, Manifest, Writer, tile_of_order};

use super::{
    coarse_tiles, heights,
    manifest::{self, Outcome},
    sums::TileSums,
};
use crate::{
    BuildError, Observer as _, Stage,
    artifacts::Kind,
    context::Context,
    roads::{
        losses::LossFold,
        totals::RoadTotals,
    },
    tile::record::TileRecord,
};

/// Where the package goes.
pub(crate) struct Target<'a> {
    /// The file to write.
    pub(crate) finished: &'a Path,
    /// Its final name, for messages.
    pub(crate) named: &'a Path,
}

/// Makes the tiles above the subtrees, adds up all records and writes the package. `check_inputs` is called when nothing of the
/// inputs is read any more.
pub(crate) fn make(
    context: &Context<'_>,
    inputs: Vec<InputRecord>,
    scratch: &dyn Scratch,
    target: &Target<'_>,
    check_inputs: &dyn Fn() -> Result<(), BuildError>,
) -> Result<Manifest, BuildError> {
    let heights = heights::sums(context)?;
    coarse_tiles::make(context, TileId::ROOT)?;
    let roads = match &context.settings.osm {
        Some(_) => Some(RoadTotals::load(context.store)?.ok_or_else(|| BuildError::Missing {
            what: "the roads of the extract".to_owned(),
            step: "roads",
        })?),
        None => None,
    };
    let mut tiles = TileSums::new(context);
    let mut fold = LossFold::new(scratch, context.memory().sorting);
    for item in context.store.items(Kind::Record as u8) {
        let id = tile_of_order(item).ok_or_else(|| {
            crate::artifacts::damaged(Kind::Record.item(item), &"there is no such tile")
        })?;
        if let Some(record) = TileRecord::get(context.store, id)? {
            tiles.add(id.z(), &record);
            fold.add(&record.fates)?;
        }
        if context.observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
    }
    if tiles.levels.values().all(|level| level.tiles == 0) {
        let dem = context.settings.dem.clone();
        return Err(BuildError::NoCell { dem, nodes: heights.samples.with_data });
    }
    let losses = match &roads {
        Some(totals) => Some(fold.finish(totals, context.store, context.observer)?),
        None => None,
    };
    let manifest = manifest::of(&Outcome {
        context,
        inputs,
        heights,
        roads: roads.as_ref().zip(losses.as_ref()),
        tiles: &tiles,
    });
    if let (Some(osm), 0) = (&context.settings.osm, manifest.counts.roads_kept) {
        return Err(BuildError::NoGround { osm: osm.clone() });
    }
    // All inputs have been read. If none has changed, the recorded hashes are those of the bytes that were used.
    check_inputs()?;
    write(context, target, &manifest)?;
    Ok(manifest)
}

/// Writes the package.
fn write(
    context: &Context<'_>,
    target: &Target<'_>,
    manifest: &Manifest,
) -> Result<(), BuildError> {
    let failed = |source| BuildError::Write { path: target.named.to_path_buf(), source };
    let payloads = context.store.items(Kind::Payload as u8);
    context.observer.begin(Stage::Package, Some(payloads.len() as u64));
    let mut writer = Writer::create(target.finished, manifest).map_err(failed)?;
    for item in payloads {
        if context.observer.is_cancelled() {
            return Err(BuildError::Interrupted);
        }
        let key = Kind::Payload.item(item);
        let id = tile_of_order(item)
            .ok_or_else(|| crate::artifacts::damaged(key, &"there is no such tile"))?;
        let bytes = context.store.get(key)?;
        let bytes = bytes.ok_or_else(|| crate::artifacts::damaged(key, &"it is gone"))?;
        writer.add(id, &bytes).map_err(failed)?;
        context.observer.advance(Stage::Package, 1);
    }
    writer.finish().map_err(failed)?;
    context.observer.end(Stage::Package);
    Ok(())
}
