//! Clips lines to a region of any outline.

use corniche_geom::{LatticeBounds, LatticePoint, LatticeRegion, Polyline};

use crate::clip::{ClippedPart, ClippedParts, Inside};

/// Returns the parts of `line` in a region of any outline, in order, and where in the line they
/// come from.
///
/// Which edges a segment crosses is decided exactly. The crossings are rounded to the nearest
/// lattice step. Stretches along an outline are inside. A stretch of less than two lattice steps
/// between two crossings may be assigned to either side.
#[must_use]
pub fn clip_region(line: &Polyline, region: &LatticeRegion) -> Vec<ClippedPart> {
    let around = LatticeBounds::around(line.points());
    if around.is_none_or(|around| !around.intersects(&region.bounds())) {
        return Vec::new();
    }
    let mut parts = ClippedParts::default();
    // Whether the end of the last segment is inside, if no outline touches that segment.
    let mut last_inside = None;
    for (index, &segment) in line.points().array_windows().enumerate() {
        parts.segment = index;
        let Some(inside) = region.shares_inside(segment) else {
            let is_inside = last_inside.unwrap_or_else(|| region.contains(segment[0]));
            last_inside = Some(is_inside);
            parts.take(segment, is_inside.then_some([0.0, 1.0]));
            continue;
        };
        last_inside = None;
        if inside.is_empty() {
            parts.take(segment, None);
        }
        for stretch in inside {
            parts.take(segment, Some(stretch));
        }
    }
    parts.end();
    parts.ended
}

impl ClippedParts {
    /// Keeps a stretch of a segment, given as fractions of it; without a stretch, the next one
    /// begins a new part.
    fn take(&mut self, [p, q]: [LatticePoint; 2], stretch: Option<[f64; 2]>) {
        let Some([from, to]) = stretch else {
            self.goes_on = false;
            return;
        };
        let (whole_start, whole_end) = (from <= 0.0, to >= 1.0);
        let ends = [
            if whole_start { p } else { p.share_of_way(q, from) },
            if whole_end { q } else { p.share_of_way(q, to) },
        ];
        self.keep(Inside { ends, whole_start, whole_end });
    }
}

#[cfg(test)]
#[path = "clip_region_tests.rs"]
mod tests;
