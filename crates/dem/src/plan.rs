//! The grid of a package: working CRS, cell, extent.

use corniche_geom::{Bounds, Frame, NodeIndex};
use gdal::errors::GdalError;
use gdal::spatial_ref::SpatialRef;
use gdal::version::VersionInfo;

use crate::crs::Crs;
use crate::kernel::Kernel;
use crate::mosaic::Mosaic;
use crate::operation::Operation;
use crate::positions::NodePositions;
use crate::{Dem, DemError, outline, scale};

/// A CRS within this of true scale serves as working CRS; of the DEM's own at the centre, of UTM all over.
const SCALE_TOLERANCE: f64 = 0.01;
/// Nodes coincide with samples when none is farther off than this, in cells.
const ALIGNED_CELLS: f64 = 1e-3;
/// Rounding of a grid's phase: a micrometre hides the noise of corner coordinates and moves nothing.
const PHASE_STEPS_PER_M: f64 = 1e6;
/// UTM is defined between these latitudes.
const UTM_LATITUDES_DEG: [f64; 2] = [-80.0, 84.0];
/// Most samples averaged along a side of a cell; bounds the memory that one node can ask for.
const MAX_SAMPLES_PER_NODE: f64 = 1000.0;
/// Farthest that voids can be filled; bounds the halo.
const MAX_FILL_VOIDS: u32 = 1024;

/// What the user may say about the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// Working CRS; `None` chooses one.
    pub crs: Option<String>,
    /// Spacing of the nodes; `None` takes the DEM's.
    pub cell_m: Option<f64>,
    /// A void is filled from data within this many cells; 0 fills nothing.
    pub fill_voids: u32,
}

/// Whether nodes are the DEM's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resampling {
    /// Every node is a sample: nothing is resampled.
    Aligned,
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
    /// Length in the working CRS over true length, at the centre.
    pub point_scale: f64,
    /// Rectangle of the nodes from `south_west` to `north_east`, metres in the working CRS.
    pub data_bounds: Bounds,
    /// Rectangle around the files in WGS84 degrees. Past the antimeridian longitudes go on beyond ±180.
    pub wgs84_bounds: Bounds,
    /// Which case it is.
    pub case: Resampling,
    /// The case in words.
    pub resampling: String,
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
    pub(crate) working: Crs,
}

/// How one mosaic serves nodes.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    /// South-western and north-eastern node between which it can have data.
    pub(crate) nodes: [NodeIndex; 2],
    pub(crate) method: Method,
    /// From the mosaic's CRS to the working one.
    pub(crate) working_from_crs: Operation,
}

#[derive(Debug, Clone)]
pub(crate) enum Method {
    Aligned(Alignment),
    Resampled(Box<NodePositions>, Kernel),
}

/// Sample (column, row) = (`way[0]` · (i − `first.i`), `way[1]` · (j − `first.j`)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Alignment {
    pub(crate) first: NodeIndex,
    pub(crate) way: [i64; 2],
}

pub(crate) fn plan(dem: &Dem, options: &PlanOptions) -> Result<GridPlan, DemError> {
    if options.fill_voids > MAX_FILL_VOIDS {
        return Err(DemError::FillVoids { cells: options.fill_voids, limit: MAX_FILL_VOIDS });
    }
    let (working, point_scale) = working_crs(dem, options.crs.as_deref())?;
    let operations: Vec<Operation> = dem
        .mosaics
        .iter()
        .map(|mosaic| Operation::new(&mosaic.crs, &working, Some(dem.wgs84_bounds)))
        .collect();
    let spacings: Vec<Option<[f64; 2]>> = dem
        .mosaics
        .iter()
        .zip(&operations)
        .map(|(mosaic, operation)| spacing_m(mosaic, &working, operation))
        .collect::<Result<_, _>>()?;
    let cell_m = cell_m(dem, options, &working, &spacings)?;
    let origin_m =
        dem.mosaics.iter().find_map(|mosaic| phase_m(mosaic, &working, cell_m)).unwrap_or([0.0; 2]);
    let grid = Grid { working: &working, origin_m, cell_m };
    let extents: Vec<[NodeIndex; 2]> = dem
        .mosaics
        .iter()
        .zip(&operations)
        .map(|(mosaic, operation)| grid.nodes(dem, mosaic, operation))
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
        .ok_or_else(|| DemError::OutsideCrs { crs: working.label.clone() })?;
    let frame = Frame::covering(origin_m, cell_m, south_west, north_east)?;
    let mut layers = Vec::new();
    for (((mosaic, working_from_crs), nodes), spacing) in
        dem.mosaics.iter().zip(operations).zip(extents).zip(spacings)
    {
        let method = match grid.alignment(mosaic) {
            Some(alignment) => Method::Aligned(alignment),
            None => resample(dem, mosaic, &frame, &working, nodes, spacing)?,
        };
        layers.push(Layer { nodes, method, working_from_crs });
    }
    let is_aligned = |layer: &Layer| matches!(layer.method, Method::Aligned(_));
    Ok(GridPlan {
        frame,
        south_west,
        north_east,
        crs: working.label.clone(),
        crs_wkt: working.wkt.to_string(),
        point_scale,
        data_bounds: Bounds {
            min_x: frame.x_m(south_west.i),
            min_y: frame.y_m(south_west.j),
            max_x: frame.x_m(north_east.i),
            max_y: frame.y_m(north_east.j),
        },
        wgs84_bounds: dem.wgs84_bounds,
        case: if layers.iter().all(is_aligned) {
            Resampling::Aligned
        } else {
            Resampling::Resampled
        },
        resampling: describe(dem, &layers),
        vertical_datum: dem.heights.datum.clone(),
        vertical: dem.heights.words.clone(),
        libraries: libraries(),
        fill_voids: options.fill_voids,
        layers,
        working,
    })
}

