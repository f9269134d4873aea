//! Errors of reading lines from a vector file.

use std::path::PathBuf;

use corniche_geom::ProjectError;
use corniche_gis::{CrsError, VectorError};

/// Errors of reading lines from a file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum OverlayError {
    #[error(transparent)]
    Vector(#[from] VectorError),
    #[error(
        "{path:?} has no lines and no polygons, but {others} other features; only lines and the outlines of polygons are drawn"
    )]
    NoLines { path: PathBuf, others: u64 },
    #[error(
        "layer {layer:?} of {path:?} has no CRS; assign one with ogr2ogr -a_srs EPSG:n NEW.gpkg {path:?}, or add the .prj file of the Shapefile"
    )]
    NoCrs { path: PathBuf, layer: String },
    #[error("the CRS of layer {layer:?} of {path:?} cannot be used")]
    Crs { path: PathBuf, layer: String, source: Box<CrsError> },
    #[error(transparent)]
    Datum(Box<CrsError>),
    #[error(
        "{path:?} has more than {limit} points in its lines; simplify it (ogr2ogr -simplify), or clip it to the package's extent (ogr2ogr -clipsrc)"
    )]
    TooManyPoints { path: PathBuf, limit: usize },
    #[error(
        "{path:?} and the files named before it have more than {limit} points in their lines; simplify them (ogr2ogr -simplify), clip them to the package's extent (ogr2ogr -clipsrc), or show fewer files"
    )]
    TooManyTogether { path: PathBuf, limit: usize },
    #[error("cannot read {path:?}")]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{path:?} is larger than {limit} bytes, the limit for a file of drawn lines")]
    TooLarge { path: PathBuf, limit: u64 },
    #[error("{path:?} is not valid GeoJSON (RFC 7946): {reason}")]
    GeoJson { path: PathBuf, reason: String },
    #[error("the package's CRS cannot be used")]
    PackageCrs(#[source] Box<CrsError>),
    #[error(transparent)]
    Project(#[from] ProjectError),
}
