//! Steps *ways* and *nodes*: the two passes over a share (chunk) of the extract. They are optional:
//! without them, the step *roads* runs both.

use corniche_osm::{ReadOsmError, ReadRequest, Share, keep_nodes, keep_ways};
use corniche_pieces::extract::{
    kept::{kept_in, not_read},
    reading_pool,
};
use corniche_spec::artifacts::ArtifactError;
use corniche_store::ScratchSpace;
use corniche_work::Stage;

use super::roads::are_done;
use crate::{BuildError, context::BuildContext};

/// Stores the missing road ways of a share; does nothing without an extract, or if the roads are
/// complete.
pub(crate) fn make_ways(
    context: &BuildContext<'_>,
    share: Share,
    scratch: &dyn ScratchSpace,
) -> Result<(), BuildError> {
    read(context, scratch, &|request| {
        keep_ways(request, share, kept_in(context.store), &|| context.observer.is_cancelled())
    })
}

/// Stores the missing node positions of a share; does nothing without an extract, or if the roads
/// are complete. The ways of all shares must be complete.
pub(crate) fn make_nodes(
    context: &BuildContext<'_>,
    share: Share,
    scratch: &dyn ScratchSpace,
) -> Result<(), BuildError> {
    let kept = kept_in(context.store);
    read(context, scratch, &|request| {
        keep_nodes(request, share, kept, &|| context.observer.is_cancelled())
    })
    .map_err(|error| match kept.missing_ways(share.count()) {
        Some(missing) => {
            let what = format!("chunk {missing} of the ways");
            ArtifactError::Missing { what, step: "ways" }.into()
        }
        None => error,
    })
}

fn read(
    context: &BuildContext<'_>,
    scratch: &dyn ScratchSpace,
    step: &dyn Fn(&ReadRequest<'_>) -> Result<(), ReadOsmError>,
) -> Result<(), BuildError> {
    let Some((path, others)) = context.settings.osm.split_first() else { return Ok(()) };
    if are_done(context.store) {
        return Ok(());
    }
    let observer = context.observer;
    observer.begin(Stage::Extract, None);
    let read = step(&ReadRequest {
        path,
        others,
        table: &context.settings.roads.table,
        // Lattice positions and areas are not needed here; the step *roads* computes them.
        place: &|positions_deg| vec![None; positions_deg.len()],
        ring_area_m2: &|_| 0.0,
        seam: None,
        square_steps: i64::MAX,
        node_ids: false,
        pool: &reading_pool(context.threads())?,
        memory_bytes: context.memory().sorting,
        scratch,
        on_progress: Some(&|done, total| observer.reached(Stage::Extract, done, total)),
    });
    observer.check()?;
    read.map_err(not_read)?;
    observer.end(Stage::Extract);
    Ok(())
}
