//! The points of a line's part that no simplification may remove.

use corniche_drape::ClippedPart;
use corniche_geom::LatticePoint;

/// The index of the point of a line that a point of its part is; `None` for a cut.
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

/// The indices of a part's points that are fixed points of its line. Its ends, which cuts make, stay anyway.
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
