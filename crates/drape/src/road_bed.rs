//! A plane through a piece of a road, and the deviation of the ground near the piece from it.

use corniche_geom::{LatticeBounds, LatticePoint, StepBudget};
use corniche_tin::Surface;

use crate::height_range::padded;
use crate::segment_rectangle::SegmentRectangle;

/// A straight piece of a road on the ground, in one triangle. Positions in plan are in lattice
/// steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundSegment {
    /// The start of the piece.
    pub start: [f64; 2],
    /// The east and north components of its direction, of length 1.
    pub direction: [f64; 2],
    /// The length of the piece in plan.
    pub length: f64,
    /// Heights of the ground at its start and its end, in metres.
    pub heights_m: [f64; 2],
    /// Whether the road has a cap at its start and at its end, which is where it does not continue
    /// straight on.
    pub has_caps: [bool; 2],
}

/// A plane through a piece of a road, and the deviation of the ground near the piece from it.
///
/// ```text
///     height │          ╱‾‾╲___   ground
///            │ ─ ─ ─ ─╱─ ─ ─ ─ ─ above
///            │    ___╳─────────── plane
///            │ ──╱─ ╱ ─ ─ ─ ─ ─ ─ below
///            └──────┴───────► across
///                 piece
/// ```
///
/// The plane contains the piece, and across the piece it rises like the ground on the whole. At a
/// distance d from the piece the ground is below the plane by at most `rises_m[0]` · d, and within
/// the reach by at most `most_m[0]`; it is above the plane by at most `rises_m[1]` · d and
/// `most_m[1]`. "Near the piece" means the ground across it, and the ground around its end if the
/// road has a cap there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadBed {
    /// Metres by which the plane rises per lattice step to the left of the piece.
    pub cross_rise_m: f64,
    /// Metres by which the ground deviates from the plane downwards and upwards per lattice step of
    /// distance from the piece; infinite if there is not ground everywhere near.
    pub rises_m: [f64; 2],
    /// The largest deviation downwards and upwards, in metres.
    pub most_m: [f64; 2],
}

/// Computes the bed of a piece, for ground within `reach` lattice steps of it. Each examined
/// triangle is a step of `work`.
#[must_use]
pub fn road_bed(
    piece: &GroundSegment,
    surface: &Surface,
    reach: f64,
    work: &StepBudget,
) -> RoadBed {
    let GroundSegment { start, direction, length, heights_m, has_caps } = *piece;
    let beyond = has_caps.map(|has_cap| if has_cap { reach } else { 0.0 });
    // A piece may be shorter than rounding errors: it is extended a little, so that the rectangle
    // has an area.
    let slack = 1e-3_f64.min(reach);
    let beside = SegmentRectangle::beside(
        start,
        direction,
        length,
        reach,
        beyond.map(|beyond| beyond.max(slack)),
    );
    let mut triangles = Vec::new();
    surface.triangles_near(bounds(piece, reach), &mut triangles);
    work.add(triangles.len());
    let parts: Vec<_> = triangles
        .into_iter()
        .filter_map(|triangle| {
            let part = beside.part_of(triangle, surface);
            let [east_m, north_m] = surface.gradient_m(triangle);
            // The rise along the piece, and the rise to its left.
            let rise_m = [
                east_m * direction[0] + north_m * direction[1],
                north_m * direction[0] - east_m * direction[1],
            ];
            (!part.corners().is_empty()).then_some((part, rise_m))
        })
        .collect();
    let (covered, weighed) = parts.iter().fold((0.0, 0.0), |(covered, weighed), (part, rise_m)| {
        let area = part.area();
        (covered + area, weighed + area * rise_m[1])
    });
    let cross_rise_m = if covered > 0.0 { weighed / covered } else { 0.0 };
    let along_rise_m = if length > 0.0 { (heights_m[1] - heights_m[0]) / length } else { 0.0 };
    let (mut range_m, mut rises_m) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (part, [along_m, left_m]) in &parts {
        let bend_m = [along_m - along_rise_m, left_m - cross_rise_m];
        for &[along, across, height_m] in part.corners() {
            let plane_m = heights_m[0] + along_rise_m * along + cross_rise_m * across;
            widen(&mut range_m, height_m - plane_m);
            // Ground next to the piece is reached straight across it; ground around an end can be
            // in any direction.
            if along < -slack || along > length + slack {
                let most_m = libm::hypot(bend_m[0], bend_m[1]);
                widen(&mut rises_m, most_m);
                widen(&mut rises_m, -most_m);
            } else {
                widen(&mut rises_m, bend_m[1] * across.signum());
            }
        }
    }
    let is_covered = beside.is_covered(covered);
    let [lowest_m, highest_m] = padded(range_m);
    RoadBed {
        cross_rise_m,
        rises_m: if is_covered { [-rises_m[0], rises_m[1]] } else { [f64::INFINITY; 2] },
        most_m: [-lowest_m, highest_m],
    }
}

fn widen([least, most]: &mut [f64; 2], value: f64) {
    *least = least.min(value);
    *most = most.max(value);
}

/// The bounds of the rectangle near a piece, and some more.
fn bounds(piece: &GroundSegment, reach: f64) -> LatticeBounds {
    let GroundSegment { start, direction, length, .. } = *piece;
    let end = [0, 1].map(|axis| start[axis] + length * direction[axis]);
    // A corner is √2 reaches from its end.
    let around = 1.5 * reach + 1.0;
    let least = |axis: usize| (start[axis].min(end[axis]) - around).floor() as i64;
    let most = |axis: usize| (start[axis].max(end[axis]) + around).ceil() as i64;
    LatticeBounds {
        min: LatticePoint::new(least(0), least(1)),
        max: LatticePoint::new(most(0), most(1)),
    }
}

#[cfg(test)]
#[path = "road_bed_tests.rs"]
mod tests;
