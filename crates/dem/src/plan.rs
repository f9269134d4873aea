//! The grid of a package: working CRS, cell, extent.

use corniche_geom::{Bounds, Cell, Frame, NodeIndex};
use gdal::version::VersionInfo;

use crate::kernel::Kernel;
use crate::mosaic::{Mosaic, Placed};
use crate::operation::Operation;
use crate::positions::NodePositions;
use crate::spacing::{nice, phase};
use crate::turns::turns;
use crate::working::{PlanScale, Working, rounded};
use crate::{Dem, DemError, outline, working};

/// Nodes coincide with samples when none is farther off than this, in cells.
const ALIGNED_CELLS: f64 = 1e-3;
/// Most samples along an axis of which one is taken.
const MAX_EVERY: i64 = 1000;
/// Most samples averaged along a side of a cell; bounds the memory that one node can ask for.
const MAX_SAMPLES_PER_NODE: f64 = 1000.0;
/// Farthest that voids can be filled; bounds the halo.
const MAX_FILL_VOIDS: u32 = 1024;

/// Most files of one grid that the words about it name.
const MAX_NAMES: usize = 3;

/// What the user may say about the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// Working CRS: "dem" (the first file's own), "utm" (both in any case), "EPSG:n" or WKT; `None` chooses one.
    pub crs: Option<String>,
    /// Spacing of the nodes, working metres; `None` takes the DEM's.
    pub cell: Option<Cell>,
    /// Take every n-th sample along both axes as node, of those whose indices, counted as tiles are aligned, are multiples
    /// of n. Not together with `cell`.
    pub cell_every: Option<u32>,
    /// Latitude at which lengths in the DEM's own CRS are true; `None` takes the data's middle, to half a degree.
    pub scale_latitude_deg: Option<f64>,
    /// A void is filled from data within this many cells; 0 fills nothing.
    pub fill_voids: u32,
}

/// Whether nodes are the DEM's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resampling {
    /// Nodes are samples, and samples are nodes: nothing is resampled.
    Aligned,
    /// Nodes are samples, but only every n-th one is a node.
    Thinned,
    /// Heights at nodes are interpolated or averaged, from some files at least.
    Resampled,
}

/// The grid of a package and how its heights come about.
#[derive(Debug, Clone)]
pub struct GridPlan {
    /// Nodes, tiles and levels.
    pub frame: Frame,
    /// South-westernmost node at which data can lie.
    pub south_west: NodeIndex,
    /// North-easternmost node at which data can lie.
    pub north_east: NodeIndex,
    /// Working CRS: "EPSG:…" where it has a code, else its name.
    pub crs: String,
    /// Working CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres to a unit of the CRS's coordinates, east and north. Negative where an axis counts westwards or
    /// southwards.
    pub metres_per_unit: [f64; 2],
    /// Working metres to a true metre, at the centre: the geometric mean along both axes.
    pub point_scale: f64,
    /// The same along each axis, at the centre and over the data's rim.
    pub scale: PlanScale,
    /// Rectangle of the nodes from `south_west` to `north_east`, working metres.
    pub data_bounds: Bounds,
    /// Rectangle around the files in WGS84 degrees. Past the antimeridian longitudes go on beyond ±180.
    pub wgs84_bounds: Bounds,
    /// Which case it is.
    pub case: Resampling,
    /// The case in words.
    pub resampling: String,
    /// Names, without folders, of the files that are resampled onto the grid of the first one, and of that one. `None` where no file is, or all are.
    pub resampled_onto_first: Option<[String; 2]>,
    /// What the resulting heights are measured from, as far as files or options name it.
    pub vertical_datum: Option<String>,
    /// What was done to the files' heights, in words; with the offset at the DEM's centre where PROJ carried them.
    pub vertical: String,
    /// Releases of GDAL and PROJ, on which the heights' last bits depend.
    pub libraries: String,
    /// A void is filled from data within this many cells.
    pub fill_voids: u32,
    /// One per mosaic of the DEM, in its order.
    pub(crate) layers: Vec<Layer>,
    pub(crate) working: Working,
}

/// How one mosaic serves nodes.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    /// South-western and north-eastern node between which it can have data.
    pub(crate) nodes: [NodeIndex; 2],
    pub(crate) method: Method,
    /// From the mosaic's CRS to working metres.
    pub(crate) working_from_crs: Operation,
}

