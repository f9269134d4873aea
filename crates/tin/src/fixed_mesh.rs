//! The mesh before the first insertion: border and boundaries, triangulated by spade and converted.

use spade::{
    ConstrainedDelaunayTriangulation, DelaunayTriangulation, InsertionError, Triangulation,
};

use crate::boundary::BorderStretch;
use crate::half_edges::{Face, HalfEdges, NO_TWIN};
use crate::node::GridNode;
use crate::tile_raster::TileRaster;

/// Returns the (constrained) Delaunay triangulation of the vertices of `fixed`, as far as it is
/// ground.
pub(crate) fn fixed_mesh(
    tile: &TileRaster<'_>,
    fixed: &[BorderStretch],
) -> Result<HalfEdges, InsertionError> {
    let (nodes, edges) = fixed_graph(fixed);
    let ground_everywhere = tile.count_ground_cells() == (tile.columns() - 1) * (tile.rows() - 1);
    if ground_everywhere {
        // The convex hull is the border of the tile, so no constraint is needed.
        Ok(carried_over(&DelaunayTriangulation::<GridNode>::bulk_load(nodes)?, tile))
    } else {
        Ok(carried_over(
            &ConstrainedDelaunayTriangulation::<GridNode>::bulk_load_cdt(nodes, edges)?,
            tile,
        ))
    }
}

/// Returns the vertices of all stretches, each of them once, sorted by row and column, and the
/// edges between them.
fn fixed_graph(fixed: &[BorderStretch]) -> (Vec<GridNode>, Vec<[usize; 2]>) {
    let mut keys: Vec<[usize; 2]> =
        fixed.iter().flatten().map(|&[column, row]| [row, column]).collect();
    keys.sort_unstable();
    keys.dedup();
    let index = |[column, row]: [usize; 2]| keys.partition_point(|&key| key < [row, column]);
    let edges = fixed
        .iter()
        .flat_map(|stretch| stretch.windows(2).map(|pair| [index(pair[0]), index(pair[1])]));
    let edges = edges.collect();
    (keys.iter().map(|&[row, column]| GridNode::new(column as u16, row as u16)).collect(), edges)
}

/// Returns the faces of `mesh` on the ground of `tile`.
fn carried_over<T>(mesh: &T, tile: &TileRaster<'_>) -> HalfEdges
where
    T: Triangulation<Vertex = GridNode>,
{
    let mut faces = Vec::with_capacity(mesh.num_inner_faces());
    // The number of each directed edge of the other mesh in this mesh.
    let mut half_edges = vec![NO_TWIN; mesh.num_directed_edges()];
    for face in mesh.inner_faces() {
        let edges = face.adjacent_edges();
        let corners = edges.map(|edge| *edge.from().data());
        // Boundaries are edges, so a face is completely ground or completely void, and so is every
        // cell that its interior meets: the cell at its centroid decides, exactly, even if the
        // centroid is on a cell's edge.
        let (column, row) = corners.iter().fold((0, 0), |(column, row), corner| {
            (column + usize::from(corner.column()), row + usize::from(corner.row()))
        });
        if tile.cell([column / 3, row / 3]) {
            for (place, edge) in (0..).zip(edges) {
                half_edges[edge.fix().index()] = 4 * faces.len() as u32 + place;
            }
            let corners = corners.map(|corner| tile.vertex([corner.column(), corner.row()]));
            faces.push(Face::new(corners, [NO_TWIN; 3]));
        }
    }
    for edge in mesh.directed_edges() {
        let half_edge = half_edges[edge.fix().index()];
        if half_edge != NO_TWIN {
            let twin = &mut faces[half_edge as usize / 4].twins[half_edge as usize % 4];
            *twin = half_edges[edge.rev().fix().index()];
        }
    }
    HalfEdges::new(faces, tile.columns().max(tile.rows()))
}
