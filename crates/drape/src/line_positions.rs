//! Computes positions and heights of a draped line from the TIN on which it is.

use corniche_geom::{LatticePoint, MAX_LATTICE_STEPS, along, cross};
use corniche_tin::Surface;

use crate::{DrapedLine, DrapedVertex};

/// Coordinates stay within the lattice: even at its edges f64 represents quarters of a step, so the
/// position of a crossing has an error of at most an eighth of a step on either axis (and
/// differences and their products are exact in 128 bits).
const REACH_STEPS: u64 = MAX_LATTICE_STEPS.unsigned_abs();

/// Why a [`DrapedLine`] does not match its surface: the package from which it comes is damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BadLine {
    /// The line has too few vertices.
    #[error("a draped line has {vertices} vertices and needs at least two")]
    TooShort {
        /// The number of its vertices.
        vertices: usize,
    },
    /// A vertex refers to a triangle that does not exist.
    #[error("vertex {at} of a draped line refers to triangle {triangle}, which does not exist")]
    NoSuchTriangle {
        /// The index of the vertex in the line.
        at: usize,
        /// The index of the triangle.
        triangle: u32,
    },
    /// A vertex refers to a TIN vertex that does not exist.
    #[error("vertex {at} of a draped line refers to TIN vertex {vertex}, which does not exist")]
    NoSuchVertex {
        /// The index of the vertex in the line.
        at: usize,
        /// The index of the TIN vertex.
        vertex: u32,
    },
    /// A point is more than 2^50 steps from the origin, where f64 does not represent fractions of a
    /// step well enough.
    #[error("point ({}, {}) of a draped line is out of range", point.u, point.v)]
    OutOfRange {
        /// The point.
        point: LatticePoint,
    },
    /// A crossing or passed vertex has no source point (or lead) on one side, or there is a lead
    /// where there must be none.
    #[error(
        "vertex {at} of a draped line is not between two source points, or a lead is not needed"
    )]
    Loose {
        /// The index of the vertex in the line.
        at: usize,
    },
    /// The line does not cross the edge of a crossing.
    #[error(
        "vertex {at} of a draped line refers to the edge {a}–{b}, which the line does not cross there"
    )]
    NoCrossing {
        /// The index of the vertex in the line.
        at: usize,
        /// The edge's first TIN vertex.
        a: u32,
        /// The edge's second TIN vertex.
        b: u32,
    },
    /// The line does not pass through a TIN vertex of its list.
    #[error(
        "vertex {at} of a draped line refers to TIN vertex {vertex}, which the line does not pass through"
    )]
    NotPassed {
        /// The index of the vertex in the line.
        at: usize,
        /// The index of the TIN vertex.
        vertex: u32,
    },
    /// A source point is not in its triangle.
    #[error("vertex {at} of a draped line is not in triangle {triangle}, to which it refers")]
    OutsideTriangle {
        /// The index of the vertex in the line.
        at: usize,
        /// The index of the triangle.
        triangle: u32,
    },
    /// A vertex is at the position of the vertex before it or in front of it, or two source points
    /// are the same.
    #[error("vertex {at} of a draped line is not beyond the vertex before it")]
    Disorder {
        /// The index of the vertex in the line.
        at: usize,
    },
    /// A vertex shares no triangle with the vertex before it.
    #[error("vertex {at} of a draped line shares no triangle with the vertex before it")]
    Apart {
        /// The index of the vertex in the line.
        at: usize,
    },
}

/// Returns the positions of the vertices of `line` on `surface`: [u, v] in (fractional) lattice
/// steps, and the height in metres.
///
/// The position and height of a crossing come from its edge, in one order of the edge's ends, and
/// do not depend on the direction of travel or on the adjacent triangles: both pieces that meet
/// there agree to the last bit. In plan the error is at most an eighth of a step at a distance of
/// 2^50 steps from the origin, and smaller nearer to it; the height is that of the exact position
/// to within 2^-50 of the heights of the edge's ends. Source points and TIN vertices are exact.
///
/// # Errors
/// When the line has too few vertices, refers to a triangle or a TIN vertex that does not exist, or
/// to an edge that it does not cross. A line without an error here may still be wrong in ways that
/// [`check`](crate::check()) detects.
pub fn positions(line: &DrapedLine, surface: &Surface) -> Result<Vec<[f64; 3]>, BadLine> {
    let mut positions = Vec::with_capacity(line.vertices.len());
    for_each_vertex(line, surface, |_, vertex, segment| {
        positions.push(match vertex {
            DrapedVertex::Source { point, triangle } => {
                [point.u as f64, point.v as f64, surface.height_at_point_m(triangle, point)]
            }
            DrapedVertex::Crossing { a, b } => crossing(surface, segment, [a, b]),
            DrapedVertex::Vertex { vertex } => {
                let point = surface.points()[vertex as usize];
                [point.u as f64, point.v as f64, surface.heights_m()[vertex as usize]]
            }
        });
        Ok(())
    })?;
    Ok(positions)
}

