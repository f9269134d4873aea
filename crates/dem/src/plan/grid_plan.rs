//! The plan of a package's grid: its nodes, its CRS, and how each mosaic is used for its heights.

use std::sync::Arc;

use corniche_geom::{Bounds, Cell, ClipRecord, GridFrame, LatticeRegion, NodeIndex, ScaleRecord};
use corniche_gis::{CrsOperation, DatumOperation, GridCrs, RegionPolygons};

use crate::plan::kernel::{Alignment, Kernel};
use crate::plan::node_positions::NodePositions;

/// The user's options for the grid. The default sets no option, and fills no voids.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanOptions {
    /// Working CRS: "dem" (the first file's own), "utm" (each regardless of distortion), "EPSG:n"
    /// or WKT; `None` chooses one.
    pub crs: Option<String>,
    /// Spacing of the nodes in working metres; `None` uses that of the DEM.
    pub cell: Option<Cell>,
    /// Use every n-th sample along both axes as a node: those whose indices, counted like the
    /// tiles, are multiples of n. Not together with `cell`.
    pub cell_every: Option<u32>,
    /// Latitude at which lengths in the DEM's own CRS are true; `None` uses the data's middle, to
    /// half a degree.
    pub scale_latitude_deg: Option<f64>,
    /// A void is filled from data within this many cells; 0 fills nothing.
    pub fill_voids: u32,
    /// Only the ground within these bounds is built: west, south, east and north in WGS84 degrees,
    /// across ±180° if the west is larger than the east. `None` builds all. All other choices are
    /// the same as without bounds, so that nodes have the same heights.
    pub bounds_deg: Option<[f64; 4]>,
    /// Only the ground under this polygon is built: nodes that are corners of cells that the
    /// polygon touches. With `bounds_deg`, both conditions apply.
    pub polygon: Option<RegionPolygons>,
}

/// Whether nodes are the DEM's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resampling {
    /// Nodes are samples, and samples are nodes: nothing is resampled.
    Aligned,
    /// Nodes are samples, but only every n-th sample is a node.
    Thinned,
    /// Heights at nodes are interpolated or averaged, at least from some files.
    Resampled,
}

/// The grid of a package, and how its heights are computed.
#[derive(Debug, Clone)]
pub struct GridPlan {
    /// Nodes, tiles and levels.
    pub frame: GridFrame,
    /// The south-westernmost node at which data can lie.
    pub south_west: NodeIndex,
    /// The north-easternmost node at which data can lie.
    pub north_east: NodeIndex,
    /// The working CRS: "EPSG:…" if it has a code, else its name.
    pub crs: String,
    /// The working CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres per unit of the CRS's coordinates, east and north. Negative for an axis that
    /// counts westwards or southwards.
    pub metres_per_unit: [f64; 2],
    /// Working metres per true metre at the centre: the geometric mean of both axes.
    pub point_scale: f64,
    /// The scale along each axis, at the centre and over the data's rim.
    pub scale: ScaleRecord,
    /// The requested part; `None` for all of the data.
    pub clip: Option<ClipRecord>,
    /// The requested polygon, on the lattice.
    pub polygon: Option<Arc<LatticeRegion>>,
    /// The rectangle of the nodes from `south_west` to `north_east`, in working metres.
    pub data_bounds: Bounds,
    /// The rectangle around the files, or around the requested part, in WGS84 degrees. Beyond the
    /// antimeridian longitudes continue beyond ±180.
    pub wgs84_bounds: Bounds,
    /// Whether nodes are the DEM's samples.
    pub resampling: Resampling,
    /// A description of how nodes relate to samples.
    pub resampling_text: String,
    /// The names, without folders, of the files that are resampled onto the grid of the first one,
    /// and of the first one. `None` if no file is resampled, or all are.
    pub resampled_onto_first: Option<[String; 2]>,
    /// The vertical datum of the resulting heights, as far as files or options name it.
    pub vertical_datum: Option<String>,
    /// The conversion of the files' heights, in words; with the offset at the DEM's centre if PROJ
    /// converted them.
    pub vertical: String,
    /// The datum operations: from the datum of the working CRS to WGS84, and from those of files
    /// with another CRS to the working CRS. Empty if all datums are that of WGS84.
    pub datum_operations: Vec<DatumOperation>,
    /// The releases of GDAL and PROJ, on which the heights' last bits depend.
    pub libraries: String,
    /// A void is filled from data within this many cells.
    pub fill_voids: u32,
    /// How samples become heights; empty in the plan of a package without its elevation files, with
    /// which no height can be read.
    pub roles: MosaicRoles,
    /// The working CRS.
    pub working: GridCrs,
}

/// The roles of the DEM's mosaics for the grid, in the order of the mosaics.
#[derive(Debug, Clone, Default)]
pub struct MosaicRoles(pub(crate) Vec<MosaicRole>);

/// The role of one mosaic for the grid: the nodes for which it can have data, and how.
#[derive(Debug, Clone)]
pub(crate) struct MosaicRole {
    /// The south-western and the north-eastern node between which the mosaic can have data.
    pub(crate) nodes: [NodeIndex; 2],
    pub(crate) method: Method,
    /// The operation from the mosaic's CRS to working metres.
    pub(crate) working_from_crs: CrsOperation,
}

#[derive(Debug, Clone)]
pub(crate) enum Method {
    Aligned(Alignment),
    Resampled(Box<NodePositions>, Kernel),
}

impl GridPlan {
    /// The rectangle in degrees for which PROJ's operations are chosen: the one around all files,
    /// even if the plan covers only a part of them.
    #[must_use]
    pub fn area_deg(&self) -> Bounds {
        self.clip.map_or(self.wgs84_bounds, |clip| clip.whole_wgs84_bounds)
    }

    /// Whether the DEM's samples and the package's nodes are the same points.
    #[must_use]
    pub fn nodes_are_samples(&self) -> bool {
        self.resampling == Resampling::Aligned
    }

    /// Whether working metres depend on the standard latitude: in UTM and in projections that are
    /// true to scale they do not, and `--scale-latitude` has no effect.
    #[must_use]
    pub fn has_standard_latitude(&self) -> bool {
        self.working.is_scaled
    }

    /// The distance of the poles from zero along y, in working metres, if the working CRS is in
    /// degrees; `None` for a projection. Positions beyond the poles have no longitude.
    #[must_use]
    pub fn poles_y_m(&self) -> Option<f64> {
        self.working.crs.turn_angle().map(|turn| turn / 4.0 * self.metres_per_unit[1].abs())
    }
}
