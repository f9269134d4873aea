//! Greedy insertion: the node farthest from the TIN becomes a vertex, until none is too far.

use std::collections::BinaryHeap;

use spade::handles::{FixedFaceHandle, InnerTag};
use spade::{HasPosition, InsertionError, Point2, Triangulation};

use crate::TinVertex;
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

/// The node of a face that lies farthest from it. Candidates compare by error, then by node (of equals the
/// first is the greater), then by face: insertion takes the same way on every run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    /// The error's bits as f32 (which order like the number, as it is not negative), then the bits of the
    /// node's index, flipped.
    rank: u64,
    face: u32,
    /// Which insertion made the face: the candidate is stale when the face has been made anew since.
    made_by: u32,
}

impl Candidate {
    fn node(self) -> usize {
        !(self.rank as u32) as usize
    }
}

/// Inserts nodes of `tile` into `mesh` until none inside its ground is farther than `max_error_m` from it.
///
/// The mesh holds border and outlines, which insertion never touches. After an insertion, the changed faces
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
    let mut made_by = vec![0_u32; mesh.num_all_faces()];
    let mut first = Vec::new();
    for face in mesh.inner_faces() {
        let corners = face.vertices().map(|vertex| *vertex.data());
        let face = face.index() as u32;
        first.extend(scan.worst_node(corners).map(|rank| Candidate { rank, face, made_by: 0 }));
    }
    let mut candidates = BinaryHeap::from(first);
    let mut star = Vec::new();
    let mut insertion = 0;
    while let Some(candidate) = candidates.pop() {
        if made_by[candidate.face as usize] != candidate.made_by {
            continue;
        }
        let index = candidate.node();
        let node = Node::new(tile, [index % columns, index / columns]);
        let face = mesh.face(FixedFaceHandle::<InnerTag>::from_index(candidate.face as usize));
        // Any corner of the face will do as a hint; spade walks on to the nearest.
        let hint = face.adjacent_edge().from().fix();
        let vertex = mesh.insert_with_hint(node, hint)?;

        insertion += 1;
        made_by.resize(mesh.num_all_faces(), 0);
        star.clear();
        star.extend(mesh.vertex(vertex).out_edges().map(|edge| (edge.face().index(), *edge.to().data())));
        for (k, &(face, corner)) in star.iter().enumerate() {
            // Edges come counter-clockwise, each with the face to its left.
            let next = star[(k + 1) % star.len()].1;
            made_by[face] = insertion;
            let rank = scan.worst_node([node, corner, next]);
            let face = face as u32;
            candidates.extend(rank.map(|rank| Candidate { rank, face, made_by: insertion }));
        }
    }
    Ok(())
}

/// What a face is scanned against.
struct Scan<'a> {
    /// NaN where no vertex may be: comparing with it is never true.
    heights_m: &'a [f32],
    columns: usize,
    max_error_m: f64,
    quantum_m: f64,
}

impl Scan<'_> {
    /// The rank of the node farthest from the plane through `corners`, if it is farther than allowed.
    fn worst_node(&self, corners: [Node; 3]) -> Option<u64> {
        let at = corners.map(|node| [i64::from(node.column), i64::from(node.row)]);
        let [a, b, c] = at;
        let (ab, ac) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let double_area = ab[0] * ac[1] - ab[1] * ac[0];
        // Pick's theorem: 2 · area = 2 · nodes inside + nodes on the outline − 2. At 1 there are but three.
        if double_area.abs() <= 1 {
            return None;
        }
        let [a_m, b_m, c_m] = corners.map(|node| f64::from(node.height_q) * self.quantum_m);
        let (ab_m, ac_m) = (b_m - a_m, c_m - a_m);
        let scale = 1.0 / double_area as f64;
        let per_column_m = (ab_m * ac[1] as f64 - ac_m * ab[1] as f64) * scale;
        let per_row_m = (ac_m * ab[0] as f64 - ab_m * ac[0] as f64) * scale;
        let mut worst_m = self.max_error_m;
        let mut worst = usize::MAX;
        for_each_row(at, i64::MIN..=i64::MAX, |row, first, last| {
            if last < first {
                return;
            }
            let start = row as usize * self.columns + first as usize;
            let row_m = a_m + per_row_m * (row - a[1]) as f64 + per_column_m * (first - a[0]) as f64;
            let heights_m = &self.heights_m[start..=start + (last - first) as usize];
            for (step, &height_m) in heights_m.iter().enumerate() {
                let error_m = (f64::from(height_m) - (row_m + per_column_m * step as f64)).abs();
                if error_m > worst_m {
                    worst_m = error_m;
                    worst = start + step;
                }
            }
        });
        let bits = u64::from((worst_m as f32).to_bits());
        (worst != usize::MAX).then(|| bits << 32 | u64::from(!(worst as u32)))
    }
}
