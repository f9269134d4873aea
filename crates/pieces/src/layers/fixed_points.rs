//! The points of a line's part that simplification must not remove.

use corniche_drape::ClippedPart;
use corniche_geom::LatticePoint;
use corniche_roads::{MetNodes, Road};

/// The index of the line's point that equals a point of its part; `None` for a cut.
pub(crate) fn point_of_line(
    points: &[LatticePoint],
    part: &ClippedPart,
    index: usize,
) -> Option<usize> {
    let ClippedPart { line, segments } = part;
    let of_line = match segments.get(index) {
        Some(&segment) => segment,
        None => segments.last().map_or(0, |&segment| segment + 1),
    };
    (points.get(of_line) == line.points().get(index)).then_some(of_line)
}

/// The indices of a part's points that are fixed points of its line. The ends of the part, which
/// are cuts, are preserved anyway.
pub(crate) fn fixed_of_part(
    points: &[LatticePoint],
    fixed: &[u32],
    part: &ClippedPart,
) -> Vec<u32> {
    let is_fixed = |&index: &usize| {
        let of_line = point_of_line(points, part, index);
        of_line.is_some_and(|of_line| fixed.binary_search(&(of_line as u32)).is_ok())
    };
    (0..part.line.points().len()).filter(is_fixed).map(|index| index as u32).collect()
}

/// A part of a road, as a road. Its ends are not nodes if they are cuts.
#[must_use]
pub fn road_of_part(road: &Road, part: ClippedPart) -> Road {
    let points = road.line.points();
    let last = part.line.points().len() - 1;
    let stop = |index: usize| {
        let of_road = point_of_line(points, &part, index);
        let fixed = of_road.and_then(|at| road.fixed.binary_search(&(at as u32)).ok());
        let node_id = fixed.and_then(|at| road.node_ids.get(at).copied().flatten());
        let is_kept = fixed.is_some() || index == 0 || index == last;
        is_kept.then_some((index as u32, node_id))
    };
    let stops: Vec<(u32, Option<i64>)> = (0..=last).filter_map(stop).collect();
    let met = |index: usize| {
        let of_road = point_of_line(points, &part, index)? as u32;
        let met = &road.met.nodes;
        let found = met.binary_search_by_key(&of_road, |(at, _)| *at).ok()?;
        Some((index as u32, met[found].1))
    };
    let met: Vec<(u32, i64)> = match road.met.nodes[..] {
        [] => Vec::new(),
        _ => (0..=last).filter_map(met).collect(),
    };
    Road {
        way_id: road.way_id,
        class: road.class,
        attributes: road.attributes.clone(),
        fixed: stops.iter().map(|(index, _)| *index).collect(),
        node_ids: stops.iter().map(|(_, node_id)| *node_id).collect(),
        same_places: road.same_places.clone(),
        met: MetNodes { nodes: met, same_places: road.met.same_places.clone() },
        line: part.line,
    }
}
