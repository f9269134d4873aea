//! Cuts roads into the triangles of a tile: the surface stays the same, but is divided along the
//! outlines of roads.
//!
//! ```text
//!   triangles that no outline comes near ───────────────────────────────► unchanged
//!   the others ──► constrained triangulation of their edges ──► outlines added, edges divided where they cross ──► new triangles
//! ```
//!
//! New vertices are on the plane of the triangle that they divide, so neither the surface nor the
//! result of depth tests changes. Points on the tile's border follow from the outlines alone
//! ([`plan_cut`](super::plan_cut)): the neighbouring tile has the same.
//!
//! All points are on the lattice, where the predicates of the triangulation are exact. Where lines
//! cross, the point is rounded to the lattice and both lines pass through it: they move by less
//! than a step, half a millimetre, at each crossing.
//!
//! Sources: Hobby 1999, *Practical Segment Intersection with Finite Precision Output* (rounding
//! crossings to a grid); Shewchuk & Brown 2015, *Fast Segment Insertion and Incremental
//! Construction of Constrained Delaunay Triangulations*. The triangulation is spade's.

use std::collections::HashMap;

use corniche_geom::{LatticeBounds, LatticePoint, barycentric, cross};
use corniche_tin::{Surface, decode_normal};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use super::{
    ground::{LabelledMesh, SurfaceVertex, on_lattice, unit},
    plan_cut::{share, within},
    ribbon::Ribbon,
};
use crate::{
    error::CutError,
    plane::{steps_between, vector},
};

/// The number of crossings after which the cut fails: real outlines need a few.
const CROSSINGS_PER_SEGMENT: usize = 100;
/// Lines move by less than this many steps where they cross others.
const MOVED_STEPS: i64 = 4;

/// A tile's ground before the cut.
pub(crate) struct UncutGround<'a> {
    pub(crate) surface: &'a Surface,
    /// The normals of the TIN's vertices, in their stored form.
    pub(crate) normals: &'a [[i8; 2]],
    /// The tile's rectangle.
    pub(crate) tile: LatticeBounds,
}

/// A vertex of the triangulation, relative to the middle of the tile.
#[derive(Clone, Copy)]
struct CutNode {
    at: Point2<f64>,
    /// The number of the TIN's vertex, if it is one.
    own: Option<u32>,
}

