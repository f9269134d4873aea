//! Greedy insertion: the node farthest from the TIN becomes a vertex, until none is too far.

use std::collections::BinaryHeap;

use spade::handles::FixedVertexHandle;
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
    /// The face's apex when it was scanned: the candidate is stale when the face has been made anew since.
    apex: u32,
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
    // The corner a face was made with: the vertex inserted then, or at first any. A face made anew has another
    // one, so this is at once the counter that tells stale candidates and the hint where to insert.
    let mut apexes = vec![0_u32; mesh.num_all_faces()];
    let mut first = Vec::new();
    for face in mesh.inner_faces() {
        let corners = face.vertices();
        let (face, apex) = (face.index(), corners[0].index() as u32);
        apexes[face] = apex;
        let rank = scan.worst_node(corners.map(|vertex| *vertex.data()));
        first.extend(rank.map(|rank| Candidate { rank, face: face as u32, apex }));
    }
    let mut candidates = BinaryHeap::from(first);
    let mut star = Vec::new();
    while let Some(candidate) = candidates.pop() {
        if apexes[candidate.face as usize] != candidate.apex {
            continue;
        }
        let index = candidate.node();
        let node = Node::new(tile, [index % columns, index / columns]);
        let vertex =
            mesh.insert_with_hint(node, FixedVertexHandle::from_index(candidate.apex as usize))?;

        let apex = vertex.index() as u32;
        apexes.resize(mesh.num_all_faces(), 0);
        star.clear();
        star.extend(
            mesh.vertex(vertex).out_edges().map(|edge| (edge.face().index(), *edge.to().data())),
        );
        for (k, &(face, corner)) in star.iter().enumerate() {
            // Edges come counter-clockwise, each with the face to its left.
            let next = star[(k + 1) % star.len()].1;
            apexes[face] = apex;
            let rank = scan.worst_node([node, corner, next]);
            let face = face as u32;
            candidates.extend(rank.map(|rank| Candidate { rank, face, apex }));
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
        // All times the double area: heights are few binary digits each and areas are integers, so every
        // product and sum below is exact, and a node exactly at the tolerance stays out on every machine.
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
        let worst_m = worst_scaled / scale.abs();
        let bits = u64::from((worst_m as f32).to_bits());
        (worst != usize::MAX).then(|| bits << 32 | u64::from(!(worst as u32)))
    }
}
