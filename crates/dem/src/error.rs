//! Errors of elevation files, one enum for each activity, and an enum of all.

#![expect(missing_docs, reason = "each message documents its variant")]

use std::path::{Path, PathBuf};

use corniche_geom::{Cell, GridFrameError};
use corniche_gis::{CrsError, LibraryError, NameError, PolygonError, RasterError};

/// Why elevation files could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenDemError {
    #[error("no elevation file is named; pass one with --dem")]
    NoFiles,
    #[error("{path:?} has no raster band; {}", what_to_give(path))]
    NoBand { path: PathBuf },
    #[error(
        "{path:?} contains several rasters; pass the one with the heights by its name: {names}"
    )]
    Subdatasets { path: PathBuf, names: String },
    #[error(
        "{path:?} has {columns} × {rows} samples; ground needs at least 2 × 2, so pass another file, or the neighbouring files too"
    )]
    Line { path: PathBuf, columns: usize, rows: usize },
    #[error(
        "{path:?} is an image ({bands} bands, the first is {interpretation}), not a DEM; pass a file with heights in the first band, or choose a band with --dem-band"
    )]
    Imagery { path: PathBuf, bands: usize, interpretation: String },
    #[error(
        "{path:?} has several bands, but does not say which of them has the heights: {bands}; choose one with --dem-band N"
    )]
    SeveralBands { path: PathBuf, bands: String },
    #[error(
        "{path:?} has {count} bands, but --dem-band is {asked}; pass the number of one of its bands (the first is 1)"
    )]
    NoSuchBand { path: PathBuf, asked: u32, count: usize },
    #[error(
        "band {band} of {path:?} has complex numbers or another type of samples that cannot be heights; convert the band to integers or real numbers (gdal_translate -ot)"
    )]
    SampleType { path: PathBuf, band: usize },
    #[error(
        "heights of {path:?} are in {unit:?}, which is not a known unit of length; pass the unit with --vertical-unit metre (or foot, us-foot, decimetre, centimetre)"
    )]
    Unit { path: PathBuf, unit: String },
    #[error(
        "--vertical-unit {text:?} is not a known unit of length; write metre, foot, us-foot, decimetre or centimetre"
    )]
    UnitName { text: String },
    #[error(
        "heights of {path:?} are in {unit:?} according to their band, but one unit is {vertical_unit_m} m according to their vertical CRS {vertical:?}; pass the right unit with --vertical-unit, or correct the file (gdal_translate -a_srs, gdal_edit.py)"
    )]
    UnitsDisagree { path: PathBuf, unit: String, vertical: String, vertical_unit_m: f64 },
    #[error(
        "band {band} of {path:?} has scale {scale} and offset {offset}, with which no heights can be computed; correct them (gdal_edit.py -scale -offset)"
    )]
    Scale { path: PathBuf, band: usize, scale: f64, offset: f64 },
    #[error(
        "{path:?} is nowhere on earth according to its coordinate system {crs}; assign its true CRS with gdal_translate -a_srs"
    )]
    Nowhere { path: PathBuf, crs: String },
    #[error(transparent)]
    Raster(#[from] RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
    #[error(transparent)]
    Datum(#[from] Box<HeightDatumError>),
}

/// Why the vertical CRS of heights is unknown, or heights cannot be converted to the requested one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeightDatumError {
    #[error(
        "--vertical-shift {shift_m} is out of range; pass metres between -{limit_m} and {limit_m}"
    )]
    VerticalShift { shift_m: f64, limit_m: f64 },
    #[error(
        "{path:?} names no vertical CRS, so its heights cannot be converted to {to}; pass its vertical CRS with --dem-vertical-crs"
    )]
    NoVerticalCrs { path: PathBuf, to: String },
    #[error(
        "heights of {path:?} cannot be converted from {from} to {to}: {unnamed} names no vertical datum, so the relation of the two is unknown; name the true vertical CRS (gdal_translate -a_srs, --dem-vertical-crs, --vertical-crs), or omit --vertical-crs and pass --vertical-shift"
    )]
    NoVerticalDatum { path: PathBuf, from: String, to: String, unnamed: String },
    #[error(
        "heights of {first:?} are {first_says}, those of {other:?} {other_says}; pass a common vertical CRS with --vertical-crs, and that of the files that name none with --dem-vertical-crs"
    )]
    MixedVertical { first: PathBuf, first_says: String, other: PathBuf, other_says: String },
    #[error(
        "heights of {path:?} cannot be converted from {from} to {to}: the geoid grid {grids} does not exist; put it there, or install one that PROJ knows (projsync, in the Debian package proj-bin) and name its vertical CRS, or omit --vertical-crs and pass --vertical-shift"
    )]
    NoGeoidGrid { path: PathBuf, from: String, to: String, grids: String },
    #[error(
        "heights of {path:?} cannot be converted from {from} to {to}: PROJ has no exact operation between the two here; a geoid grid may be missing ({grids}): install it (projsync, in the Debian package proj-bin), or omit --vertical-crs and pass --vertical-shift"
    )]
    VerticalOperation {
        path: PathBuf,
        from: String,
        to: String,
        grids: String,
        source: Option<Box<LibraryError>>,
    },
    #[error(
        "geoid grid {grids:?} is marked as optional (@), so a missing grid would leave heights unchanged; write its name without @"
    )]
    OptionalGeoidGrid { grids: String },
    #[error(transparent)]
    Crs(#[from] CrsError),
}

