//! Packages are opened by their names, and what failed downloads leave in their places is told.

use std::path::Path;

use corniche_tileset::{FilePackage, OpenError};

/// Opens a package. An HTML page or a Git LFS pointer in its place is told as what it is.
///
/// # Errors
/// When the file cannot be read, or is no package of this format version.
pub fn open_package(path: &Path) -> Result<FilePackage, OpenError> {
    FilePackage::open(path).map_err(|error| match error {
        OpenError::File { path, source } if matches!(*source, OpenError::NotPmtiles) => {
            let found = corniche_gis::stand_in(&path);
            let told = found.map(|(found, advice)| OpenError::StandIn { found, advice }.into());
            OpenError::File { path, source: told.unwrap_or(source) }
        }
        other => other,
    })
}
