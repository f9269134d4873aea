//! Roads cut into the triangles of a tile: the same surface, divided along the outlines of roads.
//!
//! ```text
//!   triangles that no outline comes near ───────────────────────────────► unchanged
//!   the others ──► constrained triangulation of their edges ──► outlines added, edges divided where they cross ──► new triangles
//! ```
//!
//! New vertices lie on the plane of the triangle that they divide, so the surface stays the same, and so does what depth tests see of it. Points
//! on the tile's border follow from the outlines alone ([`plan_cut`](super::plan_cut)): the tile beyond has the same.
//!
//! All points lie on the lattice, where the predicates of the triangulation are exact. Where lines cross, the point is rounded to the lattice and both
//! lines go through it: they move by less than a step, half a millimetre, and go on as long as they cross others.
//!
//! Sources: Hobby 1999, *Practical Segment Intersection with Finite Precision Output* (rounding crossings to a grid); Shewchuk & Brown 2015, *Fast
//! Segment Insertion and Incremental Construction of Constrained Delaunay Triangulations*. The triangulation is spade's.

use std::collections::HashMap;

use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_tin::{Surface, decode_normal};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use super::{
    ground::{GroundMesh, GroundVertex, unit},
    plan_cut::within,
    ribbon::Ribbon,
};
use crate::error::CutError;

/// Crossings that are made before the outlines are given up: real ones need a few.
const CROSSINGS_PER_SEGMENT: usize = 100;
/// Lines move by less than this many steps where they cross others.
const MOVED_STEPS: i64 = 4;

/// A tile's ground before the cut.
pub(crate) struct Ground<'a> {
    pub(crate) surface: &'a Surface,
    /// The normals of the TIN's vertices, as they are stored.
    pub(crate) normals: &'a [[i8; 2]],
    /// The tile's rectangle.
    pub(crate) tile: LatticeBounds,
}

/// A vertex of the triangulation, from the middle of the tile.
#[derive(Clone, Copy)]
struct Node {
    at: Point2<f64>,
    /// The TIN's vertex.
    own: Option<u32>,
}

impl HasPosition for Node {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

type Cdt = ConstrainedDelaunayTriangulation<Node>;

/// Divides the ground along roads. Ribbons come in their order of importance: where they overlap, the first is seen. Labels of triangles are places in
/// `ribbons`, counted from 1; 0 is ground without road.
pub(crate) fn cut(ground: &Ground<'_>, ribbons: &[Ribbon]) -> Result<GroundMesh, CutError> {
    let Ground { surface, tile, .. } = ground;
    let middle = LatticePoint::new(
        tile.min.u + (tile.max.u - tile.min.u) / 2,
        tile.min.v + (tile.max.v - tile.min.v) / 2,
    );
    let labels = LabelIndex::new(ribbons, tile, middle);
    let outlines = Outlines::within(ribbons, tile);
    let mut is_touched = vec![false; surface.triangles().len()];
    for bounds in outlines.bounds() {
        surface.visit_triangles_near(bounds, |triangle| {
            let corners =
                surface.triangles()[triangle as usize].map(|v| surface.points()[v as usize]);
            let own = LatticeBounds::of(&corners);
            is_touched[triangle as usize] |= own.is_some_and(|own| own.intersects(&bounds));
        });
    }
    let mut mesh = GroundMesh::new(middle);
    for (vertex, at) in surface.points().iter().enumerate() {
        mesh.vertices.push(GroundVertex {
            at: mesh.seen_from_middle(*at),
            height_m: surface.heights_m()[vertex],
            normal: decode_normal(ground.normals[vertex]),
            on_slab: false,
        });
    }
    for (triangle, corners) in surface.triangles().iter().enumerate() {
        if !is_touched[triangle] {
            mesh.add(*corners, labels.at(mesh.centroid(*corners)));
        }
    }
    if is_touched.contains(&true) {
        let cdt = triangulate(ground, &outlines, &is_touched, &mesh)?;
        add_faces(ground, &cdt, &is_touched, &labels, &mut mesh)?;
    }
    mesh.drop_unused();
    Ok(mesh)
}

/// The outlines of all ribbons as far as they lie in the tile.
struct Outlines {
    segments: Vec<[LatticePoint; 2]>,
    /// Points where an outline only touches the tile.
    points: Vec<LatticePoint>,
}

impl Outlines {
    fn within(ribbons: &[Ribbon], tile: &LatticeBounds) -> Self {
        let (mut segments, mut points) = (Vec::new(), Vec::new());
        for &segment in ribbons.iter().flat_map(|ribbon| &ribbon.outline) {
            let inside = within(segment, tile);
            match inside.as_slice() {
                [] => {}
                [point] => points.push(*point),
                more => segments.extend(more.windows(2).map(|pair| [pair[0], pair[1]])),
            }
        }
        Self { segments, points }
    }

