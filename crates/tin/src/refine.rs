//! Greedy insertion: the node farthest from the TIN becomes a vertex, until no node is too far.

use crate::candidate_queue::{Candidate, CandidateQueue};
use crate::face_scan::FaceScan;
use crate::half_edges::HalfEdges;
use crate::tile_raster::TileRaster;

/// Inserts nodes of `tile` into `mesh` until no node inside its ground is farther than
/// `max_error_m` from it.
///
/// The mesh contains border and boundaries, which insertion never changes. After an insertion, the
/// changed faces are those around the new vertex, its star. Only these are scanned again, each of
/// them once. All of them are scanned before the first result is used, so that the mesh is borrowed
/// once.
pub(crate) fn refine(
    mesh: &mut HalfEdges,
    tile: &TileRaster<'_>,
    max_error_m: f64,
    quantum_m: f64,
) {
    let columns = tile.columns();
    let scan = FaceScan::new(tile, max_error_m, quantum_m);
    let mut candidates = CandidateQueue::new();
    loop {
        mesh.scan_star(|corners| scan.farthest_node(corners));
        for &face in mesh.star() {
            let far_m = mesh.faces()[face as usize].farthest.far_m;
            if far_m >= scan.beyond_m() {
                candidates.push(Candidate::new(far_m, face));
            }
        }
        // A face that was created again has another farthest node, or one at the same distance,
        // which is an equally good candidate.
        let farthest = |candidate: Candidate| mesh.faces()[candidate.face() as usize].farthest;
        let is_fresh = |candidate: Candidate| {
            farthest(candidate).far_m.to_bits() == candidate.far_m().to_bits()
        };
        let Some(candidate) = candidates.pop(is_fresh) else { return };
        let node = farthest(candidate).node as usize;
        let vertex = tile.vertex([(node % columns) as u16, (node / columns) as u16]);
        mesh.insert(candidate.face(), vertex);
    }
}
