//! Snaps polygons to a coarser lattice, which may join or divide them, and keeps them free of
//! crossings.

use corniche_geom::LatticePoint;

use crate::{
    Polygon, Ring, assemble::polygons_of, outline::OutlineError, segments::uncrossed_segments_of,
};

/// Snaps a polygon to a coarser lattice, whose points are whole multiples of `step`.
///
/// Each point moves to the nearest point of the coarse lattice, whatever its neighbours are. So two
/// areas that share a part of their borders still share it afterwards, and parts narrower than a
/// step collapse. Where segments then cross, both are routed through the coarse point nearest to
/// the crossing. Except for such points, no point moves farther than half a step along each axis.
///
/// The result is empty if nothing remains. `step` must be above 0.
///
/// # Errors
/// [`OutlineError::TooIntricate`], for polygons far beyond what is realistic.
pub fn coarsen(polygon: &Polygon, step: i64) -> Result<Vec<Polygon>, OutlineError> {
    let rings: Vec<&[LatticePoint]> = polygon.rings().map(Ring::points).collect();
    surrounded(&rings, step)
}

/// Returns the polygons that closed lines enclose by the even-odd rule, with points on a coarser
/// lattice as in [`coarsen`]. Lines may cross themselves and each other; the last point of each
/// line connects to its first.
///
/// # Errors
/// [`OutlineError::TooIntricate`], for lines far beyond what is realistic.
pub fn surrounded(rings: &[&[LatticePoint]], step: i64) -> Result<Vec<Polygon>, OutlineError> {
    let to_coarse = |part: i64| (2 * part + step).div_euclid(2 * step);
    let coarse = |point: &LatticePoint| LatticePoint::new(to_coarse(point.u), to_coarse(point.v));
    let closed = |ring: &&[LatticePoint]| ring.iter().chain(ring.first()).map(coarse).collect();
    let rings: Vec<Vec<LatticePoint>> = rings.iter().map(closed).collect();
    let polygons = polygons_of(uncrossed_segments_of(&rings)?)?;
    let fine = |point: LatticePoint| Some(LatticePoint::new(point.u * step, point.v * step));
    Ok(polygons.iter().filter_map(|polygon| polygon.placed(fine)).collect())
}

#[cfg(test)]
#[path = "coarsen_tests.rs"]
mod tests;