    /// What they may come near.
    fn bounds(&self) -> impl Iterator<Item = LatticeBounds> {
        let of_segments = self.segments.iter().filter_map(|ends| LatticeBounds::of(ends));
        let of_points = self.points.iter().map(|&point| LatticeBounds { min: point, max: point });
        of_segments.map(|bounds| bounds.expanded(MOVED_STEPS)).chain(of_points)
    }
}

fn triangulate(
    ground: &Ground<'_>,
    outlines: &Outlines,
    is_touched: &[bool],
    mesh: &GroundMesh,
) -> Result<Cdt, CutError> {
    let surface = ground.surface;
    let mut place: HashMap<u32, usize> = HashMap::new();
    let (mut nodes, mut edges) = (Vec::new(), Vec::new());
    for (triangle, corners) in surface.triangles().iter().enumerate() {
        if !is_touched[triangle] {
            continue;
        }
        for corner in *corners {
            place.entry(corner).or_insert_with(|| {
                let [x, y] = mesh.vertices[corner as usize].at;
                nodes.push(Node { at: Point2::new(x, y), own: Some(corner) });
                nodes.len() - 1
            });
        }
        for k in 0..3 {
            let half_edge = 3 * triangle as u32 + k;
            let twin = surface.twin(half_edge);
            // One of both sides adds the edge.
            let is_other =
                twin != corniche_tin::NO_TWIN && is_touched[twin as usize / 3] && twin < half_edge;
            if !is_other {
                edges.push(surface.ends(half_edge).map(|vertex| place[&vertex]));
            }
        }
    }
    let mut conflicts = 0_usize;
    let cdt = Cdt::try_bulk_load_cdt(nodes, edges, |_| conflicts += 1);
    let mut cdt = cdt.map_err(|_| CutError)?;
    if conflicts > 0 {
        return Err(CutError);
    }
    let node = |at: LatticePoint| {
        let [x, y] = mesh.seen_from_middle(at);
        Node { at: Point2::new(x, y), own: None }
    };
    let put = |cdt: &mut Cdt, at: LatticePoint| {
        let new = node(at);
        match cdt.locate(new.at) {
            spade::PositionInTriangulation::OnVertex(known) => Ok(known),
            _ => cdt.insert(new).map_err(|_| CutError),
        }
    };
    for point in &outlines.points {
        put(&mut cdt, *point)?;
    }
    let mut open = Vec::with_capacity(outlines.segments.len());
    for [one, other] in &outlines.segments {
        open.push([put(&mut cdt, *one)?, put(&mut cdt, *other)?]);
    }
    // Each crossing makes two segments of each, and moves them by less than a step.
    let mut room = CROSSINGS_PER_SEGMENT * (open.len() + cdt.num_undirected_edges());
    while let Some([from, to]) = open.pop() {
        if from == to {
            continue;
        }
        let crossed = cdt.get_conflicting_edges_between_vertices(from, to).next();
        let Some(crossed) = crossed else {
            cdt.add_constraint(from, to);
            continue;
        };
        room = room.checked_sub(1).ok_or(CutError)?;
        let (edge, ends) = (crossed.as_undirected().fix(), crossed.vertices());
        let [one, other] = ends.map(|end| end.fix());
        let on_lattice = |vertex| {
            let at: Point2<f64> = cdt.vertex(vertex).position();
            LatticePoint::new(at.x as i64 + mesh.middle.u, at.y as i64 + mesh.middle.v)
        };
        let at = crossing([from, to].map(on_lattice), [one, other].map(on_lattice), &ground.tile);
        cdt.remove_constraint_edge(edge);
        let at = put(&mut cdt, at)?;
        open.extend([[one, at], [at, other], [from, at], [at, to]]);
    }
    Ok(cdt)
}

/// Where two segments cross, rounded to the lattice, and inside of the tile: only what comes from outlines alone may lie on its border, where the
/// neighbour must have it, too.
fn crossing(
    [a, b]: [LatticePoint; 2],
    [c, d]: [LatticePoint; 2],
    tile: &LatticeBounds,
) -> LatticePoint {
    let vector = |from: LatticePoint, to: LatticePoint| {
        [i128::from(to.u - from.u), i128::from(to.v - from.v)]
    };
    let cross = |p: [i128; 2], q: [i128; 2]| p[0] * q[1] - p[1] * q[0];
    let (along, other) = (vector(a, b), vector(c, d));
    let (part, whole) = (cross(vector(a, c), other), cross(along, other));
    let (part, whole) = if whole < 0 { (-part, -whole) } else { (part, whole) };
    // Rounded to the nearest; they cross, so the whole is not 0.
    let share = |length: i128| (2 * part * length + whole).div_euclid(2 * whole) as i64;
    LatticePoint::new(
        (a.u + share(along[0])).clamp(tile.min.u + 1, tile.max.u - 1),
        (a.v + share(along[1])).clamp(tile.min.v + 1, tile.max.v - 1),
    )
}

/// Adds the triangles that lie on touched ground.
fn add_faces(
    ground: &Ground<'_>,
    cdt: &Cdt,
    is_touched: &[bool],
    labels: &LabelIndex<'_>,
    mesh: &mut GroundMesh,
) -> Result<(), CutError> {
    let above = Above { ground, is_touched, middle: mesh.middle };
    let mut places: Vec<Option<u32>> = vec![None; cdt.num_vertices()];
    for face in cdt.inner_faces() {
        let corners = face.vertices();
        let at = corners.map(|corner| [corner.position().x, corner.position().y]);
        let middle = [0, 1].map(|axis| (at[0][axis] + at[1][axis] + at[2][axis]) / 3.0);
        // The triangulation fills holes and bays of touched ground.
        if !above.is_on_touched(middle) {
            continue;
        }
        let mut triangle = [0; 3];
        for (place_in_mesh, corner) in triangle.iter_mut().zip(corners) {
            let place = &mut places[corner.fix().index()];
            let node = corner.data();
            *place_in_mesh = match (*place, node.own) {
                (Some(known), _) | (None, Some(known)) => known,
                (None, None) => {
                    mesh.vertices.push(above.vertex([node.at.x, node.at.y]).ok_or(CutError)?);
                    (mesh.vertices.len() - 1) as u32
                }
            };
            *place = Some(*place_in_mesh);
        }
        mesh.add(triangle, labels.at(middle));
    }
    Ok(())
}

/// What of the ground is above a position.
struct Above<'a> {
    ground: &'a Ground<'a>,
    is_touched: &'a [bool],
    middle: LatticePoint,
}

