//! Step *heights*: the DEM, area by area, to the heights of finest tiles and to the rasters of the levels above.

use std::collections::{BTreeMap, BTreeSet};

use corniche_dem::{Audit, AuditBlock, SURFACE_RANGE_M};
use corniche_geom::TileId;
use corniche_store::Artifacts;
use corniche_tileset::SampleCounts;

use crate::{
    BuildError, Observer, Stage,
    artifacts::Kind,
    context::Context,
    heights::{
        area::{AreaReader, AreaRecord, area_level, audit_blocks_of},
        data_tiles::DataTiles,
        rasters,
    },
    workers,
};

/// Reads the areas of a subtree that are not there yet, and makes the rasters from there up to the subtree's own.
pub(crate) fn make(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    read_areas(context, scope)?;
    make_rasters(context, scope)
}

fn read_areas(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    let Context { store, observer, dem, grid, .. } = *context;
    let level = area_level(context.frame(), scope);
    let all = context.data().above(level).within(scope);
    let missing: Vec<TileId> =
        all.iter().copied().filter(|&area| !store.has(Kind::Area.of_tile(area))).collect();
    observer.begin(Stage::Heights, Some(all.len() as u64));
    observer.advance(Stage::Heights, (all.len() - missing.len()) as u64);
    let mut blocks: BTreeMap<TileId, Vec<AuditBlock>> = BTreeMap::new();
    let wanted: BTreeSet<TileId> = missing.iter().copied().collect();
    for (area, block) in audit_blocks_of(dem, grid, level)? {
        if wanted.contains(&area) {
            blocks.entry(area).or_default().push(block);
        }
    }
    workers::in_order_unless_cancelled(
        observer,
        context.threads(),
        missing.len(),
        || Ok::<_, BuildError>(AreaReader::new(dem, grid, allowed_m(context), store)),
        |reader, index| {
            let area = missing[index];
            reader.make(area, blocks.get(&area).map_or(&[], Vec::as_slice))
        },
        |_, ()| {
            observer.advance(Stage::Heights, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Heights);
    Ok(())
}

/// Makes the rasters that are missing beneath and at `scope`, from the areas up.
pub(crate) fn make_rasters(context: &Context<'_>, scope: TileId) -> Result<(), BuildError> {
    let store = context.store;
    for level in (scope.z()..area_level(context.frame(), scope)).rev() {
        let ids: Vec<TileId> = missing_rasters(store, &context.data().above(level), scope);
        workers::in_order_unless_cancelled(
            context.observer,
            context.threads(),
            ids.len(),
            || Ok(()),
            |(), index| rasters::put_from_children(store, ids[index]),
            |_, ()| Ok::<_, BuildError>(()),
        )?;
    }
    Ok(())
}

/// Tiles without a raster that have a child with one.
fn missing_rasters(store: &dyn Artifacts, level: &DataTiles, scope: TileId) -> Vec<TileId> {
    let mut tiles = level.within(scope);
    tiles.retain(|&id| {
        !store.has(Kind::Raster.of_tile(id))
            && id.children().any(|child| store.has(Kind::Raster.of_tile(child)))
    });
    tiles
}

/// What the heights of all areas add up to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HeightSums {
    pub(crate) samples: SampleCounts,
    /// Lowest and highest node; zeros where there is none.
    pub(crate) range_m: [f32; 2],
}

/// Adds up all areas; fails if one is missing, or if the DEM has samples that cannot be heights.
pub(crate) fn sums(context: &Context<'_>) -> Result<HeightSums, BuildError> {
    let (dem, plan) = (context.dem, context.grid);
    let mut all = AreaRecord::default();
    let mut found = BTreeSet::new();
    // Areas of a build that was split have different levels; each finest tile belongs to the first of them that is there.
    for finest in context.data().within(TileId::ROOT) {
        let area = (0..=finest.z())
            .rev()
            .map(|level| finest.ancestor(level))
            .find(|&area| context.store.has(Kind::Area.of_tile(area)))
            .ok_or_else(|| BuildError::Missing {
                what: format!("the heights of tile {finest}"),
                step: "heights",
            })?;
        if found.insert(area) {
            all.merge(AreaRecord::get(context.store, area)?.unwrap_or_default());
        }
    }
    let allowed_m = allowed_m(context);
    let mut audit = Audit::none_of(dem, allowed_m);
    all.audit.iter().for_each(|part| audit.merge(part));
    audit.check(dem, context.settings.terrain.height_range_m.is_some())?;
    let span = |low: i64, high: i64| (high - low + 1) as u64;
    let nodes =
        span(plan.south_west.i, plan.north_east.i) * span(plan.south_west.j, plan.north_east.j);
    let samples = SampleCounts {
        nodes,
        with_data: all.with_height - all.filled,
        filled: all.filled,
        void: nodes.saturating_sub(all.with_height),
    };
    if samples.with_data == 0 {
        return Err(BuildError::NoHeights { dem: context.settings.dem.clone() });
    }
    Ok(HeightSums { samples, range_m: all.range_m.unwrap_or_default() })
}

/// Lowest and highest height that samples may have, metres.
fn allowed_m(context: &Context<'_>) -> [f64; 2] {
    context.settings.terrain.height_range_m.unwrap_or(SURFACE_RANGE_M)
}
