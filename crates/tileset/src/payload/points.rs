//! Lattice points, stored as differences from one point to the next.

use corniche_geom::LatticePoint;
use corniche_varints::zigzag;

use crate::payload::{
    damage::{Damage, Result},
    number_codes::Cursor,
};

/// Points are within this many lattice steps of the tile's corner, so that orientation tests stay
/// exact.
const REACH_STEPS: u64 = 1 << 55;

pub(crate) const FAR: Damage = Damage::Invalid("a point far away from its tile");

/// Whether a point is within reach of the tile's corner.
pub(crate) fn is_near(point: LatticePoint, corner: LatticePoint) -> bool {
    point.u.abs_diff(corner.u).max(point.v.abs_diff(corner.v)) <= REACH_STEPS
}

/// Decodes the points of lines with given numbers of points, the first relative to `corner`.
/// Neighbouring points of a line differ. The caller limits the numbers.
pub(crate) fn decode_points(
    cursor: &mut Cursor<'_>,
    lines: impl ExactSizeIterator<Item = usize> + Clone,
    corner: LatticePoint,
) -> Result<Vec<LatticePoint>> {
    const STILL: Damage = Damage::Invalid("a segment of zero length");
    let count = lines.clone().sum();
    let [east, north] = cursor.columns(count)?;
    // Every point except the first of a line takes at least one byte, so the number of points is
    // limited by the bytes.
    if count > lines.len() && east.is_absent() && north.is_absent() {
        return Err(STILL);
    }
    let mut at = corner;
    let mut points = Vec::with_capacity(count);
    let mut steps = east.iter().zip(north.iter());
    for points_of_line in lines {
        for (number, (du, dv)) in steps.by_ref().take(points_of_line).enumerate() {
            if number > 0 && du == 0 && dv == 0 {
                return Err(STILL);
            }
            let moved = at.u.checked_add(zigzag(du)).zip(at.v.checked_add(zigzag(dv)));
            let moved = moved.map(|(u, v)| LatticePoint::new(u, v));
            at = moved.filter(|&point| is_near(point, corner)).ok_or(FAR)?;
            points.push(at);
        }
    }
    Ok(points)
}

/// The inverse of [`decode_points`].
#[cfg(feature = "write")]
pub(crate) fn put_points(
    out: &mut Vec<u8>,
    points: &[LatticePoint],
    corner: LatticePoint,
) -> Result<(), &'static str> {
    use corniche_varints::to_zigzag;

    use crate::payload::{damage::refuse_if, number_codes::put_planes};

    refuse_if(
        !points.iter().all(|&point| is_near(point, corner)),
        "a point far away from the tile",
    )?;
    let steps = |of: fn(&LatticePoint) -> i64| -> Vec<u64> {
        let before = std::iter::once(&corner).chain(points);
        points.iter().zip(before).map(|(point, before)| to_zigzag(of(point) - of(before))).collect()
    };
    put_planes(out, &steps(|point| point.u));
    put_planes(out, &steps(|point| point.v));
    Ok(())
}
