//! The fractions of a segment in a region of any outline.

use crate::{LatticeBounds, LatticePoint, LatticeRegion, cross};

impl LatticeRegion {
    /// The fractions of the segment that are inside, ascending, each from start to end; `None` if
    /// no outline touches the segment, so that it is inside or outside as a whole.
    ///
    /// ```text
    ///            ┌─────────┐
    ///   p ───────x─ ─ ─ ─ ─x──────── q      the parts between two crossings are inside or outside as a whole:
    ///            └─────────┘                their middles are tested
    /// ```
    ///
    /// Which edges a segment crosses is decided exactly. Stretches along an outline are inside. A
    /// stretch of less than two lattice steps between two crossings may be assigned to either side.
    #[must_use]
    pub fn shares_inside(&self, segment: [LatticePoint; 2]) -> Option<Vec<[f64; 2]>> {
        let crossings = Crossings::from_segment(segment, self);
        if !crossings.touches {
            return None;
        }
        let mut inside: Vec<[f64; 2]> = Vec::new();
        for [from, to] in crossings.stretches() {
            if !crossings.is_inside(segment, [from, to], self) {
                continue;
            }
            match inside.last_mut() {
                Some(last) if last[1].to_bits() == from.to_bits() => last[1] = to,
                _ => inside.push([from, to]),
            }
        }
        Some(inside)
    }
}

/// The positions at which a segment meets outlines, as fractions of it: 0 at its start, 1 at its
/// end.
#[derive(Default)]
struct Crossings {
    /// Fractions strictly between 0 and 1, ascending.
    shares: Vec<f64>,
    /// Stretches along outlines.
    along: Vec<[f64; 2]>,
    /// Whether an outline touches the segment at all.
    touches: bool,
}

impl Crossings {
    fn from_segment([p, q]: [LatticePoint; 2], region: &LatticeRegion) -> Self {
        let mut found = Self::default();
        let Some(near) = LatticeBounds::around(&[p, q]) else { return found };
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
        // The position is in half steps of the lattice.
        let at = |p: i64, q: i64| 2 * p + ((q - p) as f64 * 2.0 * middle).round() as i64;
        region.contains_half([at(p.u, q.u), at(p.v, q.v)])
    }
}

/// The fraction of a segment at which a point on its line is.
fn share([p, q]: [LatticePoint; 2], at: LatticePoint) -> f64 {
    let (run, rise) = (q.u - p.u, q.v - p.v);
    if run.abs() >= rise.abs() {
        (at.u - p.u) as f64 / run as f64
    } else {
        (at.v - p.v) as f64 / rise as f64
    }
}
