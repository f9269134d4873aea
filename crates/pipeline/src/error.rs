//! Errors of building a package.

use std::{io, path::PathBuf};

use corniche_geom::Bounds;
use corniche_gis::listed_files;
use corniche_store::{LackOfRoom, TargetError};
use corniche_tileset::WriteError;
use corniche_work::Interrupted;

use crate::plan_error::PlanError;

/// Why a package could not be built.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum BuildError {
    #[error("{path:?} exists already; give -O to replace it")]
    Exists { path: PathBuf },
    #[error("the package cannot be written")]
    NoTarget(#[from] TargetError),
    #[error("cannot write in {folder:?}; choose another place for the package")]
    Target { folder: PathBuf, source: io::Error },
    #[error(
        "{path:?} is both an input and the package to write; choose another name for the package"
    )]
    TargetIsInput { path: PathBuf },
    #[error("cannot read {path:?}")]
    Input { path: PathBuf, source: io::Error },
    #[error(
        "{path:?} is a pipe or a device; inputs are read more than once, so save it to a file first"
    )]
    Stream { path: PathBuf },
    #[error(
        "the name of {path:?} is not UTF-8, and a package records the names of its inputs as text; rename the file"
    )]
    InputName { path: PathBuf },
    #[error(
        "{path:?} changed while it was read, so the package could mix old and new content; nothing was written; run the \
         same command again when no program writes to the file"
    )]
    Changed { path: PathBuf },
    #[error(transparent)]
    Dem(#[from] corniche_dem::DemError),
    #[error(transparent)]
    Photo(#[from] corniche_photo::PhotoError),
    #[error(transparent)]
    Osm(#[from] corniche_osm::ReadOsmError),
    #[error("no node of {} has a height: every node is void, or outside --polygon", listed_files(.dem))]
    NoHeights { dem: Vec<PathBuf> },
    #[error(
        "{} hold heights at {nodes} nodes, but no cell has one at each of its four corners, so there is no \
         ground; give rasters with heights side by side",
        listed_files(.dem)
    )]
    NoCell { dem: Vec<PathBuf>, nodes: u64 },
    #[error("{} has no road: {why}", listed_files(.osm))]
    NoRoads { osm: Vec<PathBuf>, why: String },
    #[error(
        "{} and the elevation data do not overlap: roads lie within {}, heights within {}",
        listed_files(.osm), .roads_deg.degrees_text(), .heights_deg.degrees_text()
    )]
    NoOverlap { osm: Vec<PathBuf>, roads_deg: Bounds, heights_deg: Bounds },
    #[error(
        "no {what} of {} lies on ground: all are beside the elevation data, over its voids, or outside --bounds or --polygon; without --osm the package is terrain alone",
        listed_files(.osm)
    )]
    NoGround { osm: Vec<PathBuf>, what: &'static str },
    #[error("the roads could not be projected into the working CRS")]
    Project(#[source] corniche_geom::ProjectError),
    #[error("{why}")]
    NoMemory { why: String },
    #[error(
        "the build needs about {need} of disk space in {folder:?} ({what}), and {free} are free; make room, give --tmp a \
         folder on another disk for intermediate results, or begin anyway with --force"
    )]
    NoRoom { folder: PathBuf, need: String, what: String, free: String },
    #[error(transparent)]
    Package(#[from] corniche_tileset::OpenError),
    #[error(
        "the terrain of {path:?} cannot be taken: {differences}; give the same settings, or build from the elevation files with --dem"
    )]
    OtherTerrain { path: PathBuf, differences: String },
    #[error("{path:?} is damaged: {what}; build from the elevation files with --dem")]
    DamagedPackage { path: PathBuf, what: String },
    #[error("{path:?} cannot be used; build from the elevation files with --dem")]
    PackageTile { path: PathBuf, source: corniche_tileset::ReadError },
    #[error("the run could not be set up: {what}")]
    Start { what: String },
    #[error(
        "--bounds osm: the header of {osm:?} does not say where the extract is; give --bounds W,S,E,N (osmium fileinfo -e tells them)"
    )]
    NoExtractBounds { osm: PathBuf },
    #[error("--max-error must be from 1e-9 to 1e9 metres, not {max_error_m}")]
    MaxError { max_error_m: f64 },
    #[error(
        "an earlier build of this package ended early and left {store:?}; give --resume to go on from there, or -O to start again"
    )]
    Leftovers { store: PathBuf },
    #[error(
        "{store:?} is of another build: {differences}; give the inputs and settings of that build, or -O to start again"
    )]
    OtherBuild { store: PathBuf, differences: String },
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(
        "{store:?} is of another plan: {differences}; give the plan that it was made with, or another --store"
    )]
    OtherPlan { store: PathBuf, differences: String },
    #[error("{folder:?} holds no store; nothing was kept there yet, or the name is wrong")]
    NoStore { folder: PathBuf },
    #[error("--subtree {subtree}: {why}")]
    Subtree { subtree: corniche_geom::TileId, why: String },
    #[error("--share {share}: {why}")]
    Share { share: corniche_osm::Share, why: String },
    #[error(
        "{folder:?} holds {kept:?}, which is not Corniche's; move it away or choose another --tmp"
    )]
    NotOurs { folder: PathBuf, kept: PathBuf },
    #[error("{path:?} is being built by another process; wait until it has ended")]
    AtWork { path: PathBuf },
    #[error(
        "{what}: not in the store; run corniche part with --step {step}, or give the folder of its part with --store"
    )]
    Missing { what: String, step: &'static str },
    #[error(
        "roads could not be sorted on the disk{}",
        LackOfRoom::advice(LackOfRoom::of(.0))
    )]
    Storage(#[source] io::Error),
    #[error(transparent)]
    Store(#[from] corniche_store::StoreError),
    #[error(transparent)]
    Objects(#[from] corniche_objects::ObjectError),
    #[error(
        "intermediate results are damaged: {what}; remove the store and start again (build: with -O)"
    )]
    Damaged { what: String },
    #[error("tile {id} could not be triangulated")]
    Triangulate { id: corniche_geom::TileId, source: corniche_tin::TriangulateError },
    #[error("a tile could not be encoded")]
    Encode(#[from] corniche_tileset::EncodeError),
    #[error("{path:?} could not be written{}", room_of(.source))]
    Write { path: PathBuf, source: WriteError },
    #[error("{path:?} could not be put in its place")]
    Rename { path: PathBuf, source: io::Error },
    #[error(
        "the data do not fit one package, their longitudes and latitudes cannot be tabulated: give files of one region without a pole inside; a DEM in degrees fits as a whole with --crs dem"
    )]
    Coordinates(#[from] corniche_geom::CoordinateTableError),
    #[error("interrupted; no package was written")]
    Interrupted,
}

