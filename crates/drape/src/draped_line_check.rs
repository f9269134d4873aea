//! Checks in exact arithmetic that a draped line could be a result of draping.

use corniche_geom::{LatticePoint, cross};
use corniche_tin::{NO_TWIN, Surface};

use crate::{
    BadLine, DrapedLine, DrapedVertex, barycentric::Barycentric, fraction::Fraction,
    line_positions::for_each_vertex,
};

/// Checks exactly that `line` could be a result of [`drape`](crate::drape()) on `surface`: its
/// indices exist, every source point is in its triangle, every crossing and TIN vertex is on its
/// segment in order, and neighbouring vertices share a triangle. Then every edge of the line is on
/// the TIN.
///
/// # Errors
/// The first error of the line.
pub fn check(line: &DrapedLine, surface: &Surface) -> Result<(), BadLine> {
    let is_source =
        |vertex: Option<&DrapedVertex>| matches!(vertex, Some(DrapedVertex::Source { .. }));
    if line.lead_in.is_some() && is_source(line.vertices.first()) {
        return Err(BadLine::Loose { at: 0 });
    }
    if line.lead_out.is_some() && is_source(line.vertices.last()) {
        return Err(BadLine::Loose { at: line.vertices.len() - 1 });
    }
    let mut before: Option<DrapedVertex> = None;
    let mut source = line.lead_in;
    let mut reached = Fraction::ZERO;
    let mut shared = Vec::new();
    for_each_vertex(line, surface, |at, vertex, segment| {
        if let DrapedVertex::Source { point, triangle } = vertex {
            if !surface.triangle_holds(triangle, point) {
                return Err(BadLine::OutsideTriangle { at, triangle });
            }
            if source.replace(point) == Some(point) {
                return Err(BadLine::Disorder { at });
            }
            reached = Fraction::ZERO;
        } else {
            let along = fraction(vertex, segment, surface);
            if along <= reached || along >= Fraction::ONE {
                return Err(BadLine::Disorder { at });
            }
            reached = along;
        }
        if let Some(before) = before.replace(vertex) {
            triangles_at(before, surface, &mut shared);
            if !shared.iter().any(|&triangle| holds(triangle, vertex, surface)) {
                return Err(BadLine::Apart { at });
            }
        }
        Ok(())
    })
}

/// The position of a crossing or passed TIN vertex along its segment.
fn fraction(vertex: DrapedVertex, segment: [LatticePoint; 2], surface: &Surface) -> Fraction {
    let at = |vertex: u32| surface.points()[vertex as usize];
    match vertex {
        DrapedVertex::Crossing { a, b } => Barycentric::new(segment, [at(a), at(b)]).zero(),
        DrapedVertex::Vertex { vertex } => Fraction::of_point(segment, at(vertex)),
        DrapedVertex::Source { .. } => Fraction::ZERO,
    }
}

/// All triangles that contain a vertex of the line, borders included.
fn triangles_at(vertex: DrapedVertex, surface: &Surface, out: &mut Vec<u32>) {
    out.clear();
    match vertex {
        DrapedVertex::Vertex { vertex } => out.extend(surface.fan(vertex).iter().map(|h| h / 3)),
        DrapedVertex::Crossing { a, b } => {
            let (hub, rim) =
                if surface.fan(a).len() <= surface.fan(b).len() { (a, b) } else { (b, a) };
            let around = surface.fan(hub).iter().map(|h| h / 3);
            out.extend(
                around.filter(|&triangle| surface.triangles()[triangle as usize].contains(&rim)),
            );
        }
        DrapedVertex::Source { point, triangle } => {
            out.push(triangle);
            for half_edge in 3 * triangle..3 * triangle + 3 {
                let [a, b] = surface.ends(half_edge);
                let [at_a, at_b] = [a, b].map(|vertex| surface.points()[vertex as usize]);
                if point == at_a {
                    out.extend(surface.fan(a).iter().map(|h| h / 3));
                } else if cross(at_a, at_b, point) == 0 && surface.twin(half_edge) != NO_TWIN {
                    out.push(surface.twin(half_edge) / 3);
                }
            }
        }
    }
}

/// Whether a triangle contains a vertex of the line, borders included.
fn holds(triangle: u32, vertex: DrapedVertex, surface: &Surface) -> bool {
    let corners = surface.triangles()[triangle as usize];
    match vertex {
        DrapedVertex::Source { point, .. } => surface.triangle_holds(triangle, point),
        DrapedVertex::Crossing { a, b } => corners.contains(&a) && corners.contains(&b),
        DrapedVertex::Vertex { vertex } => corners.contains(&vertex),
    }
}
