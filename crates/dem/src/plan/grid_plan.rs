//! The plan of a package's grid: its nodes, its CRS, and what each mosaic does for its heights.

use std::sync::Arc;

use corniche_geom::{Bounds, Cell, ClipRecord, GridFrame, LatticeRegion, NodeIndex, ScaleRecord};
use corniche_gis::{CrsOperation, DatumOperation, GridCrs, Polygon};

use crate::plan::kernel::{Alignment, Kernel};
use crate::plan::node_positions::NodePositions;

/// What the user can choose about the grid. The default chooses nothing, and fills no voids.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanOptions {
    /// Working CRS: "dem" (the first file's own), "utm" (both in any case), "EPSG:n" or WKT; `None`
    /// chooses one.
    pub crs: Option<String>,
    /// Spacing of the nodes, working metres; `None` takes the DEM's.
    pub cell: Option<Cell>,
    /// Take every n-th sample along both axes as node, of those whose indices, counted as tiles are
    /// aligned, are multiples of n. Not together with `cell`.
    pub cell_every: Option<u32>,
    /// Latitude at which lengths in the DEM's own CRS are true; `None` takes the data's middle, to
    /// half a degree.
    pub scale_latitude_deg: Option<f64>,
    /// A void is filled from data within this many cells; 0 fills nothing.
    pub fill_voids: u32,
    /// Only the ground within these bounds is made: west, south, east and north in WGS84 degrees,
    /// across ±180° where the west is larger than the east. `None` makes all. Everything else is
    /// chosen as without them, so that the same nodes get the same heights.
    pub bounds_deg: Option<[f64; 4]>,
    /// Only the ground under this polygon is made: nodes that are corners of cells which it enters.
    /// With `bounds_deg`, both hold.
    pub polygon: Option<Polygon>,
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
    pub frame: GridFrame,
    /// South-westernmost node at which data can lie.
    pub south_west: NodeIndex,
    /// North-easternmost node at which data can lie.
    pub north_east: NodeIndex,
    /// Working CRS: "EPSG:…" where it has a code, else its name.
    pub crs: String,
    /// Working CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres to a unit of the CRS's coordinates, east and north. Negative where an axis
    /// counts westwards or southwards.
    pub metres_per_unit: [f64; 2],
    /// Working metres to a true metre, at the centre: the geometric mean along both axes.
    pub point_scale: f64,
    /// The same along each axis, at the centre and over the data's rim.
    pub scale: ScaleRecord,
    /// The part that is asked for; `None`: all of it.
    pub clip: Option<ClipRecord>,
    /// The polygon that was asked for, on the lattice.
    pub polygon: Option<Arc<LatticeRegion>>,
    /// Rectangle of the nodes from `south_west` to `north_east`, working metres.
    pub data_bounds: Bounds,
    /// Rectangle around the files, or around the part that is asked for, in WGS84 degrees. Past the
    /// antimeridian longitudes go on beyond ±180.
    pub wgs84_bounds: Bounds,
    /// Whether nodes are the DEM's samples.
    pub resampling: Resampling,
    /// How nodes relate to samples, in words.
    pub resampling_text: String,
    /// Names, without folders, of the files that are resampled onto the grid of the first one, and
    /// of that one. `None` where no file is, or all are.
    pub resampled_onto_first: Option<[String; 2]>,
    /// What the resulting heights are measured from, as far as files or options name it.
    pub vertical_datum: Option<String>,
    /// What was done to the files' heights, in words; with the offset at the DEM's centre where
    /// PROJ carried them.
    pub vertical: String,
    /// How positions come from one datum to another: from that of the working CRS to WGS84, and
    /// from those of files with another CRS to the working CRS. Empty where all are that of WGS84.
    pub datum_operations: Vec<DatumOperation>,
    /// Releases of GDAL and PROJ, on which the heights' last bits depend.
    pub libraries: String,
    /// A void is filled from data within this many cells.
    pub fill_voids: u32,
    /// How samples become heights; nothing in the plan of a package without its elevation files,
    /// with which no height can be read.
    pub roles: MosaicRoles,
    /// Its working CRS.
    pub working: GridCrs,
}

/// What each mosaic of the DEM does for the grid, in its order.
#[derive(Debug, Clone, Default)]
pub struct MosaicRoles(pub(crate) Vec<MosaicRole>);

/// What one mosaic does for the grid: which nodes it can serve, and how.
#[derive(Debug, Clone)]
pub(crate) struct MosaicRole {
    /// South-western and north-eastern node between which it can have data.
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
    /// The rectangle in degrees for which PROJ's operations are chosen: that around all files, also
    /// where the plan is for a part of them.
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
    /// true to scale they do not, and `--scale-latitude` changes nothing.
    #[must_use]
    pub fn has_standard_latitude(&self) -> bool {
        self.working.is_scaled
    }

    /// The poles' distance from zero along y, working metres, where the working CRS counts in
    /// degrees; `None` in a projection. Positions beyond it have no longitude.
    #[must_use]
    pub fn poles_y_m(&self) -> Option<f64> {
        self.working.crs.turn_angle().map(|turn| turn / 4.0 * self.metres_per_unit[1].abs())
    }
}