#[derive(Debug, Clone)]
pub(crate) enum Method {
    Aligned(Alignment),
    Resampled(Box<NodePositions>, Kernel),
}

/// Sample (column, row) = (`way[0]` · (`every` · i − `first[0]`), `way[1]` · (`every` · j − `first[1]`)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Alignment {
    /// Index of sample (0, 0), counted in samples from node (0, 0).
    pub(crate) first: [i64; 2],
    pub(crate) way: [i64; 2],
    pub(crate) every: i64,
}

impl Alignment {
    /// The sample under a node.
    pub(crate) fn sample(&self, node: NodeIndex) -> [i64; 2] {
        [
            self.way[0] * (self.every * node.i - self.first[0]),
            self.way[1] * (self.every * node.j - self.first[1]),
        ]
    }
}

impl GridPlan {
    /// Whether working metres depend on the standard latitude: in UTM and in projections that are true to scale they do not,
    /// and `--scale-latitude` changes nothing.
    #[must_use]
    pub fn has_standard_latitude(&self) -> bool {
        self.working.is_scaled
    }

    /// The poles' distance from zero along y, working metres, where the working CRS counts in degrees; `None` in a
    /// projection. Positions beyond it have no longitude.
    #[must_use]
    pub fn poles_y_m(&self) -> Option<f64> {
        self.working.crs.turn.map(|turn| turn / 4.0 * self.metres_per_unit[1].abs())
    }
}

pub(crate) fn plan(dem: &Dem, options: &PlanOptions) -> Result<GridPlan, DemError> {
    if options.fill_voids > MAX_FILL_VOIDS {
        return Err(DemError::FillVoids { cells: options.fill_voids, limit: MAX_FILL_VOIDS });
    }
    let working = working::choose(dem, options.crs.as_deref(), options.scale_latitude_deg)?;
    let into_working = |working: &Working| -> Vec<Operation> {
        let of =
            |mosaic: &Mosaic| Operation::into_working(&mosaic.crs, working, Some(dem.wgs84_bounds));
        dem.mosaics.iter().map(of).collect()
    };
    let layout = layout(dem, options, working, &into_working)?;
    let scale = layout.working.scale(dem)?;
    let operations = into_working(&layout.working);
    let steps: Vec<Option<[[f64; 2]; 2]>> = dem
        .mosaics
        .iter()
        .zip(&operations)
        .map(|(mosaic, operation)| steps_m(mosaic, &layout.working, operation))
        .collect::<Result<_, _>>()?;
    let extents: Vec<[NodeIndex; 2]> = dem
        .mosaics
        .iter()
        .zip(&operations)
        .map(|(mosaic, operation)| layout.nodes(dem, mosaic, operation))
        .collect::<Result<_, _>>()?;
    let [south_west, north_east] = extents
        .iter()
        .copied()
        .reduce(|[sw, ne], [low, high]| {
            [
                NodeIndex { i: sw.i.min(low.i), j: sw.j.min(low.j) },
                NodeIndex { i: ne.i.max(high.i), j: ne.j.max(high.j) },
            ]
        })
        .ok_or_else(|| DemError::OutsideCrs { crs: layout.working.crs.label.clone() })?;
    let [columns, rows] = [north_east.i - south_west.i + 1, north_east.j - south_west.j + 1];
    if let Some(every) = options.cell_every
        && columns.min(rows) < 2
    {
        let [columns, rows] = [columns, rows].map(|nodes| nodes.max(0));
        return Err(DemError::CellEveryLeaves { every, columns, rows });
    }
    let frame = Frame::covering(layout.origin_m, layout.cell, south_west, north_east)?;
    let mut layers = Vec::new();
    for (((mosaic, working_from_crs), nodes), steps) in
        dem.mosaics.iter().zip(operations).zip(extents).zip(steps)
    {
        let method = match layout.alignment(mosaic) {
            Some(alignment) => Method::Aligned(alignment),
            None => resample(dem, mosaic, &frame, &layout.working, nodes, steps)?,
        };
        layers.push(Layer { nodes, method, working_from_crs });
    }
    let is_every_sample =
        |layer: &Layer| matches!(layer.method, Method::Aligned(alignment) if alignment.every == 1);
    let is_aligned = |layer: &Layer| matches!(layer.method, Method::Aligned(_));
    let working = layout.working;
    Ok(GridPlan {
        frame,
        south_west,
        north_east,
        crs: working.crs.label.clone(),
        crs_wkt: working.crs.wkt.to_string(),
        metres_per_unit: working.metres_per_unit,
        point_scale: (scale.center[0] * scale.center[1]).sqrt(),
        scale,
        data_bounds: Bounds {
            min_x: frame.x_m(south_west.i),
            min_y: frame.y_m(south_west.j),
            max_x: frame.x_m(north_east.i),
            max_y: frame.y_m(north_east.j),
        },
        wgs84_bounds: dem.wgs84_bounds,
        case: if layers.iter().all(is_every_sample) {
            Resampling::Aligned
        } else if layers.iter().all(is_aligned) {
            Resampling::Thinned
        } else {
            Resampling::Resampled
        },
        resampling: describe(dem, &layers),
        resampled_onto_first: resampled_onto_first(dem, &layers),
        vertical_datum: dem.heights.datum.clone(),
        vertical: dem.heights.words.clone(),
        libraries: libraries(),
        fill_voids: options.fill_voids,
        layers,
        working,
    })
}

