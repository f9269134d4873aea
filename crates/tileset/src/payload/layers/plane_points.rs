//! Points of lines and points of a section, in planes: each as the steps from the point before.

use corniche_geom::{LatticeBounds, LatticePoint};
use corniche_varints::zigzag;

use crate::payload::{
    damage::{Damage, Result},
    number_codes::{Cursor, Planes},
};

/// Points are at most this far from the lattice's origin, so that computations with them are exact.
pub(crate) const FARTHEST: i64 = 1 << 56;

/// The points of a section while they are read.
pub(crate) struct PointReader<'a> {
    axes: [Coordinates<'a>; 2],
}

impl<'a> PointReader<'a> {
    /// Reads `count` points on a lattice with the spacing `step`, the first one relative to the
    /// tile's south-western corner.
    pub(crate) fn read(
        cursor: &mut Cursor<'a>,
        count: usize,
        step: i64,
        bounds: LatticeBounds,
    ) -> Result<Self> {
        let columns: [Planes<'a>; 2] = cursor.columns(count)?;
        let mut corner = corner(bounds, step).into_iter();
        let axes = columns.map(|column| Coordinates {
            steps: Box::new(column.iter()),
            step,
            last: corner.next().unwrap_or_default(),
        });
        Ok(Self { axes })
    }

    pub(crate) fn next(&mut self) -> Result<LatticePoint> {
        let [east, north] = &mut self.axes;
        Ok(LatticePoint::new(east.next()?, north.next()?))
    }
}

/// The south-western corner of a tile, in steps of the section's lattice, rounded down.
fn corner(bounds: LatticeBounds, step: i64) -> [i64; 2] {
    [bounds.min.u, bounds.min.v].map(|part| part.div_euclid(step))
}

struct Coordinates<'a> {
    steps: Box<dyn Iterator<Item = u64> + 'a>,
    step: i64,
    /// The last coordinate, in steps of the section's lattice.
    last: i64,
}

impl Coordinates<'_> {
    fn next(&mut self) -> Result<i64> {
        let by = zigzag(self.steps.next().unwrap_or_default());
        let last = self.last.checked_add(by);
        let place = last.and_then(|last| last.checked_mul(self.step));
        let place = place.filter(|place| (-FARTHEST..=FARTHEST).contains(place));
        self.last = last.unwrap_or_default();
        place.ok_or(Damage::Invalid("a point far outside the tile"))
    }
}

/// Whether a point can be written on a lattice with this spacing.
#[cfg(feature = "write")]
pub(crate) fn is_on_lattice(point: &LatticePoint, step: i64) -> bool {
    let is_place = |part: i64| part % step == 0 && (-FARTHEST..=FARTHEST).contains(&part);
    is_place(point.u) && is_place(point.v)
}

/// Writes points on a lattice with the spacing `step`.
#[cfg(feature = "write")]
pub(crate) fn put_points<'a>(
    out: &mut Vec<u8>,
    points: impl Iterator<Item = &'a LatticePoint>,
    step: i64,
    bounds: LatticeBounds,
) {
    let mut columns = [Vec::new(), Vec::new()];
    let mut last = corner(bounds, step);
    for point in points {
        for (axis, part) in [point.u, point.v].into_iter().enumerate() {
            let steps = part / step;
            columns[axis].push(corniche_varints::to_zigzag(steps - last[axis]));
            last[axis] = steps;
        }
    }
    for column in &columns {
        crate::payload::number_codes::put_planes(out, column);
    }
}
