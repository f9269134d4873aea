//! The table of longitudes and latitudes that a package contains.

use corniche_dem::{Dem, GridPlan};
use corniche_geom::{CoordinateTable, CoordinateTableError};

use crate::PlanError;

/// The largest error of positions that are interpolated from the manifest.
const COORDINATE_TOLERANCE_M: f64 = 0.01;

/// Longitudes and latitudes over the data's rectangle, for readers without PROJ.
///
/// The table has a margin around the rectangle, but does not extend to the root's far corners,
/// which can be very far away. The margin ends at the poles; if a projection ends within the
/// margin, there is no margin.
pub(crate) fn coordinates(dem: &Dem, plan: &GridPlan) -> Result<CoordinateTable, PlanError> {
    let projection = dem.projection(plan)?;
    let data = plan.data_bounds;
    let room_m = 0.1 * data.width().max(data.height()).max(plan.frame.cell().shorter_m());
    let pole_m = plan.poles_y_m().unwrap_or(f64::INFINITY);
    let mut around = data.expanded([room_m; 2]);
    around.min_y = around.min_y.max(-pole_m).min(data.min_y);
    around.max_y = around.max_y.min(pole_m).max(data.max_y);
    let sample = |bounds| CoordinateTable::sample(&projection, bounds, COORDINATE_TOLERANCE_M);
    match sample(around) {
        Err(CoordinateTableError::TooCurved { .. }) => Ok(sample(data)?),
        found => Ok(found?),
    }
}
