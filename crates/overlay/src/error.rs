//! Errors of reading lines from a vector file.

use std::path::PathBuf;

use corniche_dem::{DemError, LibraryError};
use corniche_geom::ProjectError;

/// Why a file gives no lines.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum OverlayError {
    #[error("cannot open the lines {path:?}")]
    Missing { path: PathBuf, source: std::io::Error },
    #[error("the lines {path:?} are a pipe or a device; save them to a file first")]
    Stream { path: PathBuf },
    #[error(
        "{path:?} is not a vector file that GDAL can read; it is damaged, cut off, or of an unknown format; GeoJSON, GPX, GeoPackage and Shapefile can be read (ogr2ogr converts others)"
    )]
    Open { path: PathBuf, source: Box<LibraryError> },
    #[error("cannot read {path:?}: {advice}")]
    NoDriver { path: PathBuf, advice: String },
    #[error("not all features of {path:?} can be read; fetch or export it again")]
    Damaged { path: PathBuf, source: Box<LibraryError> },
    #[error(
        "layer {layer:?} of {path:?} claims to have {claimed} features, and {found} can be read: it is damaged or cut off; fetch or export it again"
    )]
    CutOff { path: PathBuf, layer: String, claimed: u64, found: u64 },
    #[error(
        "{path:?} has no line and no outline, but {others} other features; only lines and outlines are drawn"
    )]
    NoLines { path: PathBuf, others: u64 },
    #[error(
        "layer {layer:?} of {path:?} names no coordinate system; give it one: ogr2ogr -a_srs EPSG:n NEW.gpkg {path:?}, or the .prj file beside a Shapefile"
    )]
    NoCrs { path: PathBuf, layer: String },
    #[error("the coordinate system of layer {layer:?} of {path:?} cannot be used")]
    Crs { path: PathBuf, layer: String, source: Box<DemError> },
    #[error(transparent)]
    Datum(Box<DemError>),
    #[error(
        "{path:?} has more than {limit} points in its lines; simplify it (ogr2ogr -simplify), or cut it to the package (ogr2ogr -clipsrc)"
    )]
    TooManyPoints { path: PathBuf, limit: usize },
    #[error(
        "{path:?} and the files named before it have more than {limit} points in their lines; simplify them (ogr2ogr -simplify), cut them to the package (ogr2ogr -clipsrc), or show fewer files"
    )]
    TooManyTogether { path: PathBuf, limit: usize },
    #[error("cannot read {path:?}")]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{path:?} is larger than {limit} bytes, which is no file of lines that were drawn")]
    TooLarge { path: PathBuf, limit: u64 },
    #[error("{path:?} is no GeoJSON (RFC 7946): {reason}")]
    GeoJson { path: PathBuf, reason: String },
    #[error("the package's coordinate system cannot be used")]
    PackageCrs(#[source] Box<DemError>),
    #[error(transparent)]
    Project(#[from] ProjectError),
}
