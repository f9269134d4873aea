//! Converts the faces of a mesh to a TIN.

use crate::half_edges::HalfEdges;
use crate::tile_raster::TileRaster;
use crate::{Tin, TinError, TinVertex};

/// A value below any accepted height.
const NO_VERTEX: i32 = i32::MIN;

/// Returns all faces of `mesh` as a TIN in canonical order.
pub(crate) fn to_tin(mesh: &HalfEdges, tile: &TileRaster<'_>) -> Result<Tin, TinError> {
    let columns = tile.columns();
    let index = |corner: TinVertex| usize::from(corner.row) * columns + usize::from(corner.column);
    // A raster finds and sorts vertices at once: it first holds their heights, then their indices.
    let mut raster = vec![NO_VERTEX; columns * tile.rows()];
    for corner in mesh.faces().iter().flat_map(|face| face.corners) {
        raster[index(corner)] = corner.height_q;
    }
    let mut vertices = Vec::with_capacity(mesh.faces().len() / 2 + 2);
    for (row, slots) in raster.chunks_exact_mut(columns).enumerate() {
        for (column, slot) in slots.iter_mut().enumerate() {
            if *slot != NO_VERTEX {
                let vertex = vertices.len() as i32;
                vertices.push(TinVertex {
                    row: row as u16,
                    column: column as u16,
                    height_q: *slot,
                });
                *slot = vertex;
            }
        }
    }
    let triangles = mesh
        .faces()
        .iter()
        .map(|face| {
            // Rows count to the south: counter-clockwise in the mesh is clockwise seen from above.
            let [a, c, b] = face.corners;
            [a, b, c].map(|corner| raster[index(corner)] as u32)
        })
        .collect();
    Tin::with_vertices_in_order(vertices, triangles)
}
