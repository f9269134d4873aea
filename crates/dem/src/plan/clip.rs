//! Clips a DEM to the requested part: bounds in degrees become a rectangle of nodes, and one of the
//! samples that these nodes need.
//!
//! Working CRS, cell, phase and scale are chosen from the whole DEM before; bounds only select
//! nodes.

use std::sync::Arc;

use corniche_geom::{Bounds, Cell, GridFrame, MAX_LATTICE_STEPS, NodeIndex, Seam};
use corniche_gis::{Crs, CrsError, CrsOperation, GridCrs, PolygonError, RegionPolygons};

use crate::mosaics::data_extent::{moved_back, rim_and_inside, turns_beyond, unwrap, with_bend};
use crate::mosaics::mosaic::{Mosaic, MosaicFile, SampleRect};
use crate::plan::grid_plan::{GridPlan, Method, MosaicRole, PlanOptions};
use crate::plan::layout::{Layout, corner_nodes};
use crate::{Dem, GridError};

/// Bounds this close to a node, in cells, end at the node: the rounding error of transformations.
const ON_NODE: f64 = 1e-6;
/// The margin around the data, relative to their size and in degrees.
const ROOM: f64 = 0.01;
const LEAST_ROOM_DEG: f64 = 1e-3;
/// The margin around the samples under the requested nodes, against rounding.
const AROUND_SAMPLES: i64 = 2;

/// Bounds in WGS84 degrees (west, south, east, north) as a rectangle of nodes, its south-western
/// and north-eastern one, rounded outwards. They may reach beyond the data. `area_deg` is the
/// rectangle for which PROJ chooses its operation.
///
/// In a projected CRS, the result is the rectangle around the bounds' image, which is curved.
///
/// # Errors
/// When the bounds have no position in the CRS.
pub fn nodes_within(
    bounds_deg: [f64; 4],
    working: &GridCrs,
    area_deg: Bounds,
    origin_m: [f64; 2],
    cell: Cell,
) -> Result<[NodeIndex; 2], CrsError> {
    let [west, south, east, north] = around_the_earth_as(area_deg, continuous(bounds_deg));
    let mut points = rim_and_inside([west, north], [east, south]);
    let operation = CrsOperation::into_working(&Crs::wgs84()?, working, Some(area_deg));
    operation.around(None).apply(&mut points)?;
    if let Some(seam_m) = working.seam_m() {
        // The whole rectangle is moved next to the middle of the data.
        unwrap(&mut points, seam_m);
        let away = seam_m.turns(with_bend(&points).center()[0]);
        for point in &mut points {
            point[0] -= away * seam_m.turn();
        }
    }
    let bounds_m = with_bend(&points);
    if bounds_m.is_empty() {
        let crs = working.crs.label.clone();
        return Err(CrsError::BoundsOutside { bounds: bounds_text(bounds_deg), crs });
    }
    Ok(nodes_around(bounds_m, origin_m, cell))
}

/// A rectangle in working metres as a rectangle of nodes, rounded outwards.
fn nodes_around(bounds_m: Bounds, origin_m: [f64; 2], cell: Cell) -> [NodeIndex; 2] {
    // The limit keeps the conversion to integers within what a frame can have.
    corner_nodes(
        bounds_m,
        origin_m,
        cell,
        [
            |cells| (cells.clamp(-1e15, 1e15) + ON_NODE).floor(),
            |cells| (cells.clamp(-1e15, 1e15) - ON_NODE).ceil(),
        ],
    )
}

/// The requested part of a DEM: the nodes, and the text of the request.
pub(crate) struct RequestedArea {
    pub(crate) nodes: [NodeIndex; 2],
    text: String,
    bounds_deg: Option<[f64; 4]>,
}

impl RequestedArea {
    /// The intersection of bounds and polygon; `None` if neither is given.
    pub(crate) fn from_options(
        options: &PlanOptions,
        layout: &Layout,
        area_deg: Bounds,
    ) -> Result<Option<Self>, GridError> {
        let Layout { working, origin_m, cell, .. } = layout;
        let mut asked: Option<Self> = None;
        if let Some(bounds_deg) = options.bounds_deg {
            let nodes = nodes_within(bounds_deg, working, area_deg, *origin_m, *cell)?;
            let text = format!("--bounds {}", bounds_text(bounds_deg));
            asked = Some(Self { nodes, text, bounds_deg: Some(bounds_deg) });
        }
        if let Some(polygon) = &options.polygon {
            let bounds = working.polygon_bounds_m(polygon, area_deg, cell.shorter_m())?;
            let own = nodes_around(bounds, *origin_m, *cell);
            let text = format!("--polygon {:?}", polygon.path());
            asked = Some(match asked {
                Some(bounds) => Self {
                    nodes: common(bounds.nodes, own),
                    text: format!("what {} and {text} have in common", bounds.text),
                    ..bounds
                },
                None => Self { nodes: own, text, bounds_deg: None },
            });
        }
        Ok(asked)
    }
}

