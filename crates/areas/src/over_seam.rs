//! Polygons that extend beyond one end of a map of the Earth continue at the other end.

use corniche_geom::{LatticePoint, OnSeamedMap as _, Seam};

use crate::{Axis, OutlineError, Polygon, divide_all};

/// Splits a polygon at the seam of a map. The polygon's points are continuous along its rings, so
/// it may extend beyond one end of the map by up to a turn; `seam` has whole steps.
///
/// # Errors
/// The same as for [`divide`](crate::divide).
pub fn split_polygon(polygon: Polygon, seam: Seam) -> Result<Vec<Polygon>, OutlineError> {
    let [west, east] = seam.ends();
    let [least, most] = x_range(polygon.outer().points());
    if least >= west && most <= east {
        return Ok(vec![polygon]);
    }
    let moved = |polygons: &[Polygon], by: f64| -> Vec<Polygon> {
        let place = |point: LatticePoint| Some(point.with_x(point.x() + by));
        polygons.iter().filter_map(|polygon| polygon.placed(place)).collect()
    };
    let [beyond_west, others] = divide_all(&[polygon], Axis::East, west as i64)?;
    let [mut inside, beyond_east] = divide_all(&others, Axis::East, east as i64)?;
    inside.extend(moved(&beyond_west, seam.turn()));
    inside.extend(moved(&beyond_east, -seam.turn()));
    Ok(inside)
}

/// Makes the points of a polygon's rings continuous, the outer ring first: it is moved next to the
/// middle of the map, and holes to where it is.
pub fn unroll_rings(rings: &mut [Vec<LatticePoint>], seam: Seam) {
    let mut map = seam;
    for (number, ring) in rings.iter_mut().enumerate() {
        map.unroll(ring);
        if number == 0 {
            let [least, most] = x_range(ring);
            map = seam.around(f64::midpoint(least, most));
        }
    }
}

fn x_range(points: &[LatticePoint]) -> [f64; 2] {
    let x = || points.iter().map(LatticePoint::x);
    [x().fold(f64::INFINITY, f64::min), x().fold(f64::NEG_INFINITY, f64::max)]
}

#[cfg(test)]
#[path = "over_seam_tests.rs"]
mod tests;
