//! Looks at every sample of the DEM before any of them is used.

use corniche_dem::{Audit, Dem, SURFACE_RANGE_M};

use crate::{BuildError, Observer, Stage, workers};

/// Refuses a DEM with values that are no heights; see [`Audit::check`]. `range_m` is what the user allows, if said.
pub(crate) fn check(
    dem: &Dem,
    range_m: Option<[f64; 2]>,
    threads: usize,
    observer: &dyn Observer,
) -> Result<(), BuildError> {
    let allowed_m = range_m.unwrap_or(SURFACE_RANGE_M);
    let blocks = dem.audit_blocks();
    let mut audit = Audit::none_of(dem, allowed_m);
    observer.begin(Stage::Audit, Some(blocks.len() as u64));
    workers::in_order_unless_cancelled(
        observer,
        threads,
        blocks.len(),
        || Ok(dem.auditor(allowed_m)),
        |auditor, index| auditor.look(&blocks[index]).map_err(BuildError::from),
        |_, part| {
            audit.merge(&part);
            observer.advance(Stage::Audit, 1);
            Ok(())
        },
    )?;
    observer.end(Stage::Audit);
    Ok(audit.check(dem, range_m.is_some())?)
}