impl HasPosition for CutNode {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

type Cdt = ConstrainedDelaunayTriangulation<CutNode>;

/// Divides the ground along roads. Ribbons are sorted by importance: where they overlap, the first
/// is visible. Labels of triangles are indices into `ribbons`, counted from 1; 0 is ground without
/// road.
pub(crate) fn cut(ground: &UncutGround<'_>, ribbons: &[Ribbon]) -> Result<LabelledMesh, CutError> {
    let UncutGround { surface, tile, .. } = ground;
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
            let own = LatticeBounds::around(&corners);
            is_touched[triangle as usize] |= own.is_some_and(|own| own.intersects(&bounds));
        });
    }
    let mut mesh = LabelledMesh::new(middle);
    for (vertex, at) in surface.points().iter().enumerate() {
        mesh.vertices.push(SurfaceVertex {
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

/// The parts of all outlines inside the tile.
struct Outlines {
    segments: Vec<[LatticePoint; 2]>,
    /// Points at which an outline only touches the tile.
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

    /// The bounds of everything that the outlines may come near.
    fn bounds(&self) -> impl Iterator<Item = LatticeBounds> {
        let of_segments = self.segments.iter().filter_map(|ends| LatticeBounds::around(ends));
        let of_points = self.points.iter().copied().map(LatticeBounds::at);
        of_segments.map(|bounds| bounds.expanded(MOVED_STEPS)).chain(of_points)
    }
}

fn triangulate(
    ground: &UncutGround<'_>,
    outlines: &Outlines,
    is_touched: &[bool],
    mesh: &LabelledMesh,
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
                nodes.push(CutNode { at: Point2::new(x, y), own: Some(corner) });
                nodes.len() - 1
            });
        }
        for k in 0..3 {
            let half_edge = 3 * triangle as u32 + k;
            let twin = surface.twin(half_edge);
            // The edge is added from one of both sides.
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
    let put = |cdt: &mut Cdt, at: LatticePoint| {
        let [x, y] = mesh.seen_from_middle(at);
        let at = Point2::new(x, y);
        match cdt.locate(at) {
            spade::PositionInTriangulation::OnVertex(known) => Ok(known),
            _ => cdt.insert(CutNode { at, own: None }).map_err(|_| CutError),
        }
    };
    for point in &outlines.points {
        put(&mut cdt, *point)?;
    }
    let mut open = Vec::with_capacity(outlines.segments.len());
    for [one, other] in &outlines.segments {
        open.push([put(&mut cdt, *one)?, put(&mut cdt, *other)?]);
    }
    // Each crossing divides both segments in two, and moves them by less than a step.
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

/// Returns the crossing of two segments, rounded to the lattice and inside the tile: only points
/// that follow from outlines alone may be on its border, where the neighbour must have them, too.
fn crossing(
    [a, b]: [LatticePoint; 2],
    [c, d]: [LatticePoint; 2],
    tile: &LatticeBounds,
) -> LatticePoint {
    // They cross, so `whole` is not 0.
    let (part, whole) = (cross(a, c, d), cross(a, b, d) - cross(a, b, c));
    LatticePoint::new(
        (a.u + share(part, b.u - a.u, whole)).clamp(tile.min.u + 1, tile.max.u - 1),
        (a.v + share(part, b.v - a.v, whole)).clamp(tile.min.v + 1, tile.max.v - 1),
    )
}

/// Adds the triangles on touched ground.
fn add_faces(
    ground: &UncutGround<'_>,
    cdt: &Cdt,
    is_touched: &[bool],
    labels: &LabelIndex<'_>,
    mesh: &mut LabelledMesh,
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

/// Finds the ground above a position.
struct Above<'a> {
    ground: &'a UncutGround<'a>,
    is_touched: &'a [bool],
    middle: LatticePoint,
}

impl Above<'_> {
    /// Returns the touched triangle in which a position (relative to the middle) is deepest, and
    /// the weights of its corners there.
    fn triangle(&self, at: [f64; 2]) -> Option<(u32, [f64; 3])> {
        let surface = self.ground.surface;
        let [u, v] = on_lattice(self.middle, at).map(|steps| steps.floor() as i64 - 1);
        let min = LatticePoint::new(u, v);
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

    fn shares(&self, triangle: u32, at: [f64; 2]) -> [f64; 3] {
        let surface = self.ground.surface;
        let corners = surface.triangles()[triangle as usize];
        let [a, b, c] =
            corners.map(|vertex| steps_between(self.middle, surface.points()[vertex as usize]));
        barycentric(at, a, b, c)
    }

    fn is_on_touched(&self, at: [f64; 2]) -> bool {
        self.triangle(at).is_some_and(|(_, shares)| shares.iter().all(|share| *share >= 0.0))
    }

    /// Returns the vertex at a position on touched ground, or as near to it as the rounding of a
    /// crossing.
    fn vertex(&self, at: [f64; 2]) -> Option<SurfaceVertex> {
        let surface = self.ground.surface;
        let of_corner = |vertex: u32| decode_normal(self.ground.normals[vertex as usize]);
        let (triangle, shares) = self.triangle(at)?;
        let corners = surface.triangles()[triangle as usize];
        if let Some([one, other]) = self.border_edge(triangle, at) {
            let [p, q] = [one, other].map(|vertex| surface.points()[vertex as usize]);
            // From the smaller end, so that both tiles of a border compute the same.
            let ([one, other], [p, q]) =
                if q < p { ([other, one], [q, p]) } else { ([one, other], [p, q]) };
            let from_p = vector(steps_between(self.middle, p), at);
            let along = from_p[0].abs() + from_p[1].abs();
            let share = along / ((q.u - p.u).abs() + (q.v - p.v).abs()) as f64;
            let [one_m, other_m] = [one, other].map(|vertex| surface.heights_m()[vertex as usize]);
            let [from, to] = [one, other].map(of_corner);
            let normal = [0, 1, 2].map(|axis| from[axis] + share as f32 * (to[axis] - from[axis]));
            let height_m = one_m + share * (other_m - one_m);
            return Some(SurfaceVertex { at, height_m, normal: unit(normal), on_slab: false });
        }
        let mut normal = [0.0_f32; 3];
        for (corner, share) in corners.iter().zip(shares) {
            for (sum, axis) in normal.iter_mut().zip(of_corner(*corner)) {
                *sum += share as f32 * axis;
            }
        }
        let height_m = surface.height_in_triangle_m(triangle, on_lattice(self.middle, at));
        Some(SurfaceVertex { at, height_m, normal: unit(normal), on_slab: false })
    }

    /// Returns the edge of the triangle along the tile's border that contains a position.
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

/// An index of the parts of ribbons by the squares of a grid over the tile.
struct LabelIndex<'a> {
    /// Each part with the label of its ribbon.
    parts: Vec<(u32, &'a [LatticePoint])>,
    /// Indices into `parts`, ascending, by square.
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
        let Some(own) = LatticeBounds::around(part) else { return };
        if !own.intersects(&self.bounds) {
            return;
        }
        let number = self.parts.len() as u32;
        self.parts.push((label, part));
        let [from, to] = [own.min, own.max].map(|corner| self.square_of(corner.in_steps()));
        for row in from[1]..=to[1] {
            for column in from[0]..=to[0] {
                self.squares[row * SQUARES + column].push(number);
            }
        }
    }

    /// Returns the column and the row of the square that contains a place on the lattice, or of the
    /// nearest one.
    fn square_of(&self, [u, v]: [f64; 2]) -> [usize; 2] {
        let LatticeBounds { min, max } = self.bounds;
        [square(u, min.u, max.u), square(v, min.v, max.v)]
    }

    /// Returns the label at a position relative to the middle of the tile; 0 where there is no
    /// road.
    fn at(&self, at: [f64; 2]) -> u32 {
        let [column, row] = self.square_of(on_lattice(self.middle, at));
        let parts = &self.squares[row * SQUARES + column];
        let parts = parts.iter().map(|part| self.parts[*part as usize]);
        // Parts are in the order of ribbons.
        let mut found = parts.filter(|(_, part)| self.holds(part, at));
        found.next().map_or(0, |(label, _)| label)
    }

    /// Whether a position is inside a polygon, by the even-odd rule.
    fn holds(&self, part: &[LatticePoint], [x, y]: [f64; 2]) -> bool {
        let ends = part.iter().zip(part.iter().cycle().skip(1));
        let crossed = ends.filter(|(from, to)| {
            let [[fx, fy], [tx, ty]] = [from, to].map(|end| steps_between(self.middle, **end));
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
