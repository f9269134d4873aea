//! Step *roads*: the extract to pieces of roads by tile.

use corniche_store::Scratch;

use crate::{
    BuildError,
    context::Context,
    roads::{
        lengths::TrueLengths,
        overlap::check_overlap,
        partition::{RoadInput, partition},
    },
};

/// Reads the extract, if there is one and it was not read yet; fails if none of its roads lies on the elevation data.
pub(crate) fn make(context: &Context<'_>, scratch: &dyn Scratch) -> Result<(), BuildError> {
    let Some(osm) = &context.settings.osm else { return Ok(()) };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(context.threads())
        .build()
        .map_err(|error| BuildError::Start { what: error.to_string() })?;
    let projection = context.source.projection(context.grid)?;
    let frame = *context.frame();
    let input = RoadInput {
        osm,
        settings: &context.settings.roads,
        projection: &projection,
        levels: context.levels,
        lengths: &TrueLengths::new(frame, context.coordinates, &projection),
        data_bounds: context.data().bounds(&frame),
        pool: &pool,
        memory_bytes: context.memory().sorting,
    };
    let totals = partition(&input, context.store, scratch, context.observer)?;
    check_overlap(&totals, osm, &frame, &projection, context.grid)
}
