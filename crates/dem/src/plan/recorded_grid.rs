//! The grid of a package without its elevation files.

use corniche_geom::{Bounds, GridFrame, NodeIndex};
use corniche_gis::{CrsError, DatumOperation, RecordedCrs, libraries};

use crate::plan::clip;
use crate::plan::grid_plan::{Clip, GridPlan, PlanScale, Resampling, bounds_of};

/// What a package records of its grid, beside its CRS.
#[derive(Debug, Clone)]
pub struct RecordedGrid {
    /// Nodes, tiles and levels.
    pub frame: GridFrame,
    /// South-westernmost node at which data can lie.
    pub south_west: NodeIndex,
    /// North-easternmost node at which data can lie.
    pub north_east: NodeIndex,
    /// Name of the CRS.
    pub crs: String,
    /// The CRS as WKT2.
    pub crs_wkt: String,
    /// Working metres to a true metre, at the centre.
    pub point_scale: f64,
    /// The same along each axis.
    pub scale: PlanScale,
    /// The part of the elevation files that was asked for; `None`: all of it.
    pub clip: Option<Clip>,
    /// Rectangle around the data in WGS84 degrees.
    pub wgs84_bounds: Bounds,
    /// Whether nodes are the DEM's samples.
    pub nodes_are_samples: bool,
    /// How nodes relate to samples, in words.
    pub resampling_text: String,
    /// What heights are measured from, as far as it is known.
    pub vertical_datum: Option<String>,
    /// What was done to the files' heights, in words.
    pub vertical: String,
    /// How positions come from one datum to another.
    pub datum_operations: Vec<DatumOperation>,
    /// A void was filled from data within this many cells.
    pub fill_voids: u32,
}

/// Bounds in WGS84 degrees (west, south, east, north) as a rectangle of nodes of a package's grid, its south-western and north-eastern one, rounded
/// outwards as those of a build are. They may reach beyond the data. `area_deg` is the rectangle for which PROJ chooses its operation.
///
/// # Errors
/// When the bounds have no place in the CRS.
pub fn nodes_within(
    bounds_deg: [f64; 4],
    crs: &RecordedCrs,
    frame: &GridFrame,
    area_deg: Bounds,
) -> Result<[NodeIndex; 2], CrsError> {
    clip::nodes_of(bounds_deg, crs.working(), area_deg, frame.origin_m(), frame.cell())
}

impl RecordedGrid {
    /// The plan of a package whose elevation files are not there. No height can be read with it: it has no file.
    #[must_use]
    pub fn plan(self, in_crs: &RecordedCrs) -> GridPlan {
        let Self {
            frame,
            south_west,
            north_east,
            crs,
            crs_wkt,
            point_scale,
            scale,
            clip,
            wgs84_bounds,
            nodes_are_samples,
            resampling_text,
            vertical_datum,
            vertical,
            datum_operations,
            fill_voids,
        } = self;
        // Whether other nodes than samples are thinned or resampled matters to nobody who has no samples.
        let resampling =
            if nodes_are_samples { Resampling::Aligned } else { Resampling::Resampled };
        let working = in_crs.working().clone();
        GridPlan {
            frame,
            south_west,
            north_east,
            crs,
            crs_wkt,
            metres_per_unit: working.metres_per_unit,
            point_scale,
            scale,
            clip,
            polygon: None,
            data_bounds: bounds_of(&frame, [south_west, north_east]),
            wgs84_bounds,
            resampling,
            resampling_text,
            resampled_onto_first: None,
            vertical_datum,
            vertical,
            datum_operations,
            libraries: libraries(),
            fill_voids,
            roles: Vec::new(),
            working,
        }
    }
}
