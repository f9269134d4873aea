//! Polygons are cut to a rectangle, one side after the other.

use corniche_geom::LatticeBounds;

use crate::{Axis, OutlineError, Polygon, divide};

/// The parts of polygons inside a rectangle.
///
/// # Errors
/// As [`divide`].
pub fn cut_out(polygons: &[Polygon], bounds: &LatticeBounds) -> Result<Vec<Polygon>, OutlineError> {
    let [_, east] = divide_all(polygons, Axis::East, bounds.min.u)?;
    let [inside, _] = divide_all(&east, Axis::East, bounds.max.u)?;
    let [_, north] = divide_all(&inside, Axis::North, bounds.min.v)?;
    let [inside, _] = divide_all(&north, Axis::North, bounds.max.v)?;
    Ok(inside)
}

/// [`divide`] for several polygons at once.
///
/// # Errors
/// As [`divide`].
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
