//! Errors of opening and reading photos.

use std::path::PathBuf;

use corniche_gis::{CrsError, RasterError};

/// Why photos could not be opened or read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum PhotoError {
    #[error("no photo is given")]
    NoFiles,
    #[error(
        "photo {path:?} names no usable coordinate system; write it into the file with gdal_edit.py -a_srs EPSG:n"
    )]
    NoCrs { path: PathBuf },
    #[error("photo {path:?} has no raster band; give an image")]
    NoBand { path: PathBuf },
    #[error(
        "photo {path:?} holds samples of type {kind}, and photos have 8 bits; scale them with gdal_translate -scale -ot Byte (gdalinfo -stats tells their range)"
    )]
    SampleType { path: PathBuf, kind: String },
    #[error(
        "photo {path:?} has {bands} bands of which none is a colour that can be shown ({interpretations}); give red, green and blue with gdal_translate -b"
    )]
    Bands { path: PathBuf, bands: usize, interpretations: String },
    #[error(
        "photo {path:?} has colours of a palette, and no palette; convert it with gdal_translate -expand rgb"
    )]
    NoPalette { path: PathBuf },
    #[error(
        "no photo lies on the ground that is built: the photos have {}, the ground has {} (metres of the grid); give photos of this region, or leave --photo out",
        reach(*.photos), reach(*.ground)
    )]
    NoOverlap { photos: [f64; 4], ground: [f64; 4] },
    #[error(
        "photo {path:?} has no position in the package's coordinate system; give photos of this region"
    )]
    Nowhere { path: PathBuf },
    #[error("--photo-levels must be from 0 to {most}, not {levels}")]
    Levels { levels: u8, most: u8 },
    #[error(
        "photo {path:?} has {pixels:.0} pixels along a texel, more than {most}; give a higher --photo-levels, or thin it with gdal_translate -outsize 10% 10% -r average"
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
