//! Checks that the roads and the elevation data overlap.

use std::path::PathBuf;

use corniche_dem::GridPlan;
use corniche_geom::{Bounds, GridFrame, ProjectError, Projection};

use super::totals::RoadTotals;
use crate::ExtractError;

/// Fails if no road of the extract `osm` is inside the elevation data's rectangle.
///
/// # Errors
/// See [`ExtractError`].
pub fn check_overlap(
    roads: &RoadTotals,
    osm: &[PathBuf],
    frame: &GridFrame,
    projection: &dyn Projection,
    plan: &GridPlan,
) -> Result<(), ExtractError> {
    let (data_m, data_deg) = (&plan.data_bounds, &plan.wgs84_bounds);
    let Some(bounds) = roads.bounds else { return Ok(()) };
    let [min, max] = [bounds.min, bounds.max].map(|corner| frame.position_m(corner));
    let roads_m = Bounds { min_x: min[0], min_y: min[1], max_x: max[0], max_y: max[1] };
    if roads_m.intersects(data_m) {
        return Ok(());
    }
    let roads_deg = bounds_deg(roads_m, projection).map_err(ExtractError::Project)?;
    let roads_and_heights_deg = Box::new([roads_deg, *data_deg]);
    Err(ExtractError::NoOverlap { osm: osm.to_vec(), roads_and_heights_deg })
}

/// Converts a rectangle of the working CRS to degrees by all its corners, because two corners do
/// not suffice if it is turned.
fn bounds_deg(bounds_m: Bounds, projection: &dyn Projection) -> Result<Bounds, ProjectError> {
    let Bounds { min_x, min_y, max_x, max_y } = bounds_m;
    let mut corners = [[min_x, min_y], [max_x, max_y], [min_x, max_y], [max_x, min_y]];
    projection.wgs84_from_working(&mut corners)?;
    let mut bounds_deg = Bounds::EMPTY;
    for corner in corners {
        bounds_deg.include(corner);
    }
    Ok(bounds_deg)
}

#[cfg(test)]
#[path = "overlap_tests.rs"]
mod tests;
