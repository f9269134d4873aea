//! The grid that OSM's own coordinates lie on, as far as it can be seen in a package.

use corniche_geom::{GridFrame, LatticePoint};

use crate::payload::damage::Damage;
use crate::payload::number_codes::Cursor;

/// OSM stores longitudes and latitudes in whole parts of a degree: so many.
#[cfg(feature = "write")]
const PARTS_OF_A_DEGREE: f64 = 1e7;

/// Positions that are multiples of a step, in packages whose CRS is in degrees: each is snapped to one lattice point.
///
/// The lattice is some 15 times finer than OSM's grid, so that a number on it has four digits more that say nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SourceGrid<'f> {
    frame: &'f GridFrame,
    /// East and north, working metres.
    step_m: [f64; 2],
}

/// Bytes of the grid in a section.
pub(crate) const GRID_BYTES: usize = 16;

impl<'f> SourceGrid<'f> {
    /// Takes the steps that a section begins with.
    pub(crate) fn read(cursor: &mut Cursor<'_>, frame: &'f GridFrame) -> Result<Self, Damage> {
        let step_m = [f64::from_le_bytes(cursor.array()?), f64::from_le_bytes(cursor.array()?)];
        // No comparison is true for NaN.
        if step_m.iter().all(|&step_m| step_m > 0.0 && step_m.is_finite()) {
            Ok(Self { frame, step_m })
        } else {
            Err(Damage::Invalid("the steps of a grid of points"))
        }
    }

    /// The lattice point at a point of the grid; `None` beyond the lattice.
    ///
    /// Readers must come to the same: the format names the operations and their order.
    pub(crate) fn lattice_point(&self, at: [i64; 2]) -> Option<LatticePoint> {
        self.frame.snap([at[0] as f64 * self.step_m[0], at[1] as f64 * self.step_m[1]])
    }

    /// The point of the grid that is nearest to a lattice point.
    pub(crate) fn nearest(&self, point: LatticePoint) -> [i64; 2] {
        let position_m = self.frame.position_m(point);
        [0, 1].map(|axis| (position_m[axis] / self.step_m[axis]).round() as i64)
    }
}

#[cfg(feature = "write")]
impl<'f> SourceGrid<'f> {
    /// The grid of OSM's coordinates, if `points` lie on it: more than half of them, on a grid that is much wider than the lattice.
    ///
    /// `metres_per_unit`: working metres to a unit of the CRS; a degree, where there is such a grid.
    pub(crate) fn of_osm(
        frame: &'f GridFrame,
        metres_per_unit: [f64; 2],
        points: impl Iterator<Item = LatticePoint>,
    ) -> Option<Self> {
        let grid = Self { frame, step_m: metres_per_unit.map(|metres| metres / PARTS_OF_A_DEGREE) };
        let least_m = WIDER_THAN_LATTICE * frame.lattice_step_m();
        if grid.step_m.iter().any(|&step_m| step_m < least_m) {
            return None;
        }
        let (mut all, mut on_grid) = (0_usize, 0_usize);
        for point in points {
            all += 1;
            on_grid += usize::from(grid.lattice_point(grid.nearest(point)) == Some(point));
        }
        (2 * on_grid > all).then_some(grid)
    }

    /// What a section begins with.
    pub(crate) fn to_bytes(self) -> [u8; GRID_BYTES] {
        let mut bytes = [0; GRID_BYTES];
        bytes[..8].copy_from_slice(&self.step_m[0].to_le_bytes());
        bytes[8..].copy_from_slice(&self.step_m[1].to_le_bytes());
        bytes
    }
}

/// So many lattice steps to a step of the grid, at least: a point that is no multiple is then seldom taken for one.
#[cfg(feature = "write")]
const WIDER_THAN_LATTICE: f64 = 4.0;