/// Why no grid could be planned.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    #[error(
        "--crs {text:?} is not a coordinate system that PROJ knows; write dem (the CRS of the DEM), utm, EPSG:n or WKT"
    )]
    WorkingCrsText { text: String, source: Box<LibraryError> },
    #[error(
        "--crs {text:?} is neither a projected coordinate system whose x axis is to the right of its y axis, nor the CRS of the DEM; choose another one"
    )]
    WorkingCrs { text: String },
    #[error("the DEM's centre has no position in {crs}; choose another --crs")]
    OutsideCrs { crs: String },
    #[error(
        "{asked} contains no cell of the elevation data, which reaches from {west:.4} to {east:.4} degrees east and from {south:.4} to {north:.4} degrees north; choose a part of this data (--bounds takes west,south,east,north in degrees{swapped})"
    )]
    BoundsBesideData {
        asked: String,
        west: f64,
        south: f64,
        east: f64,
        north: f64,
        /// The same bounds with longitude first, if these would contain cells.
        swapped: String,
    },
    #[error(
        "{asked} is at both ends of elevation data that go around the earth, but a package contains one region; build two packages, or pass files that are continuous there"
    )]
    BoundsAtBothEnds { asked: String },
    #[error("{path:?} has no position in {crs}; choose another --crs, or omit the file")]
    FileOutsideCrs { path: PathBuf, crs: String },
    #[error(
        "--cell {cell} is out of range; pass metres between 0.001 and 1000000, as one number or as east,north"
    )]
    Cell { cell: Cell },
    #[error(
        "the samples of {path:?} result in a cell of {cell} in {crs}, but a side must be 0.001 to 1000000 m long; pass --crs dem, which keeps the grid of the file, or --cell"
    )]
    CellOfFile { path: PathBuf, cell: Cell, crs: String },
    #[error(
        "a cell of {cell} averages {samples:.0} DEM samples along a side, more than {limit}; use a smaller --cell"
    )]
    Downsampling { cell: Cell, samples: f64, limit: f64 },
    #[error("--cell-every {every} is out of range; pass a number from 1 to {limit}")]
    CellEvery { every: u32, limit: i64 },
    #[error(
        "--cell-every {every} leaves {columns} × {rows} nodes; ground needs at least 2 × 2, so pass a smaller number"
    )]
    CellEveryLeaves { every: u32, columns: i64, rows: i64 },
    #[error("--cell and --cell-every both set the size of a cell; pass only one of them")]
    CellTwice,
    #[error(
        "--cell-every needs nodes that are the DEM's samples, and in {crs} they are not; {way_out}"
    )]
    CellEveryResampled { crs: String, way_out: &'static str },
    #[error("--scale-latitude {latitude_deg} is out of range; pass degrees between -89 and 89")]
    ScaleLatitude { latitude_deg: f64 },
    #[error(
        "--scale-latitude {latitude_deg} and --crs utm exclude each other: UTM has a fixed scale; omit one of them"
    )]
    ScaleLatitudeUtm { latitude_deg: f64 },
    #[error(
        "the DEM's own coordinate system {crs} cannot be the working CRS here: its y axis is not to the left of its x axis, or the DEM's centre is outside the CRS; omit --crs dem"
    )]
    OwnCrs { crs: String },
    #[error(
        "UTM is defined from 80° south to 84° north, and the DEM reaches from {south:.3}° to {north:.3}°; omit --crs utm"
    )]
    NoUtm { south: f64, north: f64 },
    #[error(
        "a cell of {cell} puts {nodes:.0} nodes along a side of each DEM sample, more than {limit}: all but one of the nodes \
         would be interpolated; use a larger --cell, or pass --force if you want this"
    )]
    Oversampling { cell: Cell, nodes: f64, limit: f64 },
    #[error("--fill-voids {cells} is too large; pass at most {limit} cells")]
    FillVoids { cells: u32, limit: u32 },
    #[error("the DEM's grid cannot be created")]
    Frame(#[from] GridFrameError),
    #[error(transparent)]
    Crs(#[from] CrsError),
    #[error(transparent)]
    Polygon(#[from] PolygonError),
}

/// Why heights could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadHeightsError {
    #[error("windows of stride {stride} are not read from the DEM, only of stride 1")]
    Stride { stride: i64 },
    #[error(
        "the sample at column {column}, row {row} of {path:?} has no height in {to}: it is outside PROJ's geoid grids; omit --vertical-crs, or clip the file to the area of the grids"
    )]
    VerticalPosition { path: PathBuf, column: usize, row: usize, to: String },
    #[error(transparent)]
    Raster(#[from] RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
}