/// The working CRS and its scale at the centre.
fn working_crs(dem: &Dem, asked: Option<&str>) -> Result<(Crs, f64), DemError> {
    if let Some(text) = asked {
        let (crs, _) = Crs::from_text("--crs", text)?;
        let refuse = || DemError::WorkingCrs { text: text.to_owned() };
        if !(crs.is_projected() && crs.is_metric()) {
            return Err(refuse());
        }
        let scale = scale_at(dem, &crs, &[dem.center_deg])?
            .ok_or_else(|| DemError::OutsideCrs { crs: crs.label.clone() })?;
        return if scale.deviation.is_finite() { Ok((crs, scale.mean)) } else { Err(refuse()) };
    }
    let own = &dem.mosaics[0].crs;
    let is_usable = own.is_projected() && own.is_metric() && !own.is_web_mercator;
    let own_scale = if is_usable { scale_at(dem, own, &[dem.center_deg])? } else { None };
    if let Some(scale) = own_scale.filter(|scale| scale.deviation <= SCALE_TOLERANCE) {
        return Ok((own.clone(), scale.mean));
    }
    let bounds = dem.wgs84_bounds;
    if bounds.min_y >= UTM_LATITUDES_DEG[0] && bounds.max_y <= UTM_LATITUDES_DEG[1] {
        let [lon, lat] = dem.center_deg;
        let zone = (((lon + 180.0) / 6.0).floor() as u32).min(59) + 1;
        let code = if lat < 0.0 { 32700 } else { 32600 } + zone;
        let (utm, _) = Crs::from_text("the chosen", &format!("EPSG:{code}"))?;
        let far = scale_at(dem, &utm, &rim_deg(bounds))?;
        if far.is_some_and(|scale| scale.deviation <= SCALE_TOLERANCE)
            && let Some(scale) = scale_at(dem, &utm, &[dem.center_deg])?
        {
            return Ok((utm, scale.mean));
        }
    }
    equal_area(dem)
}

/// Lambert azimuthal equal-area about the data's centre, rounded to whole degrees so that small changes of the
/// extent leave the grid where it is.
fn equal_area(dem: &Dem) -> Result<(Crs, f64), DemError> {
    let [lon, lat] = dem.center_deg.map(f64::round);
    let text = format!(
        "+proj=laea +lat_0={lat} +lon_0={lon} +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"
    );
    let reference = SpatialRef::from_proj4(&text).map_err(|source: GdalError| {
        DemError::CrsText { option: "the chosen", text, source: source.into() }
    })?;
    let mut crs = Crs::from_spatial_ref(&reference)?;
    crs.label = format!("Lambert azimuthal equal-area about {lat}, {lon}");
    let scale = scale_at(dem, &crs, &[dem.center_deg])?;
    let scale = scale.ok_or_else(|| DemError::OutsideCrs { crs: crs.label.clone() })?;
    Ok((crs, scale.mean))
}

/// Corners and middles of the sides.
fn rim_deg(bounds: Bounds) -> Vec<[f64; 2]> {
    let [x, y] = bounds.center();
    let (xs, ys) = ([bounds.min_x, x, bounds.max_x], [bounds.min_y, y, bounds.max_y]);
    xs.iter().flat_map(|&x| ys.map(|y| [x, y])).collect()
}

