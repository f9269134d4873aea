//! The rectangle that the header of an extract says it was cut for.

use std::path::Path;

use crate::{ReadOsmError, blobs::BlobFile, open_file::open_file};

/// The rectangle that an extract's header says it was cut for: west, south, east and north in WGS84 degrees, the west larger than
/// the east across ±180°. `None` where the header has none that lies on earth, or the file has several headers.
///
/// Ways that cross the rectangle may reach beyond it.
///
/// # Errors
/// When the file cannot be read or its blobs cannot be listed.
pub fn header_bounds_deg(path: &Path) -> Result<Option<[f64; 4]>, ReadOsmError> {
    Ok(BlobFile::open(path, open_file(path)?)?.header.bounds_deg)
}
