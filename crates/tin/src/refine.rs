//! Greedy insertion: nodes far from the TIN become vertices, until none is too far.

use spade::handles::FixedVertexHandle;
use spade::{InsertionError, Triangulation};

use crate::bands::{Bands, Candidate};
use crate::face_scan::FaceScan;
use crate::node::Node;
use crate::tile_raster::TileRaster;

/// Inserts nodes of `tile` into `mesh` until none inside its ground is farther than `max_error_m` from it. Returns the vertices of
/// each face, by its index.
///
/// The mesh holds border and boundaries, which insertion never touches. After an insertion, the changed faces
/// are those around the new vertex, its star: in a (constrained) Delaunay triangulation every edge that
/// flips comes to end there. Only they are scanned again. What lies in the band at work is inserted at once, the newest first: it is the
/// nearest.
pub(crate) fn refine<T>(
    mesh: &mut T,
    tile: &TileRaster<'_>,
    max_error_m: f64,
    quantum_m: f64,
) -> Result<Vec<[u32; 3]>, InsertionError>
where
    T: Triangulation<Vertex = Node>,
{
    let columns = tile.columns();
    let scan = FaceScan::new(tile, max_error_m, quantum_m);
    let mut bands = Bands::new(max_error_m);
    // The first vertex of a face is its apex: the one whose insertion made the face, or any corner at the start. A face that is
    // made again has another apex, so this shows which candidates are outdated.
    let mut faces = vec![[0_u32; 3]; mesh.num_all_faces()];
    let is_fresh = |faces: &[[u32; 3]], candidate: &Candidate| {
        faces[candidate.face as usize][0] == candidate.apex
    };
    for face in mesh.inner_faces() {
        let corners = face.vertices();
        let star = StarFace {
            face: face.index() as u32,
            vertices: corners.map(|corner| corner.index() as u32),
            corners: corners.map(|corner| *corner.data()),
        };
        faces[face.index()] = star.vertices;
        if let Some((error_m, candidate)) = star.candidate(&scan, columns) {
            bands.push(error_m, candidate);
        }
    }
    let mut star: Vec<StarFace> = Vec::new();
    let mut newest = Vec::new();
    while let Some(candidates) = bands.next(|candidate| is_fresh(&faces, candidate)) {
        for candidate in candidates {
            newest.push(candidate);
            while let Some(candidate) = newest.pop() {
                if !is_fresh(&faces, &candidate) {
                    continue;
                }
                let index = candidate.node as usize;
                let node = Node::new(tile, [index % columns, index / columns]);
                let hint = FixedVertexHandle::from_index(candidate.hint as usize);
                let vertex = mesh.insert_with_hint(node, hint)?;

                let apex = vertex.index() as u32;
                faces.resize(mesh.num_all_faces(), [0; 3]);
                star.clear();
                star.extend(mesh.vertex(vertex).out_edges().map(|edge| {
                    let to = edge.to();
                    StarFace {
                        face: edge.face().index() as u32,
                        vertices: [apex, to.index() as u32, 0],
                        corners: [node, *to.data(), node],
                    }
                }));
                for k in 0..star.len() {
                    // Edges come counter-clockwise, each with the face to its left.
                    let next = *star.get(k + 1).unwrap_or(&star[0]);
                    let face = &mut star[k];
                    (face.vertices[2], face.corners[2]) = (next.vertices[1], next.corners[1]);
                    faces[face.face as usize] = face.vertices;
                    let found = face.candidate(&scan, columns);
                    newest.extend(found.and_then(|(error_m, found)| bands.push(error_m, found)));
                }
            }
        }
    }
    Ok(faces)
}

/// A face and its corners, the apex first.
#[derive(Debug, Clone, Copy)]
struct StarFace {
    face: u32,
    vertices: [u32; 3],
    corners: [Node; 3],
}

/// Nodes on a side of a place.
const PLACE_NODES: usize = 16;

impl StarFace {
    /// The farthest node and its error, metres, if that is more than allowed.
    fn candidate(&self, scan: &FaceScan, columns: usize) -> Option<(f64, Candidate)> {
        let (error_m, node) = scan.worst_node(self.corners)?;
        let at = [node as usize % columns, node as usize / columns];
        let [a, b, c] = self.corners.map(|corner| corner.squared_distance(at));
        // The nearest corner is where a search for the node ends soonest.
        let nearest = if a <= b && a <= c { 0 } else { 1 + usize::from(c < b) };
        let places = columns.div_ceil(PLACE_NODES);
        let place = at[1] / PLACE_NODES * places + at[0] / PLACE_NODES;
        let [apex, ..] = self.vertices;
        let hint = self.vertices[nearest];
        Some((error_m, Candidate { place: place as u32, node, face: self.face, apex, hint }))
    }
}