/// The scale farthest from 1 at the given places; `None` when one of them lies outside the CRS.
fn scale_at(
    dem: &Dem,
    crs: &Crs,
    places_deg: &[[f64; 2]],
) -> Result<Option<scale::Scale>, DemError> {
    let wgs84 = Crs::wgs84()?;
    let mut points = places_deg.to_vec();
    Operation::new(&wgs84, crs, Some(dem.wgs84_bounds)).apply(&mut points)?;
    let scales = scale::scales(&Operation::new(crs, &wgs84, Some(dem.wgs84_bounds)), &points)?;
    let all: Option<Vec<scale::Scale>> = scales.into_iter().collect();
    Ok(all.and_then(|all| {
        all.into_iter().reduce(|a, b| if b.deviation > a.deviation { b } else { a })
    }))
}

/// Spacing of a mosaic's columns and rows in the working CRS, at its centre; `None` outside the CRS.
pub(crate) fn spacing_m(
    mosaic: &Mosaic,
    working: &Crs,
    operation: &Operation,
) -> Result<Option<[f64; 2]>, DemError> {
    let c = mosaic.crs_from_sample.coefficients;
    if mosaic.crs.is_same(working) {
        return Ok(Some([c[1].hypot(c[4]), c[2].hypot(c[5])]));
    }
    let [x, y] =
        [0, 1].map(|axis| (mosaic.extent.min[axis] + mosaic.extent.max[axis] - 1) as f64 / 2.0);
    let ends = [[x - 0.5, y], [x + 0.5, y], [x, y - 0.5], [x, y + 0.5]];
    let mut ends = ends.map(|sample| mosaic.crs_from_sample.crs_from_pixel(sample));
    operation.apply(&mut ends)?;
    let length = |from: [f64; 2], to: [f64; 2]| (to[0] - from[0]).hypot(to[1] - from[1]);
    let spacing = [length(ends[0], ends[1]), length(ends[2], ends[3])];
    Ok(spacing.iter().all(|metres| metres.is_finite() && *metres > 0.0).then_some(spacing))
}

/// The cell: as asked, else the finest spacing of all mosaics, so that none loses detail.
fn cell_m(
    dem: &Dem,
    options: &PlanOptions,
    working: &Crs,
    spacings: &[Option<[f64; 2]>],
) -> Result<f64, DemError> {
    if let Some(cell_m) = options.cell_m {
        return if (0.001..=1e6).contains(&cell_m) {
            Ok(cell_m)
        } else {
            Err(DemError::Cell { cell_m })
        };
    }
    let finest = dem
        .mosaics
        .iter()
        .zip(spacings)
        .filter_map(|(mosaic, spacing)| spacing.map(|[across, down]| (mosaic, across.min(down))))
        .reduce(|a, b| if b.1 < a.1 { b } else { a });
    let (mosaic, spacing_m) =
        finest.ok_or_else(|| DemError::OutsideCrs { crs: working.label.clone() })?;
    if !mosaic.crs.is_same(working) {
        return Ok(rounded(spacing_m, 2));
    }
    // The DEM's own spacing, less the noise of its division by whoever wrote the file.
    let nice_m = rounded(spacing_m, 9);
    let reach = mosaic.extent.columns().max(mosaic.extent.rows()) as f64;
    let is_noise = (nice_m - spacing_m).abs() * reach <= 1e-4 * spacing_m;
    Ok(if is_noise { nice_m } else { spacing_m })
}

/// A number rounded to so many significant decimal digits.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// Position of the grid's node (0, 0) for a mosaic whose samples are to be the nodes, within one cell of the
/// CRS's zero; `None` when CRS or cell differ.
fn phase_m(mosaic: &Mosaic, working: &Crs, cell_m: f64) -> Option<[f64; 2]> {
    let c = mosaic.crs_from_sample.coefficients;
    let phase = [c[0], c[3]].map(|metres| {
        let phase = (metres.rem_euclid(cell_m) * PHASE_STEPS_PER_M).round() / PHASE_STEPS_PER_M;
        if cell_m - phase < 1.0 / PHASE_STEPS_PER_M { 0.0 } else { phase }
    });
    Grid { working, origin_m: phase, cell_m }.alignment(mosaic).map(|_| phase)
}

struct Grid<'a> {
    working: &'a Crs,
    origin_m: [f64; 2],
    cell_m: f64,
}

