//! What polygons have in common with a region of any outline.

use corniche_geom::LatticePoint;
use i_overlay::{
    core::{
        fill_rule::FillRule,
        overlay::{IntOverlayOptions, Overlay, ShapeType},
        overlay_rule::OverlayRule,
        solver::Solver,
    },
    i_float::int::point::IntPoint,
};

use crate::{OutlineError, Polygon, surrounded};

/// The parts of polygons, whose points are whole multiples of `step`, in what rings wind around. So are the points of the parts: those of the
/// rings, and those where outlines cross, go to the nearest multiples.
///
/// Source: the crate `i_overlay`, which splits all outlines at their crossings and asks of each piece what is on its sides.
///
/// # Errors
/// [`OutlineError::TooIntricate`], where there are more than 2³¹ steps across.
pub fn intersection<'a>(
    polygons: &[Polygon],
    region: impl Iterator<Item = &'a [LatticePoint]>,
    step: i64,
) -> Result<Vec<Polygon>, OutlineError> {
    let to_coarse = |part: i64| i32::try_from((2 * part + step).div_euclid(2 * step));
    let coarse = |points: &[LatticePoint]| -> Result<Vec<IntPoint>, OutlineError> {
        let point = |point: &LatticePoint| {
            let [x, y] = [to_coarse(point.u), to_coarse(point.v)];
            x.and_then(|x| Ok(IntPoint::new(x, y?))).map_err(|_| OutlineError::TooIntricate)
        };
        points.iter().map(point).collect()
    };
    let mut overlay = Overlay::new_custom(0, IntOverlayOptions::default(), Solver::default());
    for ring in polygons.iter().flat_map(Polygon::rings) {
        overlay.add_contour(&coarse(ring.points())?, ShapeType::Subject);
    }
    for ring in region {
        overlay.add_contour(&coarse(ring)?, ShapeType::Clip);
    }
    let fine = |at: IntPoint| LatticePoint::new(i64::from(at.x) * step, i64::from(at.y) * step);
    let shapes = overlay.overlay(OverlayRule::Intersect, FillRule::NonZero);
    let rings: Vec<Vec<LatticePoint>> =
        shapes.into_iter().flatten().map(|ring| ring.into_iter().map(fine).collect()).collect();
    // Where rounding joins points, rings of the library may touch in ways that a polygon's may not.
    surrounded(&rings.iter().map(Vec::as_slice).collect::<Vec<_>>(), step)
}

#[cfg(test)]
#[path = "intersection_tests.rs"]
mod tests;
