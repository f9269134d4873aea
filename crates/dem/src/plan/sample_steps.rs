//! The distance of samples in working metres, and the check whether a grid requests far more nodes
//! than the files have samples.

use corniche_geom::Cell;
use corniche_gis::{CrsError, CrsOperation, GridCrs};

use crate::mosaics::mosaic::Mosaic;
use crate::{Dem, GridError, GridPlan};

/// More nodes than this per sample, along either axis, are probably a mistake: they are
/// interpolated, take as much time and space as nodes with their own data, and add no information.
const MOST_NODES_PER_SAMPLE: f64 = 16.0;
/// Tolerance for the rounding of a spacing.
const ROUNDING: f64 = 1.0 + 1e-9;

/// The spacing of a mosaic's columns and rows in working metres, at its centre; `None` outside the
/// CRS.
pub(crate) fn spacing_m(
    mosaic: &Mosaic,
    working: &GridCrs,
    operation: &CrsOperation,
) -> Result<Option<[f64; 2]>, CrsError> {
    let steps = steps_m(mosaic, working, operation)?;
    Ok(steps.map(|steps| steps.map(|[x, y]| x.hypot(y))))
}

/// The vectors from a sample to the next column and to the next row, at a mosaic's centre: each in
/// working metres east and north; `None` outside the CRS.
pub(crate) fn steps_m(
    mosaic: &Mosaic,
    working: &GridCrs,
    operation: &CrsOperation,
) -> Result<Option<[[f64; 2]; 2]>, CrsError> {
    let c = mosaic.crs_from_sample.coefficients;
    if mosaic.crs.is_same(&working.crs) {
        let [fx, fy] = working.metres_per_unit;
        return Ok(Some([[c[1] * fx, c[4] * fy], [c[2] * fx, c[5] * fy]]));
    }
    let [x, y] =
        [0, 1].map(|axis| (mosaic.extent.min[axis] + mosaic.extent.max[axis] - 1) as f64 / 2.0);
    let ends = [[x - 0.5, y], [x + 0.5, y], [x, y - 0.5], [x, y + 0.5]];
    let mut ends = ends.map(|sample| mosaic.crs_from_sample.crs_from_pixel(sample));
    operation.apply(&mut ends)?;
    let way = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    let steps = [way(ends[0], ends[1]), way(ends[2], ends[3])];
    let is_way = |[x, y]: &[f64; 2]| x.is_finite() && y.is_finite() && x.hypot(*y) > 0.0;
    Ok(steps.iter().all(is_way).then_some(steps))
}

/// The size of a cell in columns and rows of samples: one cell east and one cell north, transformed
/// to sample positions.
pub(crate) fn samples_to_a_cell([column, row]: [[f64; 2]; 2], cell: Cell) -> [f64; 2] {
    let area = column[0] * row[1] - column[1] * row[0];
    [
        (row[1] * cell.east_m / area).hypot(row[0] * cell.north_m / area),
        (column[1] * cell.east_m / area).hypot(column[0] * cell.north_m / area),
    ]
}

impl Dem {
    /// Rejects a grid with more than 16 nodes per sample of even the finest files, along either
    /// axis.
    ///
    /// # Errors
    /// [`GridError::Oversampling`] for such a grid, and when a spacing cannot be found.
    pub fn refuse_oversampling(&self, plan: &GridPlan) -> Result<(), GridError> {
        let cell = plan.frame.cell();
        let mut fewest: Option<f64> = None;
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles.0) {
            let steps = steps_m(mosaic, &plan.working, &role.working_from_crs)?;
            let Some(samples) = steps.map(|steps| samples_to_a_cell(steps, cell)) else {
                continue;
            };
            let nodes = samples[0].recip().max(samples[1].recip());
            fewest = Some(fewest.map_or(nodes, |fewest| fewest.min(nodes)));
        }
        match fewest {
            Some(nodes) if nodes > MOST_NODES_PER_SAMPLE * ROUNDING => {
                Err(GridError::Oversampling { cell, nodes, limit: MOST_NODES_PER_SAMPLE })
            }
            _ => Ok(()),
        }
    }
}