impl Above<'_> {
    /// The touched triangle in which a position from the middle lies deepest, and the shares of its corners there.
    fn triangle(&self, at: [f64; 2]) -> Option<(u32, [f64; 3])> {
        let surface = self.ground.surface;
        let [u, v] = [at[0] + self.middle.u as f64, at[1] + self.middle.v as f64].map(f64::floor);
        let min = LatticePoint::new(u as i64 - 1, v as i64 - 1);
        let bounds = LatticeBounds { min, max: LatticePoint::new(min.u + 3, min.v + 3) };
        let mut best: Option<(u32, [f64; 3])> = None;
        surface.visit_triangles_near(bounds, |triangle| {
            if !self.is_touched[triangle as usize] {
                return;
            }
            let shares = self.shares(triangle, at);
            let depth = |shares: [f64; 3]| shares.into_iter().fold(f64::INFINITY, f64::min);
            if best.is_none_or(|(_, known)| depth(known) < depth(shares)) {
                best = Some((triangle, shares));
            }
        });
        best
    }

    fn shares(&self, triangle: u32, [x, y]: [f64; 2]) -> [f64; 3] {
        let surface = self.ground.surface;
        let [a, b, c] = surface.triangles()[triangle as usize].map(|vertex| {
            let point = surface.points()[vertex as usize];
            [(point.u - self.middle.u) as f64, (point.v - self.middle.v) as f64]
        });
        let twice = |p: [f64; 2], q: [f64; 2]| (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x);
        let (of_a, of_b, of_c) = (twice(b, c), twice(c, a), twice(a, b));
        let whole = of_a + of_b + of_c;
        [of_a / whole, of_b / whole, of_c / whole]
    }

    fn is_on_touched(&self, at: [f64; 2]) -> bool {
        self.triangle(at).is_some_and(|(_, shares)| shares.iter().all(|share| *share >= 0.0))
    }

    /// The vertex at a position on touched ground, or beside it by the rounding of a crossing.
    fn vertex(&self, at: [f64; 2]) -> Option<GroundVertex> {
        let surface = self.ground.surface;
        let of_corner = |vertex: u32| decode_normal(self.ground.normals[vertex as usize]);
        let (triangle, shares) = self.triangle(at)?;
        let corners = surface.triangles()[triangle as usize];
        if let Some([one, other]) = self.border_edge(triangle, at) {
            let [p, q] = [one, other].map(|vertex| surface.points()[vertex as usize]);
            // From the smaller end, so that both tiles of a border compute the same.
            let ([one, other], [p, q]) =
                if q < p { ([other, one], [q, p]) } else { ([one, other], [p, q]) };
            let from_p =
                [at[0] - (p.u - self.middle.u) as f64, at[1] - (p.v - self.middle.v) as f64];
            let along = from_p[0].abs() + from_p[1].abs();
            let share = along / ((q.u - p.u).abs() + (q.v - p.v).abs()) as f64;
            let [one_m, other_m] = [one, other].map(|vertex| surface.heights_m()[vertex as usize]);
            let [from, to] = [one, other].map(of_corner);
            let normal = [0, 1, 2].map(|axis| from[axis] + share as f32 * (to[axis] - from[axis]));
            let height_m = one_m + share * (other_m - one_m);
            return Some(GroundVertex { at, height_m, normal: unit(normal), on_slab: false });
        }
        let mut normal = [0.0_f32; 3];
        for (corner, share) in corners.iter().zip(shares) {
            for (sum, axis) in normal.iter_mut().zip(of_corner(*corner)) {
                *sum += share as f32 * axis;
            }
        }
        let on_lattice = [at[0] + self.middle.u as f64, at[1] + self.middle.v as f64];
        let height_m = surface.height_in_triangle_m(triangle, on_lattice);
        Some(GroundVertex { at, height_m, normal: unit(normal), on_slab: false })
    }

    /// The edge of the triangle along the tile's border on which a position lies.
    fn border_edge(&self, triangle: u32, at: [f64; 2]) -> Option<[u32; 2]> {
        let surface = self.ground.surface;
        let LatticeBounds { min, max } = self.ground.tile;
        let side = |axis: fn(LatticePoint) -> i64, here: f64, middle: i64| {
            let line = [axis(min), axis(max)]
                .into_iter()
                .find(|line| ((line - middle) as f64).to_bits() == (here + 0.0).to_bits())?;
            (0..3).map(|k| surface.ends(3 * triangle + k)).find(|ends| {
                ends.iter().all(|vertex| axis(surface.points()[*vertex as usize]) == line)
            })
        };
        side(|p| p.u, at[0], self.middle.u).or_else(|| side(|p| p.v, at[1], self.middle.v))
    }
}

