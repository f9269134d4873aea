//! The mesh of a tile's ground, with skirts and with walls along voids.

use bytemuck::{Pod, Zeroable};
use corniche_geom::{GridFrame, StepBudget, TILE_CELLS, TileId};
use corniche_tin::{Tin, decode_normal};
use serde::{Deserialize, Serialize};

use super::{blocks, triangle_grid::TriangleGrid};

/// A vertex of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct GroundVertex {
    /// Metres from the tile's reference point; z is true height, before exaggeration.
    pub(crate) position_in_tile: [f32; 3],
    /// Unit normal (east, north, up) in steps of 1/127; then 127 at the lower edge of a skirt,
    /// otherwise 0.
    pub(crate) normal_skirt: [i8; 4],
}

/// Triangles of a tile's ground, then of its skirts, then below edges of voids.
///
/// A skirt hangs from every edge on the tile's border. Its lower vertices have the position and
/// normal of the upper ones and a flag; the vertex shader lowers them as far as the drawn
/// neighbours require. Edges of the ground inside the tile get the same curtain, as a wall: no
/// crack is there, but the data ends.
///
/// Look-ups use a grid that is built from the triangles: a mesh must not be changed after its
/// creation.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct GroundMesh {
    /// Vertices of the TIN in its order, then the lower vertices of the skirts.
    #[serde(with = "blocks::plain")]
    pub(crate) vertices: Vec<GroundVertex>,
    /// Three indices per triangle; the ground first.
    #[serde(with = "blocks::plain")]
    pub(crate) indices: Vec<u32>,
    /// Number of indices of the ground.
    pub(crate) surface_indices: usize,
    /// Number of indices of the ground and the skirts.
    pub(crate) skirt_indices: usize,
    pub(crate) triangle_grid: TriangleGrid,
}

impl GroundMesh {
    /// Places `tin`, whose vertices have these octahedron-coded normals, relative to `reference_m`.
    pub(crate) fn new(
        id: TileId,
        tin: &Tin,
        normals: &[[i8; 2]],
        frame: &GridFrame,
        quantum_m: f64,
        reference_m: [f64; 3],
    ) -> Self {
        let window = frame.tile_window(id);
        let place = |(vertex, normal): (&corniche_tin::TinVertex, &[i8; 2])| {
            let node = window.node(usize::from(vertex.column), usize::from(vertex.row));
            let position_m =
                [frame.x_m(node.i), frame.y_m(node.j), f64::from(vertex.height_q) * quantum_m];
            let [x, y, z] = decode_normal(*normal).map(|part| (part * 127.0).round() as i8);
            GroundVertex {
                position_in_tile: relative(position_m, reference_m),
                normal_skirt: [x, y, z, 0],
            }
        };
        let vertices = tin.vertices().iter().zip(normals).map(place).collect();
        let mut mesh = Self::of_surface(vertices, tin.triangles().iter().flatten().copied());
        mesh.hang_where(tin, |from, to| on_border(tin, from, to));
        mesh.skirt_indices = mesh.indices.len();
        // Edges of the ground inside the tile belong to one triangle only: the neighbouring
        // triangle would have the same edge in the other direction.
        let mut all: Vec<(u32, u32)> = tin.triangles().iter().flat_map(sides).collect();
        all.sort_unstable();
        mesh.hang_where(tin, |from, to| {
            all.binary_search(&(to, from)).is_err() && !on_border(tin, from, to)
        });
        mesh
    }

    /// A mesh without skirts, from triangles with three indices each.
    pub(crate) fn of_surface(
        vertices: Vec<GroundVertex>,
        indices: impl Iterator<Item = u32>,
    ) -> Self {
        let indices: Vec<u32> = indices.collect();
        let corners_in_plan = indices.as_chunks::<3>().0.iter().map(|corners| {
            corners.map(|index| {
                let [x, y, _] = vertices[index as usize].position_in_tile;
                [f64::from(x), f64::from(y)]
            })
        });
        let triangle_grid = TriangleGrid::new(corners_in_plan);
        let surface_indices = indices.len();
        let skirt_indices = surface_indices;
        Self { vertices, indices, surface_indices, skirt_indices, triangle_grid }
    }

    /// The corners of a triangle of the ground, relative to the tile's reference point; heights are
    /// true.
    pub(crate) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        let first = triangle as usize * 3;
        [0, 1, 2].map(|k| {
            let index = self.indices[first + k] as usize;
            self.vertices[index].position_in_tile.map(f64::from)
        })
    }

    /// Lowest and highest height of the triangles whose bounding boxes intersect a box in plan, all
    /// relative to the tile's reference point; `None` if there are no such triangles. Sixteen
    /// triangles count as one step of `work`, because checking a triangle is much cheaper than
    /// other steps.
    pub(crate) fn height_range_within(
        &self,
        low: [f64; 2],
        high: [f64; 2],
        work: &StepBudget,
    ) -> Option<[f64; 2]> {
        let mut range: Option<[f64; 2]> = None;
        for (number, triangle) in self.triangle_grid.within(low, high).enumerate() {
            work.add(usize::from(number % 16 == 0));
            let corners = self.corners(triangle);
            let meets = [0, 1].into_iter().all(|axis: usize| {
                let along = corners.map(|corner| corner[axis]);
                along.iter().any(|at| *at <= high[axis]) && along.iter().any(|at| *at >= low[axis])
            });
            if meets {
                let heights = corners.map(|corner| corner[2]).into_iter();
                let [lowest, highest] = range.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
                range =
                    Some([heights.clone().fold(lowest, f64::min), heights.fold(highest, f64::max)]);
            }
        }
        range
    }

    /// Adds curtains below some of the edges of triangles.
    fn hang_where(&mut self, tin: &Tin, is_edge: impl Fn(u32, u32) -> bool) {
        for (from, to) in tin.triangles().iter().flat_map(sides) {
            if is_edge(from, to) {
                self.hang(from, to);
            }
        }
    }

    /// Adds two triangles below the edge `from`–`to`.
    fn hang(&mut self, from: u32, to: u32) {
        let lower = self.vertices.len() as u32;
        for upper in [from, to] {
            let mut vertex = self.vertices[upper as usize];
            vertex.normal_skirt[3] = 127;
            self.vertices.push(vertex);
        }
        self.indices.extend([from, lower, to, to, lower, lower + 1]);
    }
}

/// The edges of a triangle.
fn sides(corners: &[u32; 3]) -> [(u32, u32); 3] {
    [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]))
}

/// Whether an edge is on one side of the tile.
fn on_border(tin: &Tin, from: u32, to: u32) -> bool {
    let last = TILE_CELLS as u16;
    let [a, b] = [from, to].map(|index| tin.vertices()[index as usize]);
    (a.row == b.row && (a.row == 0 || a.row == last))
        || (a.column == b.column && (a.column == 0 || a.column == last))
}

/// A position relative to a reference point: the difference in f64, then rounded. All f32 positions
/// are computed here, so that none loses precision.
pub(crate) fn relative(position_m: [f64; 3], reference_m: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|axis| (position_m[axis] - reference_m[axis]) as f32)
}

/// Does the same as [`relative`] for a position in plan.
pub(crate) fn relative_in_plan(at_m: [f64; 2], reference_m: [f64; 3]) -> [f32; 2] {
    [0, 1].map(|axis| (at_m[axis] - reference_m[axis]) as f32)
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these numbers are exact")]
#[path = "ground_mesh_tests.rs"]
mod tests;
