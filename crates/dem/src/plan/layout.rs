//! The positions of nodes: cell, phase, and the factors of the working CRS.

use corniche_geom::{Bounds, Cell, NodeIndex};
use corniche_gis::{CrsOperation, GridCrs};

use crate::mosaics::data_extent;
use crate::mosaics::mosaic::{Mosaic, nice, phase, rounded};
use crate::plan::grid_plan::PlanOptions;
use crate::plan::kernel::Alignment;
use crate::plan::sample_steps::spacing_m;
use crate::{Dem, GridError};

/// Nodes coincide with samples if none is farther off than this, in cells.
const ALIGNED_CELLS: f64 = 1e-3;
/// The largest number of samples along an axis of which one is used.
const MAX_EVERY: i64 = 1000;

/// Cell, phase and the working CRS with its final factors.
pub(crate) struct Layout {
    pub(crate) working: GridCrs,
    pub(crate) origin_m: [f64; 2],
    pub(crate) cell: Cell,
    /// Only samples whose index is a multiple of this are used; indices are counted like the tiles.
    every: i64,
}

/// Uses the requested cell, else that of the first mosaic, whose samples, or every n-th of them,
/// are then the nodes.
pub(crate) fn layout(
    dem: &Dem,
    options: &PlanOptions,
    working: GridCrs,
) -> Result<Layout, GridError> {
    let first = &dem.mosaics[0];
    let every = i64::from(options.cell_every.unwrap_or(1));
    if !(1..=MAX_EVERY).contains(&every) {
        return Err(GridError::CellEvery {
            every: options.cell_every.unwrap_or(0),
            limit: MAX_EVERY,
        });
    }
    if options.cell_every.is_some() && options.cell.is_some() {
        return Err(GridError::CellTwice);
    }
    let is_own = first.crs.is_same(&working.crs) && first.crs_from_sample.is_axis_parallel();
    if is_own && options.cell.is_none() {
        return Ok(Layout::of_samples(first, working, every));
    }
    if options.cell_every.is_some() {
        return Err(not_samples(first, options, &working));
    }
    let cell = asked_or_square(dem, options, &working)?.fitted();
    if is_own {
        // A cell that is equal to the DEM's own, given as a number.
        let of_samples = Layout::of_samples(first, working.clone(), 1);
        let is_near = |axis: usize| {
            let (own, asked) = (of_samples.cell.to_array()[axis], cell.to_array()[axis]);
            let reach = first.extent.columns().max(first.extent.rows()) as f64;
            (own - asked).abs() * reach <= ALIGNED_CELLS * asked
        };
        if is_near(0) && is_near(1) {
            return Ok(of_samples);
        }
    }
    Ok(Layout { working, origin_m: [0.0; 2], cell, every: 1 })
}

/// The error if every n-th sample is requested, but nodes are not samples, with advice.
fn not_samples(first: &Mosaic, options: &PlanOptions, working: &GridCrs) -> GridError {
    let is_turned = first.crs.is_same(&working.crs);
    let way_out = match options.crs {
        _ if is_turned => "the DEM's rows and columns are not parallel to its axes, so pass --cell",
        Some(_) => "pass --crs dem, or --cell instead of --cell-every",
        None => {
            "that CRS was chosen because lengths in the CRS of the DEM are off by more than 3 %; pass --crs dem, or --cell instead of --cell-every"
        }
    };
    GridError::CellEveryResampled { crs: working.crs.label.clone(), way_out }
}

/// The requested cell, else a square whose side is the shorter spacing of the first mosaic's
/// samples.
fn asked_or_square(dem: &Dem, options: &PlanOptions, working: &GridCrs) -> Result<Cell, GridError> {
    let first = &dem.mosaics[0];
    let cell = if let Some(cell) = options.cell {
        cell
    } else {
        let operation = CrsOperation::into_working(&first.crs, working, Some(dem.wgs84_bounds));
        let spacing_m = spacing_m(first, working, &operation)?
            .ok_or_else(|| GridError::OutsideCrs { crs: working.crs.label.clone() })?;
        let shorter_m = spacing_m[0].min(spacing_m[1]);
        let is_turned = first.crs.is_same(&working.crs);
        Cell::from(rounded(shorter_m, if is_turned { 9 } else { 2 }))
    };
    if cell.to_array().iter().any(|side_m| !(0.001..=1e6).contains(side_m)) {
        if options.cell.is_some() {
            return Err(GridError::Cell { cell });
        }
        let path = dem.sources[first.files[0].index].path.clone();
        return Err(GridError::CellOfFile { path, cell, crs: working.crs.label.clone() });
    }
    Ok(cell)
}

