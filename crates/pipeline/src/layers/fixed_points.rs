//! The points of a line's part that no simplification may remove.

use corniche_drape::ClippedPart;
use corniche_geom::LatticePoint;

/// The indices of a part's points that are fixed points of its line. Its ends, which cuts make, stay anyway.
pub(crate) fn fixed_of_part(
    points: &[LatticePoint],
    fixed: &[u32],
    part: &ClippedPart,
) -> Vec<u32> {
    let ClippedPart { line, segments } = part;
    let source = |index: usize| match segments.get(index) {
        Some(&segment) => segment,
        None => segments.last().map_or(0, |&segment| segment + 1),
    };
    let is_fixed = |&index: &usize| {
        let of_line = source(index);
        points.get(of_line) == Some(&line.points()[index])
            && fixed.binary_search(&(of_line as u32)).is_ok()
    };
    (0..line.points().len()).filter(is_fixed).map(|index| index as u32).collect()
}
