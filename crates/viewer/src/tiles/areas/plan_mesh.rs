//! Triangulates the inside of rings in plan.

use corniche_geom::LatticePoint;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// The inside of some rings, as triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PlanMesh {
    /// All points of the rings, each once.
    pub(crate) points: Vec<LatticePoint>,
    /// Indices of `points`, counter-clockwise. Every point of the rings is a corner of each
    /// triangle that touches it.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The edges of triangles without inside beyond them. The inside is on the left.
    pub(crate) edges: Vec<[u32; 2]>,
}

impl PlanMesh {
    /// Triangulates the inside of `rings` by the even-odd rule: a constrained Delaunay
    /// triangulation, without additional points. Coordinates relative to `origin` must be below
    /// 2^53. `None` if rings cross.
    pub(crate) fn inside(rings: &[Vec<LatticePoint>], origin: LatticePoint) -> Option<Self> {
        let mut points: Vec<LatticePoint> = rings.iter().flatten().copied().collect();
        points.sort_unstable();
        points.dedup();
        let vertices = points
            .iter()
            .map(|point| Point2::new((point.u - origin.u) as f64, (point.v - origin.v) as f64));
        let mut has_crossing = false;
        // Decoders limit the number of points to less than 2^32.
        let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
            vertices.collect(),
            odd_segments(rings, &points),
            |_| has_crossing = true,
        );
        // Whole numbers below 2^53 are always valid coordinates.
        let triangulation = triangulation.ok().filter(|_| !has_crossing)?;
        let is_inside = faces_inside(&triangulation);
        let mut mesh = Self { points, ..Self::default() };
        for face in triangulation.inner_faces().filter(|face| is_inside[face.fix().index()]) {
            mesh.triangles.push(face.vertices().map(|vertex| vertex.fix().index() as u32));
            for edge in face.adjacent_edges() {
                if !is_inside[edge.rev().face().fix().index()] {
                    let ends = [edge.from(), edge.to()];
                    mesh.edges.push(ends.map(|vertex| vertex.fix().index() as u32));
                }
            }
        }
        Some(mesh)
    }
}

/// The segments of rings by the indices of their ends in `points`, without segments that occur an
/// even number of times: these have the same side on both sides.
fn odd_segments(rings: &[Vec<LatticePoint>], points: &[LatticePoint]) -> Vec<[usize; 2]> {
    // Every point of a ring is among the points.
    let index_of = |point: &LatticePoint| points.partition_point(|other| other < point);
    let mut segments: Vec<[usize; 2]> = rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)))
        .map(|(from, to)| [index_of(from), index_of(to)])
        .map(|[from, to]| [from.min(to), from.max(to)])
        .filter(|[from, to]| from != to)
        .collect();
    segments.sort_unstable();
    let runs = segments.chunk_by(|a, b| a == b);
    runs.filter(|run| run.len() % 2 == 1).map(|run| run[0]).collect()
}

/// For each face, whether it is inside: a path from outside has crossed an odd number of
/// constraints.
fn faces_inside(triangulation: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<bool> {
    let mut is_inside: Vec<Option<bool>> = vec![None; triangulation.num_all_faces()];
    let outer = triangulation.outer_face().fix().index();
    is_inside[outer] = Some(false);
    let mut next = Vec::new();
    for edge in triangulation.directed_edges().filter(|edge| edge.face().is_outer()) {
        next.push((edge.rev(), false));
    }
    // Each entry is an edge of a face that may be new, and whether the face beyond it is inside.
    while let Some((edge, is_beyond_inside)) = next.pop() {
        let face = edge.face().fix().index();
        if is_inside[face].is_some() {
            continue;
        }
        let here = is_beyond_inside != edge.is_constraint_edge();
        is_inside[face] = Some(here);
        next.extend([edge.next(), edge.prev()].map(|side| (side.rev(), here)));
    }
    is_inside.into_iter().map(Option::unwrap_or_default).collect()
}
