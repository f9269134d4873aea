//! Bounds on the heights of the ground near a segment, which widen with the distance from it.

use corniche_geom::StepBudget;
use corniche_tin::Surface;

use crate::height_range::padded;
use crate::segment_rectangle::SegmentRectangle;

/// A triangle that is partly near is cut by two rectangles, which takes as long as examining this
/// many triangles.
const STEPS_OF_PART: usize = 4;

/// Bounds on the ground near a segment that widen with the distance from it.
///
/// ```text
///     height │  ╲                 ╱       Ground at a distance d from the segment, d ≤ reach, is not lower than
///            │    ╲  _    ground╱         the lowest beneath the segment by more than d · rise, and not higher
///            │     ╲╱ ╲___╱‾╲ ╱           than the highest by more: rise is that of the steepest triangle near.
///            │  highest ═════             The range within the reach alone, which is all that is known where
///            │  lowest  ═════             there is not ground everywhere near, is far wider on slopes.
///            │     ╱         ╲
///            └────────┬─┬──────► across
///                   segment
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearGround {
    /// Lowest and highest ground beneath the segment in metres; if `rise_m` is 0, within the whole
    /// reach.
    pub range_m: [f64; 2],
    /// Metres by which ground may be lower or higher per lattice step of distance from the segment.
    pub rise_m: f64,
}

/// Returns bounds on the ground within `reach` of a segment; `None` if there is no ground.
///
/// The ends and the reach are in lattice steps. *Within* means the same rectangle as for
/// [`extrude`](crate::extrude), which contains the caps. Each examined triangle is a step of
/// `work`, and a triangle that is partly within the reach counts for four more.
#[must_use]
pub fn near_ground(
    ends: [[f64; 2]; 2],
    surface: &Surface,
    reach: f64,
    work: &StepBudget,
) -> Option<NearGround> {
    let (near, beneath) =
        (SegmentRectangle::new(ends, reach), SegmentRectangle::new(ends, reach.min(1.0)));
    let mut triangles = Vec::new();
    // A corner of the rectangle is √2 · reach from the end of the segment.
    surface.triangles_along(ends, 1.5 * reach + 1.0, &mut triangles);
    work.add(triangles.len());
    let (mut near_range_m, mut beneath_range_m) = (NOTHING, NOTHING);
    let (mut covered, mut rise_m) = (0.0, 0.0_f64);
    for triangle in triangles {
        let part = near.part_of(triangle, surface);
        if part.corners().is_empty() {
            continue;
        }
        work.add(STEPS_OF_PART);
        widen(&mut near_range_m, part.corners());
        widen(&mut beneath_range_m, beneath.part_of(triangle, surface).corners());
        covered += part.area();
        let [east_m, north_m] = surface.gradient_m(triangle);
        rise_m = rise_m.max(libm::hypot(east_m, north_m));
    }
    if near_range_m[0] > near_range_m[1] {
        return None;
    }
    // Slopes only limit the heights if there is ground everywhere between the segment and a point.
    let is_covered = near.is_covered(covered);
    Some(if is_covered && beneath_range_m[0] <= beneath_range_m[1] {
        NearGround { range_m: padded(beneath_range_m), rise_m }
    } else {
        NearGround { range_m: padded(near_range_m), rise_m: 0.0 }
    })
}

/// The range that contains no height.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widen([lowest_m, highest_m]: &mut [f64; 2], corners: &[[f64; 3]]) {
    for &[.., height_m] in corners {
        *lowest_m = lowest_m.min(height_m);
        *highest_m = highest_m.max(height_m);
    }
}

#[cfg(test)]
#[path = "near_ground_tests.rs"]
mod tests;
