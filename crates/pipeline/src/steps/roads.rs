//! Step *roads*: splits the extract into pieces of roads by tile.

use corniche_pieces::{
    extract::{
        partition::{ExtractInput, partition},
        reading_pool,
    },
    roads::{overlap::check_overlap, totals::RoadTotals},
};
use corniche_spec::artifacts::{self, ArtifactError, ArtifactKind};
use corniche_store::{Artifacts, ScratchSpace};

use crate::{BuildError, context::BuildContext};

/// The totals of all roads; an error if they are missing, `None` without an extract.
pub(crate) fn totals(context: &BuildContext<'_>) -> Result<Option<RoadTotals>, BuildError> {
    check_done(context)?;
    Ok(artifacts::get(context.store, ArtifactKind::RoadTotals.item(0))?)
}

/// Fails if there is an extract whose roads are not partitioned yet.
pub(crate) fn check_done(context: &BuildContext<'_>) -> Result<(), BuildError> {
    if context.settings.osm.is_empty() || are_done(context.store) {
        return Ok(());
    }
    let what = "the list of the extract's roads".to_owned();
    Err(ArtifactError::Missing { what, step: "roads" }.into())
}

/// Whether the roads of an extract are in a store.
pub(crate) fn are_done(store: &dyn Artifacts) -> bool {
    store.has(ArtifactKind::RoadTotals.item(0))
}

/// Reads the extract, if there is one that was not read yet; fails if none of its roads is on the
/// elevation data.
pub(crate) fn make(
    context: &BuildContext<'_>,
    scratch: &dyn ScratchSpace,
) -> Result<(), BuildError> {
    let osm = context.settings.osm.as_slice();
    if osm.is_empty() {
        return Ok(());
    }
    let pool = reading_pool(context.threads())?;
    let frame = *context.frame();
    let outline = context.data_outline()?;
    let input = ExtractInput {
        osm,
        settings: &context.settings.roads,
        layers: &context.settings.layers,
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
