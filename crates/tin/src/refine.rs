//! Greedy insertion: the node farthest from the TIN becomes a vertex, until none is too far.

use spade::handles::FixedVertexHandle;
use spade::{InsertionError, Triangulation};

use crate::candidate_queue::{Candidate, CandidateQueue};
use crate::face_scan::FaceScan;
use crate::node::Node;
use crate::tile_raster::TileRaster;

/// Inserts nodes of `tile` into `mesh` until none inside its ground is farther than `max_error_m` from it.
///
/// The mesh holds border and boundaries, which insertion never touches. After an insertion, the changed faces
/// are those around the new vertex, its star: in a (constrained) Delaunay triangulation every edge that
/// flips comes to end there. Only they are scanned again.
pub(crate) fn refine<T>(
    mesh: &mut T,
    tile: &TileRaster<'_>,
    max_error_m: f64,
    quantum_m: f64,
) -> Result<(), InsertionError>
where
    T: Triangulation<Vertex = Node>,
{
    let columns = tile.columns();
    let scan = FaceScan::new(tile, max_error_m, quantum_m);
    // The apex of each face: the vertex whose insertion made the face, or any corner at the start. A face that is
    // made again has another apex, so this shows which candidates are outdated; it is also the hint where to insert.
    let mut apexes = vec![0_u32; mesh.num_all_faces()];
    let mut candidates = CandidateQueue::new();
    for face in mesh.inner_faces() {
        let corners = face.vertices();
        let (face, apex) = (face.index(), corners[0].index() as u32);
        apexes[face] = apex;
        if let Some((error_m, worst)) = scan.worst_node(corners.map(|vertex| *vertex.data())) {
            candidates.push(Candidate::new(error_m, worst, face as u32, apex));
        }
    }
    let mut star = Vec::new();
    while let Some(candidate) =
        candidates.pop(|candidate| apexes[candidate.face() as usize] == candidate.apex())
    {
        let index = candidate.node() as usize;
        let node = Node::new(tile, [index % columns, index / columns]);
        let vertex =
            mesh.insert_with_hint(node, FixedVertexHandle::from_index(candidate.apex() as usize))?;

        let apex = vertex.index() as u32;
        apexes.resize(mesh.num_all_faces(), 0);
        star.clear();
        star.extend(
            mesh.vertex(vertex).out_edges().map(|edge| (edge.face().index(), *edge.to().data())),
        );
        for (k, &(face, corner)) in star.iter().enumerate() {
            // Edges come counter-clockwise, each with the face to its left.
            let next = star.get(k + 1).unwrap_or(&star[0]).1;
            apexes[face] = apex;
            if let Some((error_m, worst)) = scan.worst_node([node, corner, next]) {
                candidates.push(Candidate::new(error_m, worst, face as u32, apex));
            }
        }
    }
    Ok(())
}
