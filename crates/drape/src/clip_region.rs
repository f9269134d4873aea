//! Lines are clipped to a region of any outline.

use corniche_geom::{LatticeBounds, LatticePoint, LatticeRegion, Polyline, cross};

use crate::clip::{ClippedPart, Inside, Parts};

/// The parts of `line` in a region of any outline, in order, and where in the line they come from.
///
/// ```text
///            ┌─────────┐
///   p ───────x─ ─ ─ ─ ─x──────── q      the parts between two crossings lie inside or outside as a whole:
///            └─────────┘                their middles are asked
/// ```
///
/// Which edges a segment crosses is decided exactly. Where it crosses is rounded to the nearest lattice step. What runs along an outline is
/// inside. A stretch of less than two lattice steps between two crossings may go to either side.
#[must_use]
pub fn clip_region(line: &Polyline, region: &LatticeRegion) -> Vec<ClippedPart> {
    let around = LatticeBounds::of(line.points());
    if around.is_none_or(|around| !around.intersects(&region.bounds())) {
        return Vec::new();
    }
    let mut parts = Parts::default();
    // Whether the end of the last segment is inside, if no outline touches that segment.
    let mut last_inside = None;
    for (index, pair) in line.points().windows(2).enumerate() {
        parts.segment = index;
        let segment = [pair[0], pair[1]];
        let crossings = Crossings::of(segment, region);
        if crossings.is_none() {
            let is_inside = last_inside.unwrap_or_else(|| region.contains(segment[0]));
            last_inside = Some(is_inside);
            parts.take(segment, is_inside.then_some([0.0, 1.0]));
            continue;
        }
        last_inside = None;
        let mut kept: Option<[f64; 2]> = None;
        for [from, to] in crossings.stretches() {
            if crossings.is_inside(segment, [from, to], region) {
                kept = Some(kept.map_or([from, to], |[start, _]| [start, to]));
            } else {
                parts.take(segment, kept.take());
            }
        }
        parts.take(segment, kept);
    }
    parts.end();
    parts.ended
}

impl Parts {
    /// Keeps a stretch of a segment, given as shares of it; or nothing, and then what follows begins anew.
    fn take(&mut self, [p, q]: [LatticePoint; 2], stretch: Option<[f64; 2]>) {
        let Some([from, to]) = stretch else {
            self.goes_on = false;
            return;
        };
        let at = |share: f64| {
            let along = |from: i64, to: i64| from + ((to - from) as f64 * share).round() as i64;
            LatticePoint::new(along(p.u, q.u), along(p.v, q.v))
        };
        let (whole_start, whole_end) = (from <= 0.0, to >= 1.0);
        let ends = [if whole_start { p } else { at(from) }, if whole_end { q } else { at(to) }];
        self.keep(Inside { ends, whole_start, whole_end });
    }
}

/// Where a segment meets outlines, as shares of it: 0 at its start, 1 at its end.
#[derive(Default)]
struct Crossings {
    /// Shares between 0 and 1, without these; ascending.
    shares: Vec<f64>,
    /// Stretches along outlines.
    along: Vec<[f64; 2]>,
    /// Whether an outline touches it at all.
    touches: bool,
}

impl Crossings {
    fn of([p, q]: [LatticePoint; 2], region: &LatticeRegion) -> Self {
        let mut found = Self::default();
        let Some(near) = LatticeBounds::of(&[p, q]) else { return found };
        for [a, b] in region.edges_near(&near) {
            let (of_p, of_q) = (cross(a, b, p), cross(a, b, q));
            if of_p == 0 && of_q == 0 {
                let ends = [share([p, q], a), share([p, q], b)];
                let [from, to] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                if from <= 1.0 && to >= 0.0 {
                    found.touches = true;
                    found.along.push([from, to]);
                    found.shares.extend([from, to]);
                }
                continue;
            }
            let (of_a, of_b) = (cross(p, q, a), cross(p, q, b));
            if of_p.signum() * of_q.signum() <= 0 && of_a.signum() * of_b.signum() <= 0 {
                found.touches = true;
                found.shares.push(of_p as f64 / (of_p - of_q) as f64);
            }
        }
        found.shares.retain(|&share| share > 0.0 && share < 1.0);
        found.shares.sort_by(f64::total_cmp);
        found.shares.dedup();
        found
    }

    fn is_none(&self) -> bool {
        !self.touches
    }

    /// The stretches between crossings.
    fn stretches(&self) -> impl Iterator<Item = [f64; 2]> {
        let starts = std::iter::once(0.0).chain(self.shares.iter().copied());
        let ends = self.shares.iter().copied().chain(std::iter::once(1.0));
        starts.zip(ends).map(|(from, to)| [from, to])
    }

    fn is_inside(
        &self,
        [p, q]: [LatticePoint; 2],
        [from, to]: [f64; 2],
        region: &LatticeRegion,
    ) -> bool {
        let middle = f64::midpoint(from, to);
        if self.along.iter().any(|[from, to]| (*from..=*to).contains(&middle)) {
            return true;
        }
        // In half steps of the lattice.
        let at = |p: i64, q: i64| 2 * p + ((q - p) as f64 * 2.0 * middle).round() as i64;
        region.contains_half([at(p.u, q.u), at(p.v, q.v)])
    }
}

/// How far along a segment a point on its line lies.
fn share([p, q]: [LatticePoint; 2], at: LatticePoint) -> f64 {
    let (run, rise) = (q.u - p.u, q.v - p.v);
    if run.abs() >= rise.abs() {
        (at.u - p.u) as f64 / run as f64
    } else {
        (at.v - p.v) as f64 / rise as f64
    }
}

#[cfg(test)]
#[path = "clip_region_tests.rs"]
mod tests;
