//! Lines for shadow volumes: the line in plan, and the lowest and the highest ground around each of
//! its segments.

use std::ops::Range;

use corniche_geom::{LatticeBounds, LatticePoint, Polyline, StepBudget, TooMuchWork};
use corniche_tin::Surface;

use crate::{SvLine, height_range::padded, segment_rectangle::SegmentRectangle};

/// Returns the lines in plan for shadow volumes, with the lowest and the highest ground of this
/// tile around each segment.
///
/// *Around* means the rectangle along the segment that extends `margin_steps` beyond it on every
/// side, so it contains the segment's caps. The range includes all heights of the TIN in this
/// rectangle. Segments without ground in their rectangle are omitted, which splits the line. Clip
/// `line` to the tile and its margin first ([`clip_closed`](crate::clip_closed)).
///
/// Source: Sutherland & Hodgman 1974, *Reentrant Polygon Clipping*, for the polygons. Vaaraniemi,
/// Treib & Westermann 2011, section 5, use the height range of the tile; we use one per segment.
#[must_use]
pub fn extrude(line: &Polyline, surface: &Surface, margin_steps: i64) -> Vec<SvLine> {
    extrude_within(line, surface, margin_steps, &StepBudget::unlimited()).unwrap_or_default()
}

/// Extrudes a line like [`extrude`] within a limit of work, for lines from untrusted sources: each
/// examined triangle is a step.
///
/// # Errors
/// When the limit is exceeded.
pub fn extrude_within(
    line: &Polyline,
    surface: &Surface,
    margin_steps: i64,
    work: &StepBudget,
) -> Result<Vec<SvLine>, TooMuchWork> {
    // Add one step to the margin: rounding to f64 must not lose ground at the edge.
    let margin = margin_steps.max(0) + 1;
    let mut lines = Vec::new();
    let none = || SvLine { points: Vec::new(), ground_range_m: Vec::new() };
    let mut current = none();
    let mut near = Near { surface, lowest_first: Vec::new(), highest_first: Vec::new(), work };
    let points = line.points();
    let mut searched = 0..0;
    for (index, &ends) in points.array_windows().enumerate() {
        work.check()?;
        if !searched.contains(&index) {
            searched = near.search(points, index, margin);
        }
        if let Some(range_m) = near.ground_range_m(ends, margin) {
            if current.points.is_empty() {
                current.points.push(ends[0]);
            }
            current.points.push(ends[1]);
            current.ground_range_m.push(range_m);
        } else if !current.points.is_empty() {
            lines.push(std::mem::replace(&mut current, none()));
        }
    }
    if !current.points.is_empty() {
        lines.push(current);
    }
    Ok(lines)
}

/// The triangles near some segments of a line, sorted so that only a few are examined for each
/// segment.
///
/// ```text
///     height │    ╷   ╷                 A triangle whose lowest corner is above what has been found cannot
///            │ ╷  │ ╷ │ ╷               lower it, nor can any after it: the search for the lowest ground
///            │ │╷ │ │ ╵ │               ends there. The other way round for the highest. Neighbouring
///            │ ╵│ ╵ │   ╵               segments have nearly the same triangles within their margins, so
///            │  ╵   ╵                   these are collected and sorted once for a stretch of the line.
///            └────────────► lowest first
/// ```
struct Near<'a> {
    surface: &'a Surface,
    /// Each triangle with its lowest corner.
    lowest_first: Vec<(f64, u32)>,
    /// Each triangle with its highest corner.
    highest_first: Vec<(f64, u32)>,
    work: &'a StepBudget,
}

impl Near<'_> {
    /// Collects the triangles near segment `first` and near the segments after it that add few;
    /// returns the range of segments.
    fn search(&mut self, points: &[LatticePoint], first: usize, margin: i64) -> Range<usize> {
        let ends =
            |at: usize| LatticeBounds::at(points[at]).union(&LatticeBounds::at(points[at + 1]));
        let mut bounds = ends(first);
        let mut end = first + 1;
        while end + 1 < points.len() {
            let wider = bounds.union(&ends(end));
            let longer = (wider.max.u - wider.min.u).max(wider.max.v - wider.min.v);
            if longer > margin {
                break;
            }
            (bounds, end) = (wider, end + 1);
        }
        // A corner of a segment's rectangle is √2 margins from its end.
        let around = margin + margin / 2 + 1;
        let mut triangles = Vec::new();
        if end == first + 1 {
            let ends = [points[first], points[end]].map(LatticePoint::in_steps);
            self.surface.triangles_along(ends, around as f64, &mut triangles);
            self.work.add(triangles.len());
        } else {
            let visit = |triangle| triangles.push(triangle);
            self.surface.visit_triangles_near(bounds.expanded(around), visit);
            self.work.add(triangles.len());
            triangles.sort_unstable();
            triangles.dedup();
        }
        let surface = self.surface;
        let by = |pick: fn(f64, f64) -> f64| -> Vec<(f64, u32)> {
            let corner_m = |&triangle: &u32| {
                let [a, b, c] = heights_m(surface, triangle);
                (pick(pick(a, b), c), triangle)
            };
            triangles.iter().map(corner_m).collect()
        };
        (self.lowest_first, self.highest_first) = (by(f64::min), by(f64::max));
        self.lowest_first.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        self.highest_first.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        first..end
    }

    /// Returns the lowest and the highest ground around one of the segments; `None` if there is no
    /// ground.
    fn ground_range_m(&self, [p, q]: [LatticePoint; 2], margin: i64) -> Option<[f64; 2]> {
        let around = SegmentRectangle::new([p, q].map(LatticePoint::in_steps), margin as f64);
        let (mut lowest_m, mut highest_m) = (f64::INFINITY, f64::NEG_INFINITY);
        let look = |triangle: u32, [lowest_m, highest_m]: [&mut f64; 2]| {
            self.work.add(1);
            for &[.., height_m] in around.part_of(triangle, self.surface).corners() {
                *lowest_m = lowest_m.min(height_m);
                *highest_m = highest_m.max(height_m);
            }
        };
        for &(corner_m, triangle) in &self.lowest_first {
            if corner_m >= lowest_m {
                break;
            }
            look(triangle, [&mut lowest_m, &mut highest_m]);
        }
        if lowest_m > highest_m {
            // All triangles have been examined.
            return None;
        }
        for &(corner_m, triangle) in &self.highest_first {
            if corner_m <= highest_m {
                break;
            }
            look(triangle, [&mut lowest_m, &mut highest_m]);
        }
        Some(padded([lowest_m, highest_m]))
    }
}

fn heights_m(surface: &Surface, triangle: u32) -> [f64; 3] {
    surface.triangles()[triangle as usize].map(|vertex| surface.heights_m()[vertex as usize])
}

#[cfg(test)]
#[path = "extrude_tests.rs"]
pub(crate) mod tests;
