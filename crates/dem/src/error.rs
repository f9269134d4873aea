use std::path::PathBuf;

use corniche_geom::FrameError;
use gdal::errors::GdalError;

/// Why elevation files could not be opened, planned or read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum DemError {
    #[error("no DEM file is given")]
    NoFiles,
    #[error("cannot open DEM {path:?}")]
    Missing { path: PathBuf, source: std::io::Error },
    #[error("{path:?} is not a file; name the raster itself")]
    NotAFile { path: PathBuf },
    #[error("{path:?} is empty (0 bytes); fetch it again")]
    Empty { path: PathBuf },
    #[error(
        "{path:?} is not a raster that GDAL can read; it is damaged, cut off, or of an unknown format"
    )]
    Open { path: PathBuf, source: Box<GdalError> },
    #[error("{path:?} has no raster band; name the subdataset that holds the heights")]
    NoBand { path: PathBuf },
    #[error(
        "{path:?} is an image ({bands} bands, the first is {interpretation}), not a DEM; give heights in the first band"
    )]
    Imagery { path: PathBuf, bands: usize, interpretation: String },
    #[error("the first band of {path:?} has samples of type {type_name}, which are no heights")]
    SampleType { path: PathBuf, type_name: String },
    #[error(
        "heights of {path:?} are in {unit:?}, which is not a known unit of length; convert them to metres"
    )]
    Unit { path: PathBuf, unit: String },
    #[error(
        "{path:?} has no georeference (geotransform); add one with gdal_translate -a_ullr or a world file"
    )]
    NoGeoTransform { path: PathBuf },
    #[error("the geotransform {coefficients:?} of {path:?} is not usable; it has no inverse")]
    GeoTransform { path: PathBuf, coefficients: [f64; 6] },
    #[error("{path:?} names no usable coordinate system; give it with --dem-crs EPSG:n")]
    NoCrs { path: PathBuf },
    #[error(
        "{path:?} has coordinate system {name:?}, which is neither projected nor geographic; give it with --dem-crs"
    )]
    UnusableCrs { path: PathBuf, name: String },
    #[error("{option} {text:?} is not a coordinate system that PROJ knows; write EPSG:n or WKT")]
    CrsText { option: &'static str, text: String, source: Box<GdalError> },
    #[error(
        "--crs {text:?} is not a projected coordinate system in metres with x to the right of y; choose one that is"
    )]
    WorkingCrs { text: String },
    #[error("coordinate system {name:?} cannot be written down as WKT")]
    Wkt { name: String, source: Box<GdalError> },
    #[error("no transformation from {from} to {to}")]
    Transform { from: String, to: String, source: Box<GdalError> },
    #[error("the DEM has no position in {crs}; choose another --crs")]
    OutsideCrs { crs: String },
    #[error("--cell {cell_m} is not a usable length; give metres between 0.001 and 1000000")]
    Cell { cell_m: f64 },
    #[error(
        "a cell of {cell_m} m averages {samples:.0} DEM samples along a side, more than {limit}; use a smaller --cell"
    )]
    Downsampling { cell_m: f64, samples: f64, limit: f64 },
    #[error("--fill-voids {cells} is too far; at most {limit} cells")]
    FillVoids { cells: u32, limit: u32 },
    #[error("the DEM's grid cannot be made")]
    Frame(#[from] FrameError),
    #[error("windows of stride {stride} are not read from the DEM, only of stride 1")]
    Stride { stride: i64 },
    #[error(
        "cannot read {columns} × {rows} samples at column {column}, row {row} of {path:?}; the file is damaged or cut off"
    )]
    Read {
        path: PathBuf,
        column: usize,
        row: usize,
        columns: usize,
        rows: usize,
        source: Box<GdalError>,
    },
}
