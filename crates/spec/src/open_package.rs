//! Opens packages by name, and recognises what failed downloads leave in their place.

use std::path::Path;

use corniche_tileset::{FilePackage, OpenError};

/// Opens a package. If the file is an HTML page or a Git LFS pointer instead, the error says so.
///
/// # Errors
/// When the file cannot be read, or is not a package of this format version.
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