/// The same nodes, limited to the lattice.
pub(crate) fn on_lattice(frame: &GridFrame, nodes: [NodeIndex; 2]) -> [NodeIndex; 2] {
    let [most_i, most_j] =
        frame.node_steps(frame.max_level()).map(|steps| MAX_LATTICE_STEPS / steps);
    nodes.map(|NodeIndex { i, j }| NodeIndex {
        i: i.clamp(-most_i, most_i),
        j: j.clamp(-most_j, most_j),
    })
}

/// West, south, east and north; the east is beyond 180° if the bounds cross the antimeridian.
fn continuous([west, south, east, north]: [f64; 4]) -> [f64; 4] {
    [west, south, if west > east { east + 360.0 } else { east }, north]
}

/// Bounds that go around the whole earth clip nothing along the longitude: they become the bounds
/// of the data there, with a margin on all sides. Other bounds stay unchanged.
fn around_the_earth_as(area_deg: Bounds, [west, south, east, north]: [f64; 4]) -> [f64; 4] {
    if east - west < 360.0 {
        return [west, south, east, north];
    }
    let room = |size_deg: f64| ROOM * size_deg + LEAST_ROOM_DEG;
    let aside = room(area_deg.width()).min((360.0 - area_deg.width()) / 2.0).max(0.0);
    let up = room(area_deg.height());
    // Farther north and south than the data, the working CRS may end.
    let [low, high] = [(area_deg.min_y - up).max(-90.0), (area_deg.max_y + up).min(90.0)];
    let is_beside = north <= low || south >= high;
    let [south, north] =
        if is_beside { [south, north] } else { [south, north].map(|lat| lat.clamp(low, high)) };
    [area_deg.min_x - aside, south, area_deg.max_x + aside, north]
}

/// Bounds as given on the command line.
fn bounds_text(bounds_deg: [f64; 4]) -> String {
    bounds_deg.map(|deg| deg.to_string()).join(",")
}

/// The requested nodes of `whole`. Fails if these have no cell, or if the bounds lie at both ends
/// of data that go around the earth.
pub(crate) fn cut(
    asked: &RequestedArea,
    whole: [NodeIndex; 2],
    around_the_earth: Option<i64>,
    dem: &Dem,
) -> Result<[NodeIndex; 2], GridError> {
    let RequestedArea { nodes: asked, text, bounds_deg } = asked;
    let common = common(*asked, whole);
    let has_cell = |[low, high]: [NodeIndex; 2]| low.i < high.i && low.j < high.j;
    if let Some(columns) = around_the_earth {
        let moved = |by: i64| asked.map(|node| NodeIndex { i: node.i + by, j: node.j });
        // One column of cells at both ends is a rounding error.
        let is_at_other_end = |by: i64| {
            let [low, high] = self::common(moved(by), whole);
            high.i - low.i > 1 && low.j < high.j
        };
        if has_cell(common) && (is_at_other_end(columns) || is_at_other_end(-columns)) {
            return Err(GridError::BoundsAtBothEnds { asked: text.clone() });
        }
    }
    if has_cell(common) {
        return Ok(common);
    }
    let [west, south, east, north] = dem.wgs84_bounds.to_array();
    let swapped = bounds_deg
        .map(|[one, two, three, four]| [two, one, four, three])
        .filter(|own| own[0] < east && own[2] > west && own[1] < north && own[3] > south)
        .map(|own| format!("; {} has some", bounds_text(own)))
        .unwrap_or_default();
    Err(GridError::BoundsBesideData { asked: text.clone(), west, south, east, north, swapped })
}

/// The rectangle of nodes that two rectangles share; its corners are swapped if they share none.
pub(crate) fn common(a: [NodeIndex; 2], b: [NodeIndex; 2]) -> [NodeIndex; 2] {
    [
        NodeIndex { i: a[0].i.max(b[0].i), j: a[0].j.max(b[0].j) },
        NodeIndex { i: a[1].i.min(b[1].i), j: a[1].j.min(b[1].j) },
    ]
}