/// What is lacking where a package could not be written.
fn room_of(error: &WriteError) -> String {
    LackOfRoom::advice(match error {
        WriteError::Io(error) => LackOfRoom::of(error),
        _ => None,
    })
}

corniche_dem::from_dem_errors!(BuildError);

impl From<Interrupted> for BuildError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

impl BuildError {
    /// Whether the cause is an unusable input or setting, rather than a failure while the build ran.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        match self {
            Self::Store(error) => return error.is_unusable(),
            Self::Objects(error) => return error.is_unusable(),
            _ => {}
        }
        matches!(
            self,
            Self::Target { .. }
                | Self::NoTarget(_)
                | Self::TargetIsInput { .. }
                | Self::Stream { .. }
                | Self::InputName { .. }
                | Self::Input { .. }
                | Self::Dem(_)
                | Self::Photo(_)
                | Self::Osm(_)
                | Self::NoHeights { .. }
                | Self::NoCell { .. }
                | Self::NoRoads { .. }
                | Self::NoOverlap { .. }
                | Self::NoGround { .. }
                | Self::Coordinates(_)
                | Self::MaxError { .. }
                | Self::NoExtractBounds { .. }
                | Self::Plan(_)
                | Self::OtherPlan { .. }
                | Self::NoStore { .. }
                | Self::Subtree { .. }
                | Self::Share { .. }
                | Self::Package(_)
                | Self::OtherTerrain { .. }
                | Self::DamagedPackage { .. }
                | Self::PackageTile { .. }
                | Self::NoMemory { .. }
                | Self::NoRoom { .. }
                | Self::Triangulate { source: corniche_tin::TriangulateError::Height { .. }, .. }
        )
    }
}
