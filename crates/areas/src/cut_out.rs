//! Clips polygons to a rectangle, one side after the other.

use corniche_geom::LatticeBounds;

use crate::{Axis, OutlineError, Polygon, divide};

/// Returns the parts of polygons inside a rectangle.
///
/// # Errors
/// The same as for [`divide`].
pub fn cut_out(polygons: &[Polygon], bounds: &LatticeBounds) -> Result<Vec<Polygon>, OutlineError> {
    let [_, east] = divide_all(polygons, Axis::East, bounds.min.u)?;
    let [inside, _] = divide_all(&east, Axis::East, bounds.max.u)?;
    let [_, north] = divide_all(&inside, Axis::North, bounds.min.v)?;
    let [inside, _] = divide_all(&north, Axis::North, bounds.max.v)?;
    Ok(inside)
}

/// Divides several polygons at once; see [`divide`].
///
/// # Errors
/// The same as for [`divide`].
pub fn divide_all(
    polygons: &[Polygon],
    axis: Axis,
    at: i64,
) -> Result<[Vec<Polygon>; 2], OutlineError> {
    let mut all = [Vec::new(), Vec::new()];
    for polygon in polygons {
        for (all, parts) in all.iter_mut().zip(divide(polygon, axis, at)?) {
            all.extend(parts);
        }
    }
    Ok(all)
}
