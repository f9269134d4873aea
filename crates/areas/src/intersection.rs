//! Intersects polygons with a region of any outline.

use corniche_geom::{LatticeBounds, LatticePoint};
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

/// Returns the parts of polygons that are inside `rings` by the positive winding rule: rings wind
/// around them more often counter-clockwise than clockwise. The points of the polygons and of the
/// result are whole multiples of `step`. Points of the rings, and points where outlines cross, move
/// to the nearest multiples. If a segment ends within a step of a crossing, the crossing moves to
/// that end. So the parts extend up to two steps beyond the region, and farther only where moved
/// outlines cross again.
///
/// Source: the crate `i_overlay`, which splits all outlines at their crossings and checks for each
/// piece what is on its sides.
///
/// # Errors
/// [`OutlineError::TooIntricate`], if the extent is more than 2³¹ steps.
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
    let points: Vec<LatticePoint> =
        polygons.iter().flat_map(|polygon| polygon.outer().points()).copied().collect();
    // Outlines are also snapped to the lattice, and move by at most half a step.
    let Some(near) = LatticeBounds::around(&points).map(|bounds| bounds.expanded(step)) else {
        return Ok(Vec::new());
    };
    for ring in region {
        overlay.add_contour(&coarse(&without_far_points(ring, &near))?, ShapeType::Clip);
    }
    let fine = |at: IntPoint| LatticePoint::new(i64::from(at.x) * step, i64::from(at.y) * step);
    let shapes = overlay.overlay(OverlayRule::Intersect, FillRule::Positive);
    let rings: Vec<Vec<LatticePoint>> =
        shapes.into_iter().flatten().map(|ring| ring.into_iter().map(fine).collect()).collect();
    // Where rounding joins points, rings of the library may touch in ways that are not allowed in a
    // polygon.
    surrounded(&rings.iter().map(Vec::as_slice).collect::<Vec<_>>(), step)
}

/// Returns a ring without the points that do not matter for a rectangle: points on the same side of
/// it as the points before and after them. All segments that meet the rectangle stay unchanged, and
/// the remaining ring winds around its points as often as the whole ring.
fn without_far_points(ring: &[LatticePoint], near: &LatticeBounds) -> Vec<LatticePoint> {
    let sides = |point: &LatticePoint| {
        let LatticeBounds { min, max } = near;
        [point.u < min.u, point.u > max.u, point.v < min.v, point.v > max.v]
    };
    let is_far = |three: [&LatticePoint; 3]| {
        let [one, two, three] = three.map(sides);
        (0..4).any(|side| one[side] && two[side] && three[side])
    };
    let mut kept: Vec<LatticePoint> = Vec::new();
    for point in ring {
        while let [.., before, last] = &kept[..]
            && is_far([before, last, point])
        {
            kept.pop();
        }
        kept.push(*point);
    }
    kept
}

#[cfg(test)]
#[path = "intersection_tests.rs"]
mod tests;
