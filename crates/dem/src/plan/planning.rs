//! Plans the grid of a package from a DEM and the user's options.

use corniche_geom::{ClipRecord, GridFrame, NodeIndex};
use corniche_gis::{CrsError, CrsOperation, DemProjection, libraries};

use crate::mosaics::mosaic::Mosaic;
use crate::plan::clip::{self, RequestedArea};
use crate::plan::datum_operations::datum_operations;
use crate::plan::description::{describe, resampled_onto_first};
use crate::plan::grid_plan::{GridPlan, Method, MosaicRole, MosaicRoles, PlanOptions, Resampling};
use crate::plan::kernel::Kernel;
use crate::plan::layout::{self, Layout};
use crate::plan::node_positions::NodePositions;
use crate::plan::sample_steps::{samples_to_a_cell, steps_m};
use crate::plan::working_crs;
use crate::{Dem, GridError};

/// The largest number of samples averaged along a side of a cell; it bounds the memory for one
/// node.
const MAX_SAMPLES_PER_NODE: f64 = 1000.0;
/// The largest distance for filling voids; it bounds the halo.
const MAX_FILL_VOIDS: u32 = 1024;

impl Dem {
    /// Chooses working CRS, cell and extent.
    ///
    /// - Working CRS: `options.crs`; else the first file's own, if lengths in working metres are
    ///   then true within 3 % all over the data; else the UTM zone of the centre, if it is true to
    ///   scale within 1 % all over the data and the data lie between 80° S and 84° N; else the
    ///   Lambert azimuthal equal-area projection about the centre.
    /// - Working metres are its coordinates times two factors. In degrees: metres per degree at the
    ///   standard latitude, by the radii of curvature of the ellipsoid. In a projection: its unit,
    ///   where that is true to scale within 1 % along both axes and all over the data; else the
    ///   unit divided by the scale along each axis, at the standard latitude and the middle
    ///   longitude. Axes that count westwards or southwards are reversed. The standard latitude is
    ///   the middle of the data to half a degree, or `options.scale_latitude_deg`; with a given
    ///   latitude, only the scale there, at the middle longitude, decides whether a projection
    ///   keeps its unit.
    /// - Cell: `options.cell`; else the spacing of the first file's samples, a rectangle; where
    ///   that file is in another CRS or turned against it, a square with the shorter spacing as
    ///   side (two significant digits in another CRS).
    /// - Bounds: `options.bounds_deg` and `options.polygon` only remove nodes. All of the above is
    ///   chosen from the whole DEM.
    /// - Where the cell is the spacing of the first file's samples, or a multiple by
    ///   `options.cell_every`, nodes coincide with samples; otherwise node (0, 0) is at the
    ///   origin of the CRS. Files on other grids are resampled.
    ///
    /// # Errors
    /// When the options are not usable, the files lie outside the CRS or the bounds, or the grid is
    /// too large.
    pub fn plan(&self, options: &PlanOptions) -> Result<GridPlan, GridError> {
        if options.fill_voids > MAX_FILL_VOIDS {
            return Err(GridError::FillVoids { cells: options.fill_voids, limit: MAX_FILL_VOIDS });
        }
        let working =
            working_crs::choose(self, options.crs.as_deref(), options.scale_latitude_deg)?;
        let layout = layout::layout(self, options, working)?;
        let scale = working_crs::scale(&layout.working, self)?;
        let into_working = |mosaic: &Mosaic| {
            CrsOperation::into_working(&mosaic.crs, &layout.working, Some(self.wgs84_bounds))
        };
        let operations: Vec<CrsOperation> = self.mosaics.iter().map(into_working).collect();
        let steps: Vec<Option<[[f64; 2]; 2]>> = self
            .mosaics
            .iter()
            .zip(&operations)
            .map(|(mosaic, operation)| steps_m(mosaic, &layout.working, operation))
            .collect::<Result<_, _>>()?;
        let extents: Vec<[NodeIndex; 2]> = self
            .mosaics
            .iter()
            .zip(&operations)
            .map(|(mosaic, operation)| layout.nodes(self, mosaic, operation))
            .collect::<Result<_, _>>()?;
        let [south_west, north_east] = around(&extents)
            .ok_or_else(|| GridError::OutsideCrs { crs: layout.working.crs.label.clone() })?;
        if let Some(every) = options.cell_every {
            refuse_line(every, [south_west, north_east])?;
        }
        let whole = [south_west, north_east];
        let area_deg = self.wgs84_bounds;
        let asked = RequestedArea::from_options(options, &layout, self.wgs84_bounds)?;
        let [south_west, north_east] = match &asked {
            Some(asked) => clip::cut(asked, whole, columns_of_a_turn(&layout), self)?,
            None => whole,
        };
        let frame = GridFrame::covering(layout.origin_m, layout.cell, south_west, north_east)?;
        let datum_operations = datum_operations(self, &layout.working, frame.node_bounds_m(whole))?;
        let roles: Vec<MosaicRole> = self
            .mosaics
            .iter()
            .zip(operations)
            .zip(extents)
            .zip(steps)
            .map(|(((mosaic, working_from_crs), nodes), steps)| {
                let method = method(self, mosaic, &layout, &frame, nodes, steps)?;
                Ok(MosaicRole { nodes, method, working_from_crs })
            })
            .collect::<Result<_, GridError>>()?;
        let working = layout.working;
        let data_bounds = frame.node_bounds_m([south_west, north_east]);
        let clip = asked.map(|asked| ClipRecord {
            nodes: clip::on_lattice(&frame, asked.nodes),
            whole_data_bounds: frame.node_bounds_m(whole),
            whole_wgs84_bounds: area_deg,
        });
        let wgs84_bounds = match clip {
            Some(_) => clip::wgs84_bounds(data_bounds, &working, area_deg)?,
            None => area_deg,
        };
        let plan = GridPlan {
            frame,
            south_west,
            north_east,
            crs: working.crs.label.clone(),
            crs_wkt: working.crs.wkt.to_string(),
            metres_per_unit: working.metres_per_unit,
            point_scale: (scale.center[0] * scale.center[1]).sqrt(),
            scale,
            clip,
            polygon: None,
            data_bounds,
            wgs84_bounds,
            resampling: resampling(&roles),
            resampling_text: describe(self, &roles),
            resampled_onto_first: resampled_onto_first(self, &roles),
            vertical_datum: self.heights.datum.clone(),
            vertical: self.heights.conversion.clone(),
            datum_operations,
            libraries: libraries(),
            fill_voids: options.fill_voids,
            roles: MosaicRoles(roles),
            working,
        };
        match &options.polygon {
            Some(polygon) => Ok(plan.within(polygon)?),
            None => Ok(plan),
        }
    }