impl Layout {
    /// Nodes at every `every`-th sample of a mosaic that is parallel to the axes of the working
    /// CRS.
    ///
    /// The east factor changes by less than a millimetre per cell, so that the cell's east side is
    /// a whole number of lattice steps.
    fn of_samples(mosaic: &Mosaic, mut working: GridCrs, every: i64) -> Self {
        let c = mosaic.crs_from_sample.coefficients;
        let reach = mosaic.extent.columns().max(mosaic.extent.rows()) as f64;
        let spacing = [c[1], c[5]].map(|step| nice(step.abs(), reach));
        let factor = working.metres_per_unit;
        let side_m = |axis: usize| spacing[axis] * factor[axis].abs() * every as f64;
        let cell = Cell { east_m: side_m(0), north_m: side_m(1) }.fitted();
        if cell.east_m.to_bits() != side_m(0).to_bits() {
            let east = cell.east_m / (spacing[0] * every as f64);
            working.metres_per_unit[0] = east.copysign(factor[0]);
        }
        let is_degrees = !mosaic.crs.is_projected();
        let origin_m = [0, 1].map(|axis| {
            let factor = working.metres_per_unit[axis];
            let at = [c[0], c[3]][axis] * factor.signum();
            phase(at, spacing[axis], is_degrees) * factor.abs()
        });
        Self { working, origin_m, cell, every }
    }

    /// The alignment of the mosaic's samples with nodes; `None` if the samples are not nodes.
    pub(crate) fn alignment(&self, mosaic: &Mosaic) -> Option<Alignment> {
        let transform = &mosaic.crs_from_sample;
        if !transform.is_axis_parallel() || !mosaic.crs.is_same(&self.working.crs) {
            return None;
        }
        let factor = self.working.metres_per_unit;
        // The spacing of samples, if only every n-th one is used.
        let between = self.cell.times(1.0 / self.every as f64).to_array();
        // Across the antimeridian, the mosaic is moved next to the middle of the data.
        let [middle, _] = mosaic.middle();
        let moved = self.working.seam().map_or(0.0, |seam| seam.turn() * seam.turns(middle));
        let cells = |sample: [i64; 2]| {
            let mut at = transform.crs_from_pixel(sample.map(|index| index as f64));
            at[0] -= moved;
            [0, 1].map(|axis| (at[axis] * factor[axis] - self.origin_m[axis]) / between[axis])
        };
        let c = transform.coefficients;
        let steps = [c[1] * factor[0], c[5] * factor[1]];
        let way = steps.map(|step| step.signum() as i64);
        let [i, j] = cells([0, 0]).map(|cells| cells.round() as i64);
        let (low, high) = (mosaic.extent.min, mosaic.extent.max.map(|index| index - 1));
        let fits = [low, high].iter().all(|&sample| {
            let at = cells(sample);
            let off =
                [at[0] - (i + way[0] * sample[0]) as f64, at[1] - (j + way[1] * sample[1]) as f64];
            off.iter().all(|off| off.abs() <= ALIGNED_CELLS)
        });
        // For a single row or column the positions alone do not test the spacing, so both spacings
        // must equal the cell.
        let is_cell = [0, 1]
            .iter()
            .all(|&axis| (steps[axis].abs() / between[axis] - 1.0).abs() <= ALIGNED_CELLS);
        (fits && is_cell).then_some(Alignment { first: [i, j], way, every: self.every })
    }

    /// The south-western and the north-eastern node between which a mosaic can have data.
    pub(crate) fn nodes(
        &self,
        dem: &Dem,
        mosaic: &Mosaic,
        operation: &CrsOperation,
    ) -> Result<[NodeIndex; 2], GridError> {
        if let Some(alignment) = self.alignment(mosaic) {
            return Ok(alignment.nodes(&mosaic.closed(&mosaic.extent)));
        }
        let mut bounds = Bounds::EMPTY;
        for file in &mosaic.files {
            let found = data_extent::bounds(mosaic, &file.rect, operation)?;
            if found.is_empty() {
                // Without this error the heights of the file would be lost silently.
                let path = dem.sources[file.index].path.clone();
                let crs = self.working.crs.label.clone();
                return Err(GridError::FileOutsideCrs { path, crs });
            }
            bounds.include([found.min_x, found.min_y]);
            bounds.include([found.max_x, found.max_y]);
        }
        if let Some(seam_m) = self.working.seam_m().filter(|_| mosaic.is_ring()) {
            bounds.max_x = bounds.max_x.max(bounds.min_x + seam_m.turn());
        }
        Ok(corner_nodes(bounds, self.origin_m, self.cell, [f64::floor, f64::ceil]))
    }
}

/// The nodes at the south-western and the north-eastern corner of bounds in working metres, each
/// rounded with its own function.
pub(crate) fn corner_nodes(
    bounds_m: Bounds,
    origin_m: [f64; 2],
    cell: Cell,
    round: [fn(f64) -> f64; 2],
) -> [NodeIndex; 2] {
    let node = |metres: [f64; 2], round: fn(f64) -> f64| {
        let [i, j] =
            [0, 1].map(|axis| round((metres[axis] - origin_m[axis]) / cell.to_array()[axis]));
        NodeIndex { i: i as i64, j: j as i64 }
    };
    let Bounds { min_x, min_y, max_x, max_y } = bounds_m;
    [node([min_x, min_y], round[0]), node([max_x, max_y], round[1])]
}
