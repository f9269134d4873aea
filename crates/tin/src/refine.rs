//! Greedy insertion: the node farthest from the TIN becomes a vertex, until none is too far.

use spade::handles::FixedVertexHandle;
use spade::{HasPosition, InsertionError, Point2, Triangulation};

use crate::TinVertex;
use crate::candidate_queue::{Candidate, CandidateQueue};
use crate::tile_raster::TileRaster;
use crate::triangle_rows::for_each_row;

/// A vertex of the mesh. To it, x is the column and y the row, which grows to the south.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) column: u16,
    pub(crate) row: u16,
    height_q: i32,
}

impl Node {
    pub(crate) fn new(tile: &TileRaster<'_>, [column, row]: [usize; 2]) -> Self {
        Self { column: column as u16, row: row as u16, height_q: tile.height_q([column, row]) }
    }

    pub(crate) fn to_vertex(self) -> TinVertex {
        TinVertex { row: self.row, column: self.column, height_q: self.height_q }
    }
}

impl HasPosition for Node {
    type Scalar = f64;

    #[inline]
    fn position(&self) -> Point2<f64> {
        Point2::new(f64::from(self.column), f64::from(self.row))
    }
}

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
    let scan = Scan { heights_m: &tile.inner_heights_m(), columns, max_error_m, quantum_m };
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

/// What a face is scanned against.
struct Scan<'a> {
    /// NaN where no vertex is allowed: comparisons with NaN are false.
    heights_m: &'a [f32],
    columns: usize,
    max_error_m: f64,
    quantum_m: f64,
}

impl Scan<'_> {
    /// The node farthest from the plane through `corners` and its error in metres, if that is more than allowed.
    /// Of equals the first.
    fn worst_node(&self, corners: [Node; 3]) -> Option<(f64, u32)> {
        let at = corners.map(|node| [i64::from(node.column), i64::from(node.row)]);
        let [a, b, c] = at;
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let double_area = ab[0] * ac[1] - ab[1] * ac[0];
        // Pick's theorem: 2 · area = 2 · nodes inside + nodes on the boundary − 2. At 1 there are but three.
        if double_area.abs() <= 1 {
            return None;
        }
        let [a_m, b_m, c_m] = corners.map(|node| f64::from(node.height_q) * self.quantum_m);
        // Everything is multiplied by twice the area: heights have few binary digits and areas are integers, so every
        // product and sum below is exact, and a node exactly at the tolerance is left out on every machine.
        let scale = double_area as f64;
        let (ab_m, ac_m) = (b_m - a_m, c_m - a_m);
        let per_column = ab_m * ac[1] as f64 - ac_m * ab[1] as f64;
        let per_row = ac_m * ab[0] as f64 - ab_m * ac[0] as f64;
        let mut worst_scaled = self.max_error_m * scale.abs();
        let mut worst = usize::MAX;
        for_each_row(at, i64::MIN..=i64::MAX, |row, first, last| {
            if last < first {
                return;
            }
            let start = row as usize * self.columns + first as usize;
            let in_row =
                a_m * scale + per_row * (row - a[1]) as f64 + per_column * (first - a[0]) as f64;
            let heights_m = &self.heights_m[start..=start + (last - first) as usize];
            for (step, &height_m) in heights_m.iter().enumerate() {
                let scaled =
                    (f64::from(height_m) * scale - (in_row + per_column * step as f64)).abs();
                if scaled > worst_scaled {
                    worst_scaled = scaled;
                    worst = start + step;
                }
            }
        });
        (worst != usize::MAX).then(|| (worst_scaled / scale.abs(), worst as u32))
    }
}
