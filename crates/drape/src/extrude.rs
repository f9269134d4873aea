use corniche_geom::{LatticeBounds, LatticePoint, Polyline};
use corniche_tin::Surface;

use crate::SvLine;

/// Heights are widened by this part of the largest of them and of their range: far more than f64 rounding in
/// the cut polygons, far less than a height quantum.
const PAD: f64 = 1e-6;

/// The plan line for shadow volumes, with the lowest and highest ground of this tile around each segment.
///
/// *Around* is the rectangle along the segment that reaches `margin_steps` beyond it on every side, so it holds
/// the segment's caps. The range is that of the TIN there, never too narrow. Segments without ground that
/// near are dropped, which splits the line. Clip `line` to the tile and its margin first
/// ([`clip_closed`](crate::clip_closed)).
///
/// Source: Sutherland & Hodgman 1974, *Reentrant Polygon Clipping*, for the polygons; the height range per
/// segment in place of the tile's is ours (Vaaraniemi, Treib & Westermann 2011, section 5, take the tile's).
#[must_use]
pub fn extrude(line: &Polyline, surface: &Surface, margin_steps: i64) -> Vec<SvLine> {
    let mut lines = Vec::new();
    let mut current = SvLine { points: Vec::new(), ground_range_m: Vec::new() };
    for pair in line.points().windows(2) {
        if let Some(range_m) = ground_range_m([pair[0], pair[1]], surface, margin_steps) {
            if current.points.is_empty() {
                current.points.push(pair[0]);
            }
            current.points.push(pair[1]);
            current.ground_range_m.push(range_m);
        } else if !current.points.is_empty() {
            lines.push(std::mem::replace(
                &mut current,
                SvLine { points: Vec::new(), ground_range_m: Vec::new() },
            ));
        }
    }
    if !current.points.is_empty() {
        lines.push(current);
    }
    lines
}

/// Lowest and highest ground around one segment; `None` without ground there.
fn ground_range_m(
    [p, q]: [LatticePoint; 2],
    surface: &Surface,
    margin_steps: i64,
) -> Option<[f64; 2]> {
    // One step more than asked: rounding to f64 must not lose ground at the rim.
    let margin = margin_steps.max(0) + 1;
    // A corner of the rectangle is √2 margins from its end.
    let around = LatticeBounds::of(&[p, q])?.expanded(margin + margin / 2 + 1);
    let length = p.distance_steps(q);
    let (east, north) = ((q.u - p.u) as f64 / length, (q.v - p.v) as f64 / length);
    let margin = margin as f64;
    let (mut lowest_m, mut highest_m) = (f64::INFINITY, f64::NEG_INFINITY);
    surface.visit_triangles_near(around, |triangle| {
        let vertices = surface.triangles()[triangle as usize];
        let heights_m = vertices.map(|vertex| surface.heights_m()[vertex as usize]);
        if heights_m.iter().all(|height_m| (lowest_m..=highest_m).contains(height_m)) {
            return;
        }
        let mut k = 0;
        let corners = vertices.map(|vertex| {
            let point = surface.points()[vertex as usize];
            let (du, dv) = ((point.u - p.u) as f64, (point.v - p.v) as f64);
            k += 1;
            [du * east + dv * north, dv * east - du * north, heights_m[k - 1]]
        });
        // Most triangles lie wholly inside, or wholly beyond one side.
        let range = |axis: usize| {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let ([along_min, along_max], [across_min, across_max]) = (range(0), range(1));
        let (last, first) = (length + margin, -margin);
        if along_max < first || along_min > last || across_max < -margin || across_min > margin {
            return;
        }
        let mut polygon = Polygon::of(corners);
        if along_min < first || along_max > last {
            polygon = polygon.cut(|[along, ..]| along - first).cut(|[along, ..]| last - along);
        }
        if across_min < -margin || across_max > margin {
            polygon =
                polygon.cut(|[_, across, _]| across + margin).cut(|[_, across, _]| margin - across);
        }
        for &[.., height_m] in polygon.corners() {
            lowest_m = lowest_m.min(height_m);
            highest_m = highest_m.max(height_m);
        }
    });
    let pad_m = PAD * lowest_m.abs().max(highest_m.abs()).max(highest_m - lowest_m);
    (lowest_m <= highest_m).then_some([lowest_m - pad_m, highest_m + pad_m])
}

/// A convex polygon of a triangle cut by up to four lines: at most seven corners, in place.
/// A corner is [along, across, height].
#[derive(Clone, Copy)]
struct Polygon {
    corners: [[f64; 3]; 8],
    count: usize,
}

impl Polygon {
    fn of([a, b, c]: [[f64; 3]; 3]) -> Self {
        let mut corners = [[0.0; 3]; 8];
        corners[..3].copy_from_slice(&[a, b, c]);
        Self { corners, count: 3 }
    }

    fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    /// What lies where `inside`, an affine function, is at least 0.
    fn cut(&self, inside: impl Fn([f64; 3]) -> f64) -> Self {
        let mut kept = Self { corners: [[0.0; 3]; 8], count: 0 };
        for (k, &this) in self.corners().iter().enumerate() {
            let next = self.corners[(k + 1) % self.count];
            let (here, there) = (inside(this), inside(next));
            if here >= 0.0 {
                kept.push(this);
            }
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let part = here / (here - there);
                kept.push([0, 1, 2].map(|axis| this[axis] + part * (next[axis] - this[axis])));
            }
        }
        kept
    }

    /// Rounding can make a polygon so thin that it is cut once too often; its corners then lie on one
    /// another, and the last may be left out.
    fn push(&mut self, corner: [f64; 3]) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

#[cfg(test)]
#[path = "extrude_tests.rs"]
mod tests;
