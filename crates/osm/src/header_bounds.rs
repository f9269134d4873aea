//! The bounding box that an extract declares in its header, read from the first blob.

use std::path::Path;

use crate::{ReadOsmError, blobs::BlobFile, open_file::open_file};

/// Returns the bounding box in an extract's header: west, south, east and north in WGS84 degrees.
/// Across ±180°, the west is larger than the east. `None` if the header has no box on Earth, or if
/// the file has several headers.
///
/// Ways that cross the bounding box may extend beyond it.
///
/// # Errors
/// When the file cannot be read or its blobs cannot be listed.
pub fn header_bounds_deg(path: &Path) -> Result<Option<[f64; 4]>, ReadOsmError> {
    Ok(BlobFile::open(path, open_file(path)?)?.header.bounds_deg)
}
