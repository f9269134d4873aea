//! With which inputs a package is verified, and how; files that were found to be those of the build.

use std::path::PathBuf;

use corniche_areas::AreaTable;
use corniche_gis::Polygon;
use corniche_roads::FrcTable;
use corniche_spec::inputs::Inputs;

/// The inputs with which a package is verified.
#[derive(Debug, Clone)]
pub struct VerifySettings {
    /// The elevation files it was made from, to check errors against; empty leaves that out.
    pub dem: Vec<PathBuf>,
    /// The photos it was made from, to check the photos of tiles against; empty leaves that out.
    pub photo: Vec<PathBuf>,
    /// The extract it was made from, to check roads against; `None` leaves that out.
    pub osm: Option<VerifyOsm>,
    /// The polygon that it was cut with, if it was: needed with elevation files and with an extract.
    pub polygon: Option<Polygon>,
    /// Worker threads, at least 1.
    pub threads: usize,
}

/// The extracts that a package was made from, and how they were read.
#[derive(Debug, Clone)]
pub struct VerifyOsm {
    /// The extracts.
    pub paths: Vec<PathBuf>,
    /// The FRC table that the manifest names.
    pub table: FrcTable,
    /// The table of areas that the manifest names; not asked for if the package has none.
    pub areas: Option<AreaTable>,
    /// Memory for sorting roads and areas by tile, bytes.
    pub memory_bytes: u64,
}

/// Files that are those of the build.
pub(crate) struct GivenFiles<T> {
    /// The files, to see at the end that they did not change.
    pub inputs: Inputs,
    pub found: T,
}