impl Grid<'_> {
    /// How the mosaic's samples are nodes; `None` when they are not.
    fn alignment(&self, mosaic: &Mosaic) -> Option<Alignment> {
        let transform = &mosaic.crs_from_sample;
        if !transform.is_axis_parallel() || !mosaic.crs.is_same(self.working) {
            return None;
        }
        let cells = |sample: [i64; 2]| {
            let at = transform.crs_from_pixel(sample.map(|index| index as f64));
            [0, 1].map(|axis| (at[axis] - self.origin_m[axis]) / self.cell_m)
        };
        let way =
            [transform.coefficients[1], transform.coefficients[5]].map(|step| step.signum() as i64);
        let [i, j] = cells([0, 0]).map(|cells| cells.round() as i64);
        let (low, high) = (mosaic.extent.min, mosaic.extent.max.map(|index| index - 1));
        let fits = [low, high].iter().all(|&sample| {
            let at = cells(sample);
            let off =
                [at[0] - (i + way[0] * sample[0]) as f64, at[1] - (j + way[1] * sample[1]) as f64];
            off.iter().all(|off| off.abs() <= ALIGNED_CELLS)
        });
        // A single row or column says nothing of its own spacing; both must be the cell.
        let c = transform.coefficients;
        let is_square =
            [c[1], c[5]].iter().all(|step| (step.abs() / self.cell_m - 1.0).abs() <= ALIGNED_CELLS);
        (fits && is_square).then_some(Alignment { first: NodeIndex { i, j }, way })
    }

    /// South-western and north-eastern node between which a mosaic can have data.
    fn nodes(
        &self,
        dem: &Dem,
        mosaic: &Mosaic,
        operation: &Operation,
    ) -> Result<[NodeIndex; 2], DemError> {
        if let Some(Alignment { first, way }) = self.alignment(mosaic) {
            let (low, high) = (mosaic.extent.min, mosaic.extent.max.map(|index| index - 1));
            let ends = |axis: usize, first: i64| {
                let (a, b) = (first + way[axis] * low[axis], first + way[axis] * high[axis]);
                (a.min(b), a.max(b))
            };
            let ((west, east), (south, north)) = (ends(0, first.i), ends(1, first.j));
            return Ok([NodeIndex { i: west, j: south }, NodeIndex { i: east, j: north }]);
        }
        let mut bounds = Bounds::EMPTY;
        for file in &mosaic.files {
            let found = outline::bounds(mosaic, &file.rect, operation)?;
            if found.is_empty() {
                // Leaving it out would lose its heights in silence.
                let path = dem.sources[file.index].path.clone();
                return Err(DemError::FileOutsideCrs { path, crs: self.working.label.clone() });
            }
            bounds.include([found.min_x, found.min_y]);
            bounds.include([found.max_x, found.max_y]);
        }
        let cells = |metres: f64, axis: usize| (metres - self.origin_m[axis]) / self.cell_m;
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
    working: &Crs,
    nodes: [NodeIndex; 2],
    spacing: Option<[f64; 2]>,
) -> Result<Method, DemError> {
    let cell_m = frame.cell_m();
    let samples_per_node =
        spacing.map_or([1.0; 2], |spacing| spacing.map(|spacing_m| cell_m / spacing_m));
    let most = samples_per_node[0].max(samples_per_node[1]);
    if most > MAX_SAMPLES_PER_NODE {
        return Err(DemError::Downsampling { cell_m, samples: most, limit: MAX_SAMPLES_PER_NODE });
    }
    let back = Operation::new(working, &mosaic.crs, Some(dem.wgs84_bounds));
    let least = samples_per_node[0].min(samples_per_node[1]);
    let positions = NodePositions::new(mosaic, back, frame, nodes, least)?;
    Ok(Method::Resampled(Box::new(positions), Kernel::new(samples_per_node)))
}

fn describe(dem: &Dem, layers: &[Layer]) -> String {
    let mut texts: Vec<String> = Vec::new();
    for (mosaic, layer) in dem.mosaics.iter().zip(layers) {
        let text = match &layer.method {
            Method::Aligned(_) => "nodes are the DEM's samples".to_owned(),
            Method::Resampled(positions, kernel) => {
                let how = if kernel.is_average() { "area average of" } else { "bilinear between" };
                let step = positions.step();
                let exact = if step == 1 {
                    "every node transformed".to_owned()
                } else {
                    format!("positions interpolated over {step} × {step} nodes")
                };
                format!("{how} samples in {}, {exact}", mosaic.crs.label)
            }
        };
        if !texts.contains(&text) {
            texts.push(text);
        }
    }
    texts.join("; where the former have no data: ")
}

fn libraries() -> String {
    let proj = VersionInfo::build_info()
        .remove("PROJ_RUNTIME_VERSION")
        .unwrap_or_else(|| "unknown".to_owned());
    format!("GDAL {}, PROJ {proj}", VersionInfo::release_name())
}
