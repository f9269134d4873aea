//! Errors of opening and reading photos.

use std::path::PathBuf;

use corniche_gis::{CrsError, RasterError};

/// Errors of opening and reading photos.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PhotoError {
    #[error("no photo is named; pass one with --photo")]
    NoFiles,
    #[error(
        "photo {path:?} has no usable coordinate system; assign one with gdal_edit.py -a_srs EPSG:n"
    )]
    NoCrs { path: PathBuf },
    #[error("photo {path:?} has no raster band; pass an image")]
    NoBand { path: PathBuf },
    #[error(
        "photo {path:?} has samples of type {kind}, but photos must have 8 bits; scale it with gdal_translate -scale -ot Byte (gdalinfo -stats prints the range)"
    )]
    SampleType { path: PathBuf, kind: String },
    #[error(
        "photo {path:?} has {bands} bands, but none is a colour that can be shown ({interpretations}); select red, green and blue with gdal_translate -b"
    )]
    Bands { path: PathBuf, bands: usize, interpretations: String },
    #[error(
        "photo {path:?} has palette indices, but no palette; convert it with gdal_translate -expand rgb"
    )]
    NoPalette { path: PathBuf },
    #[error(
        "no photo overlaps the ground: the photos cover {}, the ground covers {} (metres of the grid); pass photos of this region, or omit --photo",
        reach(*.photos), reach(*.ground)
    )]
    NoOverlap { photos: [f64; 4], ground: [f64; 4] },
    #[error(
        "photo {path:?} cannot be transformed to the package's coordinate system; pass photos of this region"
    )]
    Nowhere { path: PathBuf },
    #[error("--photo-levels must be from 0 to {most}, not {levels}")]
    Levels { levels: u8, most: u8 },
    #[error(
        "photo {path:?} has {pixels:.0} pixels along a texel, more than {most}; raise --photo-levels, or downsample the photo with gdal_translate -outsize 10% 10% -r average"
    )]
    TooFine { path: PathBuf, pixels: f64, most: f64 },
    #[error(transparent)]
    Raster(RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
}

impl From<RasterError> for PhotoError {
    fn from(error: RasterError) -> Self {
        match error {
            RasterError::NoCrs { path } | RasterError::UnusableCrs { path, .. } => {
                Self::NoCrs { path }
            }
            other => Self::Raster(other),
        }
    }
}

/// A rectangle of the grid in words: west, south, east, north.
fn reach([west, south, east, north]: [f64; 4]) -> String {
    format!("x {west:.0} to {east:.0} and y {south:.0} to {north:.0}")
}