/// Spacing of a mosaic's columns and rows in working metres, at its centre; `None` outside the CRS.
fn spacing_m(
    mosaic: &Mosaic,
    working: &Working,
    operation: &Operation,
) -> Result<Option<[f64; 2]>, DemError> {
    let steps = steps_m(mosaic, working, operation)?;
    Ok(steps.map(|steps| steps.map(|[x, y]| x.hypot(y))))
}

/// The way from a sample to the next column and to the next row, at a mosaic's centre: working metres east and north each;
/// `None` outside the CRS.
pub(crate) fn steps_m(
    mosaic: &Mosaic,
    working: &Working,
    operation: &Operation,
) -> Result<Option<[[f64; 2]; 2]>, DemError> {
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

/// Columns and rows of samples that a cell is long: one cell east and one north, carried among the samples.
pub(crate) fn samples_to_a_cell([column, row]: [[f64; 2]; 2], cell: Cell) -> [f64; 2] {
    let area = column[0] * row[1] - column[1] * row[0];
    [
        (row[1] * cell.east_m / area).hypot(row[0] * cell.north_m / area),
        (column[1] * cell.east_m / area).hypot(column[0] * cell.north_m / area),
    ]
}

/// Cell, phase and the working CRS with its final factors.
struct Layout {
    working: Working,
    origin_m: [f64; 2],
    cell: Cell,
    /// The samples taken are those whose index, counted as tiles are aligned, is a multiple of this.
    every: i64,
}

/// The cell as asked, else the first mosaic's: its samples, or every n-th of them, are then the nodes.
fn layout(
    dem: &Dem,
    options: &PlanOptions,
    working: Working,
    into_working: &dyn Fn(&Working) -> Vec<Operation>,
) -> Result<Layout, DemError> {
    let first = &dem.mosaics[0];
    let every = i64::from(options.cell_every.unwrap_or(1));
    if !(1..=MAX_EVERY).contains(&every) {
        return Err(DemError::CellEvery {
            every: options.cell_every.unwrap_or(0),
            limit: MAX_EVERY,
        });
    }
    if options.cell_every.is_some() && options.cell.is_some() {
        return Err(DemError::CellTwice);
    }
    let is_own = first.crs.is_same(&working.crs) && first.crs_from_sample.is_axis_parallel();
    if is_own && options.cell.is_none() {
        return Ok(Layout::of_samples(first, working, every));
    }
    if options.cell_every.is_some() {
        let is_turned = first.crs.is_same(&working.crs);
        let way_out = match options.crs {
            _ if is_turned => {
                "the DEM's rows and columns do not run along its axes, so give --cell"
            }
            Some(_) => "give --crs dem, or --cell in place of --cell-every",
            None => {
                "that CRS is taken because lengths in the DEM's own are not true within 3 %; give --crs dem, or --cell in \
                 place of --cell-every"
            }
        };
        return Err(DemError::CellEveryResampled { crs: working.crs.label.clone(), way_out });
    }
    let cell = if let Some(cell) = options.cell {
        cell
    } else {
        let operations = into_working(&working);
        let spacing_m = spacing_m(first, &working, &operations[0])?
            .ok_or_else(|| DemError::OutsideCrs { crs: working.crs.label.clone() })?;
        let shorter_m = spacing_m[0].min(spacing_m[1]);
        let is_turned = first.crs.is_same(&working.crs);
        Cell::from(rounded(shorter_m, if is_turned { 9 } else { 2 }))
    };
    if cell.to_array().iter().any(|side_m| !(0.001..=1e6).contains(side_m)) {
        if options.cell.is_some() {
            return Err(DemError::Cell { cell });
        }
        let path = dem.sources[first.files[0].index].path.clone();
        return Err(DemError::CellOfFile { path, cell, crs: working.crs.label.clone() });
    }
    let cell = cell.fitted();
    if is_own {
        // A cell that is the DEM's own, given as a number.
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

impl Layout {
    /// Nodes at every `every`-th sample of a mosaic that lies along the axes of the working CRS.
    ///
    /// The east factor changes by less than a millimetre a cell, so that the cell's east side is a whole number of
    /// lattice steps.
    fn of_samples(mosaic: &Mosaic, mut working: Working, every: i64) -> Self {
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
        let is_degrees = mosaic.crs.turn.is_some();
        let origin_m = [0, 1].map(|axis| {
            let factor = working.metres_per_unit[axis];
            let at = [c[0], c[3]][axis] * factor.signum();
            phase(at, spacing[axis], is_degrees) * factor.abs()
        });
        Self { working, origin_m, cell, every }
    }

    /// How the mosaic's samples are nodes; `None` when they are not.
    fn alignment(&self, mosaic: &Mosaic) -> Option<Alignment> {
        let transform = &mosaic.crs_from_sample;
        if !transform.is_axis_parallel() || !mosaic.crs.is_same(&self.working.crs) {
            return None;
        }
        let factor = self.working.metres_per_unit;
        // A cell between samples, when only every n-th is taken.
        let between = self.cell.times(1.0 / self.every as f64).to_array();
        // Past the antimeridian the mosaic lies where the data's middle is near.
        let moved = mosaic
            .turn()
            .map_or(0.0, |[turn, middle]| turn * turns(middle - self.working.middle, turn));
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
        // A single row or column says nothing of its own spacing; both must be the cell.
        let is_cell = [0, 1]
            .iter()
            .all(|&axis| (steps[axis].abs() / between[axis] - 1.0).abs() <= ALIGNED_CELLS);
        (fits && is_cell).then_some(Alignment { first: [i, j], way, every: self.every })
    }

    /// South-western and north-eastern node between which a mosaic can have data.
    fn nodes(
        &self,
        dem: &Dem,
        mosaic: &Mosaic,
        operation: &Operation,
    ) -> Result<[NodeIndex; 2], DemError> {
        if let Some(Alignment { first, way, every }) = self.alignment(mosaic) {
            let (low, high) = (mosaic.extent.min, mosaic.extent.max.map(|index| index - 1));
            let ends = |axis: usize| {
                let (a, b) =
                    (first[axis] + way[axis] * low[axis], first[axis] + way[axis] * high[axis]);
                // Rounded inwards: between two nodes there may be samples and no node.
                (-(-a.min(b)).div_euclid(every), a.max(b).div_euclid(every))
            };
            let ((west, east), (south, north)) = (ends(0), ends(1));
            return Ok([NodeIndex { i: west, j: south }, NodeIndex { i: east, j: north }]);
        }
        let mut bounds = Bounds::EMPTY;
        for file in &mosaic.files {
            let found = outline::bounds(mosaic, &file.rect, operation)?;
            if found.is_empty() {
                // Leaving it out would lose its heights in silence.
                let path = dem.sources[file.index].path.clone();
                let crs = self.working.crs.label.clone();
                return Err(DemError::FileOutsideCrs { path, crs });
            }
            bounds.include([found.min_x, found.min_y]);
            bounds.include([found.max_x, found.max_y]);
        }
        let cells =
            |metres: f64, axis: usize| (metres - self.origin_m[axis]) / self.cell.to_array()[axis];
        let corner = |x: f64, y: f64| NodeIndex { i: x as i64, j: y as i64 };
        Ok([
            corner(cells(bounds.min_x, 0).floor(), cells(bounds.min_y, 1).floor()),
            corner(cells(bounds.max_x, 0).ceil(), cells(bounds.max_y, 1).ceil()),
        ])
    }
}

fn resample(
    dem: &Dem,
    mosaic: &Mosaic,
    frame: &Frame,
    working: &Working,
    nodes: [NodeIndex; 2],
    steps: Option<[[f64; 2]; 2]>,
) -> Result<Method, DemError> {
    let cell = frame.cell();
    let samples_per_node = steps
        .map(|steps| samples_to_a_cell(steps, cell))
        .filter(|samples| samples.iter().all(|count| count.is_finite()))
        .unwrap_or([1.0; 2]);
    let most = samples_per_node[0].max(samples_per_node[1]);
    if most > MAX_SAMPLES_PER_NODE {
        return Err(DemError::Downsampling { cell, samples: most, limit: MAX_SAMPLES_PER_NODE });
    }
    let back = Operation::out_of_working(working, &mosaic.crs, Some(dem.wgs84_bounds));
    let least = samples_per_node[0].min(samples_per_node[1]);
    let positions = NodePositions::new(mosaic, back, frame, nodes, least)?;
    Ok(Method::Resampled(Box::new(positions), Kernel::new(samples_per_node)))
}

/// How nodes relate to samples. One grid is "the DEM"; of several each names its files, the first named first.
fn describe(dem: &Dem, layers: &[Layer]) -> String {
    let is_one = dem.mosaics.len() == 1;
    let mut texts: Vec<String> = Vec::new();
    for (mosaic, layer) in dem.mosaics.iter().zip(layers) {
        let whose = if is_one { String::new() } else { format!(" of {}", names(dem, mosaic)) };
        let text = match &layer.method {
            Method::Aligned(Alignment { every, .. }) => {
                let nodes =
                    if is_one { "nodes are the DEM's samples" } else { "nodes are the samples" };
                let share = match every {
                    1 => String::new(),
                    every => format!(", one in {every} along both axes"),
                };
                format!("{nodes}{whose}{share}")
            }
            Method::Resampled(positions, kernel) => {
                let how = if kernel.is_average() { "area average of" } else { "bilinear between" };
                let the = if is_one { "" } else { "the " };
                let step = positions.step();
                let exact = if step == 1 {
                    "every node transformed".to_owned()
                } else {
                    format!("positions interpolated over {step} × {step} nodes")
                };
                format!("{how} {the}samples{whose} in {}, {exact}", mosaic.crs.label)
            }
        };
        texts.push(text);
    }
    texts.join("; where those have no data: ")
}

/// Files on other grids than the first one's, whose samples are nodes, and the first one.
fn resampled_onto_first(dem: &Dem, layers: &[Layer]) -> Option<[String; 2]> {
    let is_resampled = |layer: &Layer| matches!(layer.method, Method::Resampled(..));
    let (_, others) = layers.split_first().filter(|(first, _)| !is_resampled(first))?;
    let told: Vec<String> = dem.mosaics[1..]
        .iter()
        .zip(others)
        .filter(|(_, layer)| is_resampled(layer))
        .map(|(mosaic, _)| names(dem, mosaic))
        .collect();
    (!told.is_empty()).then(|| [told.join(", "), names(dem, &dem.mosaics[0])])
}

/// The names of a mosaic's files, without folders.
fn names(dem: &Dem, mosaic: &Mosaic) -> String {
    let name = |file: &Placed| {
        let path = &dem.sources[file.index].path;
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    };
    let told: Vec<String> = mosaic.files.iter().take(MAX_NAMES).map(name).collect();
    match mosaic.files.len().saturating_sub(MAX_NAMES) {
        0 => told.join(", "),
        more => format!("{} and {more} more", told.join(", ")),
    }
}

fn libraries() -> String {
    let proj = VersionInfo::build_info()
        .remove("PROJ_RUNTIME_VERSION")
        .unwrap_or_else(|| "unknown".to_owned());
    format!("GDAL {}, PROJ {proj}", VersionInfo::release_name())
}
