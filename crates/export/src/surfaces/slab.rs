//! The slab of a bridge: the road on top, two sides, an underside and two ends. It is closed, and
//! its triangles are counter-clockwise from outside.
//!
//! ```text
//!    0 ────────── 1      Across the way the slab is a rectangle. Each of its edges goes along the way as a strip,
//!    │  ───►way   │      from the edge's first corner to its second one; adjacent strips
//!    3 ────────── 2      have the same corners. The edge 0–1 is the road.
//! ```

use super::{
    ground::{LabelledMesh, SurfaceVertex, unit},
    ribbon::{CenterLine, CrossSection},
    wide_line::wide_points,
};
use crate::globe::{between, cross};

/// The slab of a bridge.
pub(crate) struct Slab<'a> {
    pub(crate) center: &'a CenterLine,
    /// Heights of the deck at the points of the line.
    pub(crate) deck_m: &'a [f64],
    pub(crate) thickness_m: f64,
    /// Lattice steps per true metre.
    pub(crate) steps_per_m: f64,
}

/// The labels of a slab's triangles.
#[derive(Clone, Copy)]
pub(crate) struct SlabLabels {
    /// The road on top.
    pub(crate) road: u32,
    /// All other sides.
    pub(crate) others: u32,
}

/// Corners across the way.
const CORNERS: usize = 4;

impl Slab<'_> {
    /// Adds the slab to a mesh.
    pub(crate) fn add_to(&self, mesh: &mut LabelledMesh, labels: SlabLabels) {
        let kept = wide_points(&self.center.points, self.center.half_width);
        let points = kept.iter().map(|point| self.center.points[*point]).collect();
        let sections = CenterLine { points, ..self.center.clone() }.cross_sections();
        let ring = |section: &CrossSection| {
            let top_m = self.deck_m[kept[section.point]];
            self.ring(section.sides.map(|side| mesh.seen_from_middle(side)), top_m)
        };
        let rings: Vec<[Corner; CORNERS]> = sections.iter().map(ring).collect();
        let [Some(first), Some(last)] = [rings.first(), rings.last()] else { return };
        for from in 0..CORNERS {
            let to = (from + 1) % CORNERS;
            let label = if from == 0 { labels.road } else { labels.others };
            self.strip(rings.iter().map(|ring| [ring[from], ring[to]]), label, mesh);
        }
        let ends = [[first[0], first[3], first[2], first[1]], *last];
        for ([a, b, c, d], beyond) in ends.into_iter().zip(self.center.beyond) {
            // Where the bridge continues, the end of the slab would be visible as a line across the
            // road.
            let label = if beyond.is_some() { labels.road } else { labels.others };
            self.strip([[a, b], [d, c]].into_iter(), label, mesh);
        }
    }

    fn ring(&self, [left, right]: [[f64; 2]; 2], top_m: f64) -> [Corner; CORNERS] {
        let corner = |at, height_m| Corner { at, height_m };
        let bottom_m = top_m - self.thickness_m;
        [corner(left, top_m), corner(right, top_m), corner(right, bottom_m), corner(left, bottom_m)]
    }

    /// Adds triangles between pairs of corners. Each corner has the mean of the normals around it.
    fn strip(&self, pairs: impl Iterator<Item = [Corner; 2]>, label: u32, mesh: &mut LabelledMesh) {
        let corners: Vec<Corner> = pairs.flatten().collect();
        let first = mesh.vertices.len() as u32;
        let mut normals = vec![[0.0_f32; 3]; corners.len()];
        for pair in (0..corners.len().saturating_sub(2)).step_by(2) {
            for triangle in [[pair, pair + 1, pair + 3], [pair, pair + 3, pair + 2]] {
                let [a, b, c] = triangle.map(|corner| corners[corner]);
                // A bevel turns around one corner.
                if a.is_at(b) || b.is_at(c) || c.is_at(a) {
                    continue;
                }
                let around = normal([a, b, c].map(|corner| corner.place_m(self.steps_per_m)));
                for corner in triangle {
                    for (sum, axis) in normals[corner].iter_mut().zip(around) {
                        *sum += axis as f32;
                    }
                }
                mesh.add(triangle.map(|corner| first + corner as u32), label);
            }
        }
        let vertices = corners.into_iter().zip(normals);
        mesh.vertices.extend(vertices.map(|(Corner { at, height_m }, normal)| SurfaceVertex {
            at,
            height_m,
            normal: unit(normal),
            on_slab: true,
        }));
    }
}

/// A corner of a slab.
#[derive(Clone, Copy)]
struct Corner {
    at: [f64; 2],
    height_m: f64,
}

impl Corner {
    fn place_m(self, steps_per_m: f64) -> [f64; 3] {
        let [u, v] = self.at.map(|steps| steps / steps_per_m);
        [u, v, self.height_m]
    }

    fn is_at(self, other: Self) -> bool {
        let bits = |corner: Self| [corner.at[0], corner.at[1], corner.height_m].map(f64::to_bits);
        bits(self) == bits(other)
    }
}

/// The normal of a triangle; its length is twice the triangle's area.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(between(a, b), between(a, c))
}

#[cfg(test)]
#[path = "slab_tests.rs"]
mod tests;