/// The rectangle in WGS84 degrees around a rectangle of nodes; across the antimeridian longitudes
/// continue beyond ±180, like those of the whole DEM.
pub(crate) fn wgs84_bounds(
    data: Bounds,
    working: &GridCrs,
    whole_deg: Bounds,
) -> Result<Bounds, GridError> {
    let own = rim_and_inside([data.min_x, data.max_y], [data.max_x, data.min_y]);
    let mut points = own.clone();
    let degrees = Seam::of_degrees();
    CrsOperation::out_of_working(working, &Crs::wgs84()?, Some(whole_deg)).apply(&mut points)?;
    if let Some(turn) = working.crs.turn_angle() {
        let to_degrees = 360.0 / turn / working.metres_per_unit[0];
        for (point, own) in points.iter_mut().zip(&own) {
            point[0] = degrees.around(own[0] * to_degrees).image(point[0]);
        }
    } else {
        unwrap(&mut points, degrees);
    }
    let bounds = Bounds::around(&points);
    if bounds.is_empty() {
        return Err(GridError::OutsideCrs { crs: working.crs.label.clone() });
    }
    let away = degrees.around(whole_deg.center()[0]).turns(bounds.center()[0]);
    let bounds = moved_back(bounds, away);
    Ok(moved_back(bounds, turns_beyond(bounds)))
}

/// The samples of a mosaic on which the plan's nodes depend, including those for filling voids: all
/// samples without bounds.
pub(crate) fn needed_samples(
    plan: &GridPlan,
    mosaic: &Mosaic,
    role: &MosaicRole,
) -> Result<SampleRect, CrsError> {
    if plan.clip.is_none() {
        return Ok(mosaic.reachable());
    }
    let reach = i64::from(plan.fill_voids) + 1;
    let (low, high) = (plan.south_west, plan.north_east);
    let nodes = [
        NodeIndex { i: low.i - reach, j: low.j - reach },
        NodeIndex { i: high.i + reach, j: high.j + reach },
    ];
    let (min, max) = match &role.method {
        Method::Aligned(alignment) => {
            let SampleRect { min, max } = alignment.samples(nodes);
            (min, max.map(|end| end - 1))
        }
        Method::Resampled(positions, kernel) => {
            let Bounds { min_x, min_y, max_x, max_y } = plan.frame.node_bounds_m(nodes);
            let mut points = rim_and_inside([min_x, max_y], [max_x, min_y]);
            positions.transform(&mut points)?;
            let bounds = with_bend(&points);
            if bounds.is_empty() {
                return Ok(mosaic.reachable());
            }
            let at = |value: f64| value.clamp(-1e15, 1e15) as i64;
            let reach = kernel.reach();
            (
                [at(bounds.min_x.floor()) - reach[0], at(bounds.min_y.floor()) - reach[1]],
                [at(bounds.max_x.ceil()) + reach[0], at(bounds.max_y.ceil()) + reach[1]],
            )
        }
    };
    let rect = SampleRect {
        min: min.map(|index| index - AROUND_SAMPLES),
        max: max.map(|index| index + AROUND_SAMPLES + 1),
    };
    Ok(rect.intersection(&mosaic.reachable()))
}

impl Dem {
    /// Tells for each file, in the given order, whether the plan's nodes can depend on its samples.
    /// Other files, outside the plan's bounds, were opened only to choose the grid.
    ///
    /// # Errors
    /// When PROJ fails.
    pub fn needed_files(&self, plan: &GridPlan) -> Result<Vec<bool>, CrsError> {
        let mut is_needed = vec![false; self.sources.len()];
        for (mosaic, role) in self.mosaics.iter().zip(&plan.roles.0) {
            let rect = needed_samples(plan, mosaic, role)?;
            for file in &mosaic.files {
                is_needed[file.index] = !parts_of_file(mosaic, file, &rect).is_empty();
            }
        }
        Ok(is_needed)
    }
}

/// The parts of a file, in its own pixels, within a rectangle of its mosaic's samples.
pub(crate) fn parts_of_file(
    mosaic: &Mosaic,
    file: &MosaicFile,
    needed: &SampleRect,
) -> Vec<SampleRect> {
    mosaic
        .images(file, needed)
        .into_iter()
        .map(|image| {
            let part = needed.intersection(&image);
            SampleRect {
                min: [0, 1].map(|axis| part.min[axis] - image.min[axis]),
                max: [0, 1].map(|axis| part.max[axis] - image.min[axis]),
            }
        })
        .collect()
}

impl GridPlan {
    /// This plan with all nodes of the elevation files, without bounds and polygon.
    #[must_use]
    pub fn of_whole_data(&self) -> Self {
        Self { clip: None, polygon: None, ..self.clone() }
    }

    /// This plan, without the nodes that are not corners of cells that the polygon touches. Its
    /// bounds stay.
    ///
    /// # Errors
    /// When the polygon has no position in the working CRS, or encloses no area.
    pub fn within(mut self, polygon: &RegionPolygons) -> Result<Self, PolygonError> {
        let region = self.working.polygon_on_lattice(polygon, self.area_deg(), &self.frame)?;
        self.polygon = Some(Arc::new(region));
        Ok(self)
    }
}
