//! Errors of planning, of reading a plan, and of using it on another machine.

use std::{io, path::PathBuf};

use corniche_ground::{GroundError, TerrainError};
use corniche_roads::FrcTableError;
use corniche_spec::inputs::InputError;

/// Version of a plan's JSON; other versions are rejected.
pub const PLAN_VERSION: u32 = 11;

/// Why a text is not a plan, or a plan cannot be used here.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PlanFileError {
    #[error("this is not a build plan; create one with corniche plan -o FILE")]
    Json(#[from] serde_json::Error),
    #[error(
        "the plan has version {found}, but this program reads version {PLAN_VERSION}; create the plan again with this program: corniche plan -o FILE"
    )]
    Version { found: u32 },
    #[error("the plan's FRC table is invalid; create the plan again")]
    FrcTable(#[from] FrcTableError),
    #[error(
        "the plan's list of the levels on which each road class is shown is invalid; create the plan again"
    )]
    Filter,
    #[error("the plan's table of a layer is invalid ({0}); create the plan again")]
    Layer(#[from] corniche_layers::LayerTableError),
    #[error(transparent)]
    Polygon(#[from] corniche_gis::PolygonError),
    #[error(
        "the plan no longer matches this machine or its files: {}; create the plan again, or use the files and the program that it was created with",
        differences.join("; ")
    )]
    Differs { differences: Vec<String> },
}

/// Why a build cannot be planned.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PlanError {
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(transparent)]
    Ground(#[from] GroundError),
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    #[error("--max-error must be from 1e-9 to 1e9 metres, not {max_error_m}")]
    MaxError { max_error_m: f64 },
    #[error(
        "the data does not fit one package, because its longitudes and latitudes cannot be tabulated; pass files of one region without a pole inside; a DEM in degrees fits as a whole with --crs dem"
    )]
    Coordinates(#[from] corniche_geom::CoordinateTableError),
    #[error("cannot write in {folder:?}; choose another folder for the package")]
    Target { folder: PathBuf, source: io::Error },
    #[error("{why}")]
    NoMemory { why: String },
    #[error(
        "the build needs about {need} of disk space in {folder:?} ({what}), and {free} are free; free some space, pass --tmp with a folder on another disk for intermediate results, or start anyway with --force"
    )]
    NoRoom { folder: PathBuf, need: String, what: String, free: String },
    #[error("tile {id} could not be triangulated")]
    Triangulate { id: corniche_geom::TileId, source: corniche_tin::TriangulateError },
    #[error("interrupted; no package was written")]
    Interrupted,
}

corniche_dem::from_dem_errors!(PlanError);

corniche_work::from_interrupted!(PlanError);

impl PlanError {
    /// Whether the cause is an unusable input or setting, rather than a failure while the input was
    /// read.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Input(error) => error.is_unusable_input(),
            Self::Ground(error) => error.is_unusable_input(),
            Self::Triangulate { source, .. } => source.is_unusable_input(),
            Self::Interrupted => false,
            _ => true,
        }
    }
}