/// Squares along each side of a tile.
const SQUARES: usize = 128;

/// The parts of ribbons by the squares of a grid over the tile.
struct LabelIndex<'a> {
    /// Each part with the label of its ribbon.
    parts: Vec<(u32, &'a [LatticePoint])>,
    /// Places in `parts`, ascending, by square.
    squares: Vec<Vec<u32>>,
    middle: LatticePoint,
    bounds: LatticeBounds,
}

impl<'a> LabelIndex<'a> {
    fn new(ribbons: &'a [Ribbon], tile: &LatticeBounds, middle: LatticePoint) -> Self {
        let mut index = Self {
            parts: Vec::new(),
            squares: vec![Vec::new(); SQUARES * SQUARES],
            middle,
            bounds: *tile,
        };
        for (label, ribbon) in ribbons.iter().enumerate() {
            for part in &ribbon.parts {
                index.add(label as u32 + 1, part);
            }
        }
        index
    }

    fn add(&mut self, label: u32, part: &'a [LatticePoint]) {
        let Some(own) = LatticeBounds::of(part) else { return };
        if !own.intersects(&self.bounds) {
            return;
        }
        let number = self.parts.len() as u32;
        self.parts.push((label, part));
        let [from, to] =
            [own.min, own.max].map(|p| [self.column(p.u as f64), self.row(p.v as f64)]);
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                self.squares[row * SQUARES + column].push(number);
            }
        }
    }

    fn column(&self, u: f64) -> usize {
        square(u, self.bounds.min.u, self.bounds.max.u)
    }

    fn row(&self, v: f64) -> usize {
        square(v, self.bounds.min.v, self.bounds.max.v)
    }

    /// The label at a position from the middle of the tile; 0 where there is no road.
    fn at(&self, at: [f64; 2]) -> u32 {
        let [u, v] = [at[0] + self.middle.u as f64, at[1] + self.middle.v as f64];
        let parts = &self.squares[self.row(v) * SQUARES + self.column(u)];
        let parts = parts.iter().map(|part| self.parts[*part as usize]);
        // Parts come in the order of ribbons.
        let mut found = parts.filter(|(_, part)| self.holds(part, at));
        found.next().map_or(0, |(label, _)| label)
    }

    /// Whether a position lies in a polygon, by the even-odd rule.
    fn holds(&self, part: &[LatticePoint], [x, y]: [f64; 2]) -> bool {
        let at = |p: LatticePoint| [(p.u - self.middle.u) as f64, (p.v - self.middle.v) as f64];
        let ends = part.iter().zip(part.iter().cycle().skip(1));
        let crossed = ends.filter(|(from, to)| {
            let ([fx, fy], [tx, ty]) = (at(**from), at(**to));
            (fy > y) != (ty > y) && x < fx + (tx - fx) * (y - fy) / (ty - fy)
        });
        crossed.count() % 2 == 1
    }
}

fn square(at: f64, from: i64, to: i64) -> usize {
    let share = (at - from as f64) / (to - from) as f64;
    ((share * SQUARES as f64).max(0.0) as usize).min(SQUARES - 1)
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
