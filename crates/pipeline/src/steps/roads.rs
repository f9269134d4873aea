//! Step *roads*: the extract to pieces of roads by tile.

use corniche_pieces::{
    extract::{
        partition::{ExtractInput, partition},
        reading_pool,
    },
    roads::{overlap::check_overlap, totals::RoadTotals},
};
use corniche_spec::artifacts::{self, ArtifactError, Kind};
use corniche_store::{Artifacts, Scratch};

use crate::{BuildError, context::Context};

/// What is known of all roads, which must be there; `None` without an extract.
pub(crate) fn totals(context: &Context<'_>) -> Result<Option<RoadTotals>, BuildError> {
    check_done(context)?;
    Ok(artifacts::get(context.store, Kind::RoadTotals.item(0))?)
}

/// Fails if there is an extract and its roads were not partitioned.
pub(crate) fn check_done(context: &Context<'_>) -> Result<(), BuildError> {
    if context.settings.osm.is_empty() || are_done(context.store) {
        return Ok(());
    }
    let what = "the list of the extract's roads".to_owned();
    Err(ArtifactError::Missing { what, step: "roads" }.into())
}

/// Whether the roads of an extract are in a store.
pub(crate) fn are_done(store: &dyn Artifacts) -> bool {
    store.has(Kind::RoadTotals.item(0))
}

/// Threads for the reading of an extract.
pub(crate) fn pool(context: &Context<'_>) -> Result<rayon::ThreadPool, BuildError> {
    Ok(reading_pool(context.threads())?)
}

/// Reads the extract, if there is one and it was not read yet; fails if none of its roads lies on the elevation data.
pub(crate) fn make(context: &Context<'_>, scratch: &dyn Scratch) -> Result<(), BuildError> {
    let osm = context.settings.osm.as_slice();
    if osm.is_empty() {
        return Ok(());
    }
    let pool = pool(context)?;
    let frame = *context.frame();
    let outline = context.data_outline()?;
    let input = ExtractInput {
        osm,
        settings: &context.settings.roads,
        areas: context.settings.areas.as_ref(),
        lines: &context.settings.lines,
        data: context.data(),
        projection: context.projection,
        levels: context.levels,
        lengths: &context.lengths(),
        node_bounds: context.node_bounds(),
        clip: context.clip(),
        bounds_deg: context.settings.terrain.plan.bounds_deg,
        outline: outline.as_ref(),
        area_deg: context.grid.area_deg(),
        polygon: context.polygon(),
        pool: &pool,
        memory_bytes: context.memory().sorting,
    };
    let totals = partition(&input, context.store, scratch, context.observer)?;
    Ok(check_overlap(&totals, osm, &frame, context.projection, context.grid)?)
}