    /// WGS84 ⇄ the plan's working CRS. May be sent to and shared between threads.
    ///
    /// # Errors
    /// When PROJ knows no operation.
    pub fn projection(&self, plan: &GridPlan) -> Result<DemProjection, CrsError> {
        // The middle of the recorded rectangle, so that all readers of the package use the same
        // seam.
        let data_m = plan.clip.map_or(plan.data_bounds, |clip| clip.whole_data_bounds);
        let working = plan.working.clone().around(data_m);
        DemProjection::new(&working, plan.area_deg(), plan.wgs84_bounds)
    }
}

/// The south-western and the north-eastern node around those of all mosaics.
fn around(extents: &[[NodeIndex; 2]]) -> Option<[NodeIndex; 2]> {
    extents.iter().copied().reduce(|[sw, ne], [low, high]| {
        [
            NodeIndex { i: sw.i.min(low.i), j: sw.j.min(low.j) },
            NodeIndex { i: ne.i.max(high.i), j: ne.j.max(high.j) },
        ]
    })
}

/// The number of columns of nodes all around the earth, rounded; `None` if x never repeats.
fn columns_of_a_turn(layout: &Layout) -> Option<i64> {
    let seam_m = layout.working.seam_m()?;
    Some((seam_m.turn() / layout.cell.east_m).round() as i64)
}

/// Rejects a request for so few samples that a single row or column of nodes is left.
fn refuse_line(every: u32, [south_west, north_east]: [NodeIndex; 2]) -> Result<(), GridError> {
    let [columns, rows] = [north_east.i - south_west.i + 1, north_east.j - south_west.j + 1];
    if columns.min(rows) >= 2 {
        return Ok(());
    }
    let [columns, rows] = [columns, rows].map(|nodes| nodes.max(0));
    Err(GridError::CellEveryLeaves { every, columns, rows })
}

fn resampling(roles: &[MosaicRole]) -> Resampling {
    let is_every_sample =
        |role: &MosaicRole| matches!(role.method, Method::Aligned(found) if found.every == 1);
    let is_aligned = |role: &MosaicRole| matches!(role.method, Method::Aligned(_));
    if roles.iter().all(is_every_sample) {
        Resampling::Aligned
    } else if roles.iter().all(is_aligned) {
        Resampling::Thinned
    } else {
        Resampling::Resampled
    }
}

/// The method by which a mosaic's samples become heights of nodes.
fn method(
    dem: &Dem,
    mosaic: &Mosaic,
    layout: &Layout,
    frame: &GridFrame,
    nodes: [NodeIndex; 2],
    steps: Option<[[f64; 2]; 2]>,
) -> Result<Method, GridError> {
    if let Some(alignment) = layout.alignment(mosaic) {
        return Ok(Method::Aligned(alignment));
    }
    let cell = frame.cell();
    let samples_per_node = steps
        .map(|steps| samples_to_a_cell(steps, cell))
        .filter(|samples| samples.iter().all(|count| count.is_finite()))
        .unwrap_or([1.0; 2]);
    let most = samples_per_node[0].max(samples_per_node[1]);
    if most > MAX_SAMPLES_PER_NODE {
        return Err(GridError::Downsampling { cell, samples: most, limit: MAX_SAMPLES_PER_NODE });
    }
    let back = mosaic.crs_from_working(&layout.working, dem.wgs84_bounds);
    let least = samples_per_node[0].min(samples_per_node[1]);
    let positions = NodePositions::new(mosaic, back, frame, nodes, least)?;
    Ok(Method::Resampled(Box::new(positions), Kernel::new(samples_per_node)))
}
