//! Lattice points as differences from one to the next.

use corniche_geom::LatticePoint;

use crate::payload::class_table::Heads;
use crate::payload::damage::Damage;
use crate::payload::number_codes::{Cursor, unzigzag};

/// Points lie within this many lattice steps of the tile's corner, so that orientations stay exact.
pub(crate) const REACH_STEPS: i64 = 1 << 55;

/// The points of all lines of a class, the first relative to `corner`. Neighbours in a line differ.
pub(crate) fn decode_points(
    cursor: &mut Cursor<'_>,
    heads: &Heads,
    corner: LatticePoint,
) -> Result<Vec<LatticePoint>, Damage> {
    const STILL: Damage = Damage::Invalid { what: "a segment without length" };
    let count = heads.points;
    let (east, north) = (cursor.planes(count)?, cursor.planes(count)?);
    // Every point except a line's first takes at least one byte, so the number of points is bounded by the bytes.
    if count > heads.heads.len() && east.is_absent() && north.is_absent() {
        return Err(STILL);
    }
    let mut at = corner;
    let mut points = Vec::with_capacity(count);
    let mut steps = east.iter().zip(north.iter());
    for head in &heads.heads {
        for (number, (du, dv)) in steps.by_ref().take(head.points).enumerate() {
            if number > 0 && du == 0 && dv == 0 {
                return Err(STILL);
            }
            let step = |from: i64, by: u64, corner: i64| {
                let to = from.checked_add(unzigzag(by))?;
                (to.checked_sub(corner)?.checked_abs()? <= REACH_STEPS).then_some(to)
            };
            let moved = step(at.u, du, corner.u).zip(step(at.v, dv, corner.v));
            let (u, v) = moved.ok_or(Damage::Invalid { what: "a point far away from its tile" })?;
            at = LatticePoint::new(u, v);
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
    use crate::payload::number_codes::{put_planes, zigzag};

    let far =
        |at: i64, corner: i64| i128::from(at).abs_diff(i128::from(corner)) > REACH_STEPS as u128;
    if points.iter().any(|point| far(point.u, corner.u) || far(point.v, corner.v)) {
        return Err("a point far away from the tile");
    }
    let steps = |of: fn(&LatticePoint) -> i64| -> Vec<u64> {
        let before = std::iter::once(&corner).chain(points);
        points.iter().zip(before).map(|(point, before)| zigzag(of(point) - of(before))).collect()
    };
    put_planes(out, &steps(|point| point.u));
    put_planes(out, &steps(|point| point.v));
    Ok(())
}
