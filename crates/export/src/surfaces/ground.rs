//! A tile's ground, and slabs above it, as triangles with labels, in plan on the lattice.

use std::collections::HashMap;

use corniche_geom::{LatticeBounds, LatticePoint};

use crate::plane::steps_between;

/// A vertex of the ground.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceVertex {
    /// Lattice steps relative to the middle of the tile.
    pub(crate) at: [f64; 2],
    /// Height in the package's datum.
    pub(crate) height_m: f64,
    /// Unit normal: east, north, up along the axes of the package's CRS.
    pub(crate) normal: [f32; 3],
    /// Whether it belongs to a slab, rather than to the ground.
    pub(crate) on_slab: bool,
}

/// Triangles with labels.
pub(crate) struct LabelledMesh {
    /// The origin of positions.
    pub(crate) middle: LatticePoint,
    pub(crate) vertices: Vec<SurfaceVertex>,
    /// Counter-clockwise from above.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The label of each triangle: 0 is ground, others are roads and slabs.
    pub(crate) labels: Vec<u32>,
}

impl LabelledMesh {
    pub(crate) fn new(middle: LatticePoint) -> Self {
        Self { middle, vertices: Vec::new(), triangles: Vec::new(), labels: Vec::new() }
    }

    /// Returns a lattice point relative to the middle of the tile.
    pub(crate) fn seen_from_middle(&self, point: LatticePoint) -> [f64; 2] {
        steps_between(self.middle, point)
    }

    /// Returns a vertex's place on the lattice.
    pub(crate) fn on_lattice(&self, vertex: &SurfaceVertex) -> [f64; 2] {
        on_lattice(self.middle, vertex.at)
    }

    pub(crate) fn add(&mut self, triangle: [u32; 3], label: u32) {
        self.triangles.push(triangle);
        self.labels.push(label);
    }

    pub(crate) fn centroid(&self, triangle: [u32; 3]) -> [f64; 2] {
        let corners = triangle.map(|vertex| self.vertices[vertex as usize].at);
        [0, 1].map(|axis| (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3.0)
    }

    /// Removes vertices that no triangle uses.
    pub(crate) fn drop_unused(&mut self) {
        let kept = by_first_use(&mut self.triangles, self.vertices.len());
        self.vertices = kept.into_iter().map(|old| self.vertices[old as usize]).collect();
    }

    /// Divides triangle edges in the middle until none is too long; `is_long` receives an edge's
    /// extent east and north, in steps.
    ///
    /// The rule depends on the edge alone, so triangles on both sides, and tiles on both sides of a
    /// border, divide it in the same way.
    pub(crate) fn split_long_edges(&mut self, is_long: impl Fn([f64; 2]) -> bool) {
        loop {
            let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
            let (mut triangles, mut labels) = (Vec::new(), Vec::new());
            let old = std::mem::take(&mut self.triangles);
            for (triangle, label) in old.into_iter().zip(std::mem::take(&mut self.labels)) {
                let middle = [0, 1, 2].map(|k| {
                    let (one, other) = (triangle[k], triangle[(k + 1) % 3]);
                    let [from, to] = [one, other].map(|vertex| self.vertices[vertex as usize].at);
                    is_long([to[0] - from[0], to[1] - from[1]]).then(|| {
                        let ends = [one.min(other), one.max(other)];
                        *middles.entry(ends).or_insert_with(|| {
                            let [one, other] = ends.map(|vertex| self.vertices[vertex as usize]);
                            self.vertices.push(SurfaceVertex::between(&one, &other));
                            (self.vertices.len() - 1) as u32
                        })
                    })
                });
                let parts = divided(triangle, middle);
                labels.extend(std::iter::repeat_n(label, parts.len()));
                triangles.extend(parts);
            }
            (self.triangles, self.labels) = (triangles, labels);
            if middles.is_empty() {
                return;
            }
        }
    }
}

/// Renumbers the vertices of triangles by first use. Returns the old number of each.
pub(crate) fn by_first_use(triangles: &mut [[u32; 3]], vertices: usize) -> Vec<u32> {
    let mut number = vec![u32::MAX; vertices];
    let mut order = Vec::with_capacity(vertices);
    for corner in triangles.as_flattened_mut() {
        let place = &mut number[*corner as usize];
        if *place == u32::MAX {
            *place = order.len() as u32;
            order.push(*corner);
        }
        *corner = *place;
    }
    order
}

/// Returns the place on the lattice for one relative to `middle`.
pub(crate) fn on_lattice(middle: LatticePoint, at: [f64; 2]) -> [f64; 2] {
    [at[0] + middle.u as f64, at[1] + middle.v as f64]
}

impl SurfaceVertex {
    /// Returns the vertex halfway between two others: the same whichever comes first.
    fn between(one: &Self, other: &Self) -> Self {
        let middle = f64::midpoint;
        let normal = [0, 1, 2].map(|axis| one.normal[axis] + other.normal[axis]);
        Self {
            at: [middle(one.at[0], other.at[0]), middle(one.at[1], other.at[1])],
            height_m: middle(one.height_m, other.height_m),
            normal: unit(normal),
            on_slab: one.on_slab,
        }
    }
}

/// Returns a place on the lattice as shares of the way across a tile, from the west and from the
/// north.
pub(crate) fn across([u, v]: [f64; 2], tile: &LatticeBounds) -> [f32; 2] {
    let share = |here: f64, from: i64, to: i64| ((here - from as f64) / (to - from) as f64) as f32;
    [share(u, tile.min.u, tile.max.u), 1.0 - share(v, tile.min.v, tile.max.v)]
}

/// Returns a vector of length one; upwards if there is no direction, for example halfway between
/// two opposite ones.
pub(crate) fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = vector.iter().map(|axis| axis * axis).sum::<f32>().sqrt();
    if length > 0.0 { vector.map(|axis| axis / length) } else { [0.0, 0.0, 1.0] }
}

/// Divides a triangle whose edges (from corner k to the next) have a middle.
fn divided([a, b, c]: [u32; 3], middles: [Option<u32>; 3]) -> Vec<[u32; 3]> {
    match middles {
        [None, None, None] => vec![[a, b, c]],
        [Some(m), None, None] => vec![[a, m, c], [m, b, c]],
        [None, Some(m), None] => vec![[b, m, a], [m, c, a]],
        [None, None, Some(m)] => vec![[c, m, b], [m, a, b]],
        [Some(m), Some(n), None] => vec![[m, b, n], [a, m, n], [a, n, c]],
        [None, Some(m), Some(n)] => vec![[m, c, n], [b, m, n], [b, n, a]],
        [Some(n), None, Some(m)] => vec![[m, a, n], [c, m, n], [c, n, b]],
        [Some(m), Some(n), Some(o)] => vec![[a, m, o], [m, b, n], [o, n, c], [m, n, o]],
    }
}

#[cfg(test)]
#[path = "ground_tests.rs"]
mod tests;