/// Why values are not accepted as heights.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AuditError {
    #[error(
        "{count} of {samples} samples of {files} hold {stored}, {gap_m:.0} m {} all others: probably a value that means \"no \
         data\" but is not declared; declare it with --nodata {stored}, or if these are heights of {height_m} m allow \
         them with --height-range {low_m},{high_m}",
        side(*.is_below)
    )]
    Sentinel {
        files: String,
        stored: String,
        count: u64,
        samples: u64,
        height_m: f64,
        gap_m: f64,
        is_below: bool,
        low_m: f64,
        high_m: f64,
    },
    #[error(
        "{count} of {samples} samples of {path:?} are not heights between {low_m} and {high_m} m: one is {height_m} m, stored \
         as {stored}; if this value means \"no data\", declare it with --nodata {stored}; if it is a height, pass the range of allowed heights with --height-range LOW,HIGH (metres)"
    )]
    OutOfRange {
        path: PathBuf,
        count: u64,
        samples: u64,
        height_m: f64,
        stored: String,
        low_m: f64,
        high_m: f64,
    },
}

/// Any error of elevation files, for callers that use all activities.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DemError {
    #[error(transparent)]
    Names(#[from] NameError),
    #[error(transparent)]
    Raster(#[from] RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
    #[error(transparent)]
    Polygon(#[from] PolygonError),
    #[error(transparent)]
    Open(#[from] OpenDemError),
    #[error(transparent)]
    Grid(#[from] GridError),
    #[error(transparent)]
    Read(#[from] ReadHeightsError),
    #[error(transparent)]
    Audit(#[from] AuditError),
}

/// Implements the conversion of each activity's error into an error that has a variant
/// `Dem(DemError)`.
#[macro_export]
macro_rules! from_dem_errors {
    ($error:ty) => {
        $crate::from_dem_errors!(
            $error: corniche_gis::NameError, corniche_gis::RasterError, corniche_gis::CrsError,
            corniche_gis::PolygonError,
            $crate::OpenDemError, $crate::GridError, $crate::ReadHeightsError, $crate::AuditError
        );
    };
    ($error:ty: $($activity:ty),+) => {
        $(impl From<$activity> for $error {
            fn from(error: $activity) -> Self {
                Self::Dem(error.into())
            }
        })+
    };
}

fn side(is_below: bool) -> &'static str {
    if is_below { "below" } else { "above" }
}

/// Advice for a file without heights, which may be another input.
fn what_to_give(path: &Path) -> &'static str {
    let is_extract = path.to_string_lossy().to_ascii_lowercase().contains(".osm")
        || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("pbf"));
    if is_extract {
        "pass an OpenStreetMap extract with --osm instead"
    } else {
        "pass a raster of heights"
    }
}
