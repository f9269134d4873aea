//! Builds polygons with holes from the ways of an outline, in any order and direction.

use std::collections::HashMap;

use corniche_geom::LatticePoint;

use crate::{
    faces::inner_faces,
    outline::OutlineError,
    planar_graph::{OddEnds, PlanarGraph},
    polygon::{Polygon, Ring},
    segments::{OrderedSegment, segments_of},
};

/// The polygons that an outline encloses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AssembledArea {
    /// The polygons in order of their outer rings. No two have inner points in common.
    pub polygons: Vec<Polygon>,
    /// The number of repeated segments. Segments that occur an even number of times cancel out.
    pub repeated_segments: u64,
    /// The number of points of the outline that were in the middle of one of its segments; the
    /// segment was divided there.
    pub divided_segments: u64,
}

/// Builds polygons from the ways of an outline, in any order and direction.
///
/// The even-odd rule decides what is inside: a place is inside if a line from it to far away meets
/// the outline an odd number of times. The roles of ways (`outer`, `inner`) are ignored, because
/// they are often wrong. A segment that occurs twice therefore counts as none: neighbouring outer
/// rings become one polygon. Rings that touch at points are separated so that each polygon is
/// connected and no ring touches itself. Where a point is in the middle of a segment, the segment
/// is divided.
///
/// The time is n log n for n points, plus, for each connected part, the number of segments to the
/// west and east of it.
///
/// Source of the rules: Jochen Topf, *libosmium*, "Multipolygon assembler", which gives the same
/// areas where both give one; the method with half-edges is from de Berg, Cheong, van Kreveld &
/// Overmars, *Computational Geometry* (2008), section 2.2.
///
/// # Errors
/// When an end is open, segments cross between their points, or nothing remains.
pub fn assemble(ways: &[impl AsRef<[LatticePoint]>]) -> Result<AssembledArea, OutlineError> {
    let found = segments_of(ways)?;
    if found.segments.is_empty() {
        return Err(OutlineError::Nothing);
    }
    let polygons = polygons_of(found.segments)?;
    Ok(AssembledArea {
        polygons,
        repeated_segments: found.cancelled,
        divided_segments: found.divided,
    })
}

/// Returns the polygons enclosed by segments that meet only at their ends, in order of their outer
/// rings.
pub(crate) fn polygons_of(segments: Vec<OrderedSegment>) -> Result<Vec<Polygon>, OutlineError> {
    let graph = PlanarGraph::new(segments)
        .map_err(|OddEnds { count, first }| OutlineError::Open { ends: count, first })?;
    let faces = inner_faces(&graph);
    let mut polygons: Vec<Polygon> = faces.iter().map(|walks| polygon_of(&graph, walks)).collect();
    polygons.sort_unstable();
    Ok(polygons)
}

/// Returns the polygon of a face. A walk that reaches a point again is divided there, so that no
/// ring touches itself.
fn polygon_of(graph: &PlanarGraph, walks: &[Vec<usize>]) -> Polygon {
    let mut rings = Vec::new();
    for walk in walks {
        rings_of(walk.iter().map(|&half| graph.origin(half)), &mut rings);
    }
    // A face has one ring around it; all other rings are around holes.
    let (mut outer, holes): (Vec<Ring>, Vec<Ring>) =
        rings.into_iter().partition(|ring| ring.doubled_area() > 0);
    debug_assert_eq!(outer.len(), 1, "a face has one outer ring");
    Polygon::new(outer.swap_remove(0), holes)
}

/// Divides a closed walk into rings.
fn rings_of(walk: impl Iterator<Item = LatticePoint>, rings: &mut Vec<Ring>) {
    let mut open: Vec<LatticePoint> = Vec::new();
    let mut place_of: HashMap<LatticePoint, usize> = HashMap::new();
    for point in walk {
        if let Some(&place) = place_of.get(&point) {
            let ring = open.split_off(place);
            for point in &ring {
                place_of.remove(point);
            }
            rings.push(Ring::new(ring));
        }
        place_of.insert(point, open.len());
        open.push(point);
    }
    rings.push(Ring::new(open));
}

#[cfg(test)]
#[path = "assemble_tests.rs"]
mod tests;
