//! The settings of a verification: its inputs and resources; and files that are checked to be those
//! of the build.

use std::path::PathBuf;

use corniche_gis::RegionPolygons;
use corniche_roads::FrcTable;
use corniche_spec::inputs::InputFiles;

/// The inputs and settings of a verification.
#[derive(Debug, Clone)]
pub struct VerifySettings {
    /// The elevation files from which the package was built, to check errors; empty to skip these
    /// checks.
    pub dem: Vec<PathBuf>,
    /// The photos from which the package was built, to check the photos of tiles; empty to skip
    /// these checks.
    pub photo: Vec<PathBuf>,
    /// The extracts from which the package was built, to check roads; `None` to skip these checks.
    pub osm: Option<VerifyOsm>,
    /// The polygon to which the package was clipped, if any: needed with elevation files and with
    /// an extract.
    pub polygon: Option<RegionPolygons>,
    /// Worker threads, at least 1.
    pub threads: usize,
}

/// The extracts from which a package was built, and the settings with which they were read.
#[derive(Debug, Clone)]
pub struct VerifyOsm {
    /// The extracts.
    pub paths: Vec<PathBuf>,
    /// The FRC table that the manifest names.
    pub table: FrcTable,
    /// The memory for sorting roads and objects of layers by tile, in bytes.
    pub memory_bytes: u64,
}

/// Files that are those of the build.
pub(crate) struct GivenFiles<T> {
    /// The files, to check at the end that they did not change.
    pub inputs: InputFiles,
    pub found: T,
}