/// Returns for each edge of `line` the segment of the source line that contains it; edges are one
/// fewer than vertices.
///
/// The line should be one that [`positions`] accepts. In another line, a missing source point on
/// one side is replaced by the source point on the other side; a line without source points has no
/// segments.
#[must_use]
pub fn source_segments(line: &DrapedLine) -> Vec<[LatticePoint; 2]> {
    let source = |vertex: &DrapedVertex| match vertex {
        DrapedVertex::Source { point, .. } => Some(*point),
        _ => None,
    };
    let edges = line.vertices.len().saturating_sub(1);
    let mut starts = Vec::with_capacity(edges);
    let mut before = line.lead_in;
    for vertex in &line.vertices[..edges] {
        before = source(vertex).or(before);
        starts.push(before);
    }
    let mut segments = Vec::with_capacity(edges);
    let mut after = line.lead_out;
    for (start, vertex) in starts.iter().zip(line.vertices.iter().skip(1)).rev() {
        after = source(vertex).or(after);
        segments.extend(start.or(after).zip(after.or(*start)).map(|(start, end)| [start, end]));
    }
    segments.reverse();
    segments
}

/// Visits every vertex with its index and its segment (for a source point twice that point), after
/// checking its indices, its range and, for a crossing, the sides of its edge's ends.
pub(crate) fn for_each_vertex(
    line: &DrapedLine,
    surface: &Surface,
    mut visit: impl FnMut(usize, DrapedVertex, [LatticePoint; 2]) -> Result<(), BadLine>,
) -> Result<(), BadLine> {
    let vertices = &line.vertices;
    if vertices.len() < 2 {
        return Err(BadLine::TooShort { vertices: vertices.len() });
    }
    let mut before = line.lead_in.map(in_range).transpose()?;
    let mut after: Option<(usize, LatticePoint)> = None;
    for (at, &vertex) in vertices.iter().enumerate() {
        if let DrapedVertex::Source { point, triangle } = vertex {
            if triangle as usize >= surface.triangles().len() {
                return Err(BadLine::NoSuchTriangle { at, triangle });
            }
            in_range(point)?;
            visit(at, vertex, [point; 2])?;
            before = Some(point);
            continue;
        }
        if after.is_none_or(|(index, _)| index <= at) {
            let rest = vertices[at..].iter().enumerate();
            let source = rest.filter_map(|(n, vertex)| match vertex {
                DrapedVertex::Source { point, .. } => Some((at + n, *point)),
                _ => None,
            });
            after = source.chain(line.lead_out.map(|point| (vertices.len(), point))).next();
            after.map(|(_, point)| in_range(point)).transpose()?;
        }
        let (Some(p), Some((_, q))) = (before, after) else {
            return Err(BadLine::Loose { at });
        };
        match vertex {
            DrapedVertex::Crossing { a, b } => {
                let [side_a, side_b] =
                    [side(surface, at, [p, q], a)?, side(surface, at, [p, q], b)?];
                if a >= b || side_a * side_b != -1 {
                    return Err(BadLine::NoCrossing { at, a, b });
                }
            }
            DrapedVertex::Vertex { vertex } => {
                if side(surface, at, [p, q], vertex)? != 0 {
                    return Err(BadLine::NotPassed { at, vertex });
                }
            }
            DrapedVertex::Source { .. } => {}
        }
        visit(at, vertex, [p, q])?;
    }
    Ok(())
}

fn in_range(point: LatticePoint) -> Result<LatticePoint, BadLine> {
    let fits = point.u.unsigned_abs().max(point.v.unsigned_abs()) < REACH_STEPS;
    if fits { Ok(point) } else { Err(BadLine::OutOfRange { point }) }
}

/// The side of the segment on which a TIN vertex is: -1, 0 or 1.
fn side(
    surface: &Surface,
    at: usize,
    [p, q]: [LatticePoint; 2],
    vertex: u32,
) -> Result<i128, BadLine> {
    let point =
        *surface.points().get(vertex as usize).ok_or(BadLine::NoSuchVertex { at, vertex })?;
    Ok(cross(p, q, in_range(point)?).signum())
}

/// The position and the height at which the segment crosses the edge.
fn crossing(surface: &Surface, [p, q]: [LatticePoint; 2], ends: [u32; 2]) -> [f64; 3] {
    let at = ends.map(|vertex| surface.points()[vertex as usize]);
    let from_line = at.map(|point| cross(p, q, point));
    // The position is measured from the nearer end, so that the offset is small. If the segment
    // runs the other way, both numbers only change their signs.
    let (near, far) = if from_line[0].abs() <= from_line[1].abs() { (0, 1) } else { (1, 0) };
    let part = from_line[near] as f64 / (from_line[near] - from_line[far]) as f64;
    let place = |end: usize| {
        let [u, v] = at[end].in_steps();
        [u, v, surface.heights_m()[ends[end] as usize]]
    };
    along(place(near), place(far), part)
}
