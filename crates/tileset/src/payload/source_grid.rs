//! The grid of OSM's own coordinates, as far as it can be recognised in a package.

use corniche_geom::{GridFrame, LatticePoint};

use crate::payload::{
    damage::{Damage, Result},
    number_codes::Cursor,
};

/// OSM stores longitudes and latitudes in whole steps; this is the number of steps per degree.
#[cfg(feature = "write")]
const PARTS_OF_A_DEGREE: f64 = 1e7;

/// Positions that are multiples of a step, in packages whose CRS is in degrees: each of them is
/// snapped to one lattice point.
///
/// The lattice is about 15 times finer than OSM's grid, so a number on the lattice would have four
/// more digits without information.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SourceGrid<'f> {
    frame: &'f GridFrame,
    /// The step of the grid, east and north, in working metres.
    step_m: [f64; 2],
}

/// Number of bytes of the grid in a section.
pub(crate) const GRID_BYTES: usize = 16;

impl<'f> SourceGrid<'f> {
    /// Reads the steps of the grid at the beginning of a section.
    pub(crate) fn read(cursor: &mut Cursor<'_>, frame: &'f GridFrame) -> Result<Self> {
        let step_m = [f64::from_le_bytes(cursor.array()?), f64::from_le_bytes(cursor.array()?)];
        // No comparison is true for NaN.
        if step_m.iter().all(|&step_m| step_m > 0.0 && step_m.is_finite()) {
            Ok(Self { frame, step_m })
        } else {
            Err(Damage::Invalid("the steps of a grid of points"))
        }
    }

    /// The lattice point at a point of the grid; `None` if it is outside the lattice.
    ///
    /// All readers must compute the same point: the format specifies the operations and their
    /// order.
    pub(crate) fn lattice_point(&self, at: [i64; 2]) -> Option<LatticePoint> {
        self.frame.snap([at[0] as f64 * self.step_m[0], at[1] as f64 * self.step_m[1]])
    }

    /// The point of the grid nearest to a lattice point.
    pub(crate) fn nearest(&self, point: LatticePoint) -> [i64; 2] {
        let position_m = self.frame.position_m(point);
        [0, 1].map(|axis| (position_m[axis] / self.step_m[axis]).round() as i64)
    }
}

#[cfg(feature = "write")]
impl<'f> SourceGrid<'f> {
    /// Returns the grid of OSM's coordinates if more than half of `points` are on it, and if it is
    /// much wider than the lattice.
    ///
    /// `metres_per_unit` is the number of working metres per unit of the CRS, which is a degree if
    /// there is such a grid.
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

    /// Returns the grid as the bytes at the beginning of a section.
    pub(crate) fn to_bytes(self) -> [u8; GRID_BYTES] {
        let mut bytes = [0; GRID_BYTES];
        bytes[..8].copy_from_slice(&self.step_m[0].to_le_bytes());
        bytes[8..].copy_from_slice(&self.step_m[1].to_le_bytes());
        bytes
    }
}

/// The smallest number of lattice steps per step of the grid: points that are not multiples of the
/// step are then seldom mistaken for points of the grid.
#[cfg(feature = "write")]
const WIDER_THAN_LATTICE: f64 = 4.0;
