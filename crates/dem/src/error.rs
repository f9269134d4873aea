//! Errors of elevation files, an enum for each activity, and their sum.

#![expect(missing_docs, reason = "each message documents its variant")]

use std::path::{Path, PathBuf};

use corniche_geom::{Cell, GridFrameError};
use corniche_gis::{CrsError, LibraryError, NameError, PolygonError, RasterError};

/// Why elevation files could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenDemError {
    #[error("no DEM file is given")]
    NoFiles,
    #[error("{path:?} has no raster band; {}", what_to_give(path))]
    NoBand { path: PathBuf },
    #[error("{path:?} holds several rasters; give the one with the heights by its name: {names}")]
    Subdatasets { path: PathBuf, names: String },
    #[error(
        "{path:?} has {columns} × {rows} samples; ground lies between samples, so give at least 2 × 2, or the files beside it too"
    )]
    Line { path: PathBuf, columns: usize, rows: usize },
    #[error(
        "{path:?} is an image ({bands} bands, the first is {interpretation}), not a DEM; give heights in the first band, or choose a band with --dem-band"
    )]
    Imagery { path: PathBuf, bands: usize, interpretation: String },
    #[error(
        "{path:?} has several bands, and it is not known which of them has the heights: {bands}; choose one with --dem-band N"
    )]
    SeveralBands { path: PathBuf, bands: String },
    #[error(
        "{path:?} has {count} bands, and --dem-band is {asked}; give the number of one of them, from 1 on"
    )]
    NoSuchBand { path: PathBuf, asked: u32, count: usize },
    #[error(
        "band {band} of {path:?} has complex numbers or another type of samples that are no heights; give integers or real numbers"
    )]
    SampleType { path: PathBuf, band: usize },
    #[error(
        "heights of {path:?} are in {unit:?}, which is not a known unit of length; say what they are in with --vertical-unit metre (or foot, us-foot, decimetre, centimetre)"
    )]
    Unit { path: PathBuf, unit: String },
    #[error(
        "--vertical-unit {text:?} is not a known unit of length; write metre, foot, us-foot, decimetre or centimetre"
    )]
    UnitName { text: String },
    #[error(
        "heights of {path:?} are in {unit:?} by their band, but a unit is {vertical_unit_m} m by their vertical CRS {vertical:?}; say which is right with --vertical-unit, or correct the other (gdal_translate -a_srs, gdal_edit.py)"
    )]
    UnitsDisagree { path: PathBuf, unit: String, vertical: String, vertical_unit_m: f64 },
    #[error(
        "band {band} of {path:?} has scale {scale} and offset {offset}, with which no heights can be computed; correct them (gdal_edit.py -scale -offset)"
    )]
    Scale { path: PathBuf, band: usize, scale: f64, offset: f64 },
    #[error(
        "{path:?} lies nowhere on earth by its coordinate system {crs}; name its true CRS with gdal_translate -a_srs"
    )]
    Nowhere { path: PathBuf, crs: String },
    #[error(transparent)]
    Raster(#[from] RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
    #[error(transparent)]
    Datum(#[from] Box<HeightDatumError>),
}

/// Why what heights are measured from is not known, or cannot become what is asked for.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeightDatumError {
    #[error(
        "--vertical-shift {shift_m} is not usable; give metres between -{limit_m} and {limit_m}"
    )]
    VerticalShift { shift_m: f64, limit_m: f64 },
    #[error(
        "{path:?} names no vertical CRS, so that its heights cannot be carried to {to}; give it with --dem-vertical-crs"
    )]
    NoVerticalCrs { path: PathBuf, to: String },
    #[error(
        "heights of {path:?} cannot be carried from {from} to {to}: {unnamed} names no datum, so it is not known how the two are related; name the true vertical CRS (gdal_translate -a_srs, --dem-vertical-crs, --vertical-crs), or leave out --vertical-crs and give --vertical-shift"
    )]
    NoVerticalDatum { path: PathBuf, from: String, to: String, unnamed: String },
    #[error(
        "heights of {first:?} are {first_says}, those of {other:?} {other_says}; name a common one with --vertical-crs, and with --dem-vertical-crs that of files that name none"
    )]
    MixedVertical { first: PathBuf, first_says: String, other: PathBuf, other_says: String },
    #[error(
        "heights of {path:?} cannot be carried from {from} to {to}: there is no geoid grid {grids}; put it there, or install one that PROJ knows (projsync, in Debian in the package proj-bin) and name its vertical CRS, or leave out --vertical-crs and give --vertical-shift"
    )]
    NoGeoidGrid { path: PathBuf, from: String, to: String, grids: String },
    #[error(
        "heights of {path:?} cannot be carried from {from} to {to}: PROJ has no exact operation from the one to the other here; a geoid grid may be missing ({grids}): install it (projsync, in Debian in the package proj-bin), or leave out --vertical-crs and give --vertical-shift"
    )]
    VerticalOperation {
        path: PathBuf,
        from: String,
        to: String,
        grids: String,
        source: Option<Box<LibraryError>>,
    },
    #[error(
        "geoid grid {grids:?} is marked optional (@), so that heights would stay as they are where it is missing; write it without @"
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
        "--crs {text:?} is not a coordinate system that PROJ knows; write dem (the DEM's own), utm, EPSG:n or WKT"
    )]
    WorkingCrsText { text: String, source: Box<LibraryError> },
    #[error(
        "--crs {text:?} is not a projected coordinate system with x to the right of y, nor the DEM's own; choose one that is"
    )]
    WorkingCrs { text: String },
    #[error("the DEM's centre has no position in {crs}; choose another --crs")]
    OutsideCrs { crs: String },
    #[error(
        "{asked} holds no cell of the elevation data, which reach from {west:.4} to {east:.4} degrees east and from {south:.4} to {north:.4} degrees north; give a part of these data (--bounds takes west,south,east,north in degrees{swapped})"
    )]
    BoundsBesideData {
        asked: String,
        west: f64,
        south: f64,
        east: f64,
        north: f64,
        /// The same bounds with longitude first, where these would have cells.
        swapped: String,
    },
    #[error(
        "{asked} lies at both ends of elevation data that go around the earth, and a package holds one region; make two packages, or give files that are continuous there"
    )]
    BoundsAtBothEnds { asked: String },
    #[error("{path:?} has no position in {crs}; choose another --crs, or leave the file out")]
    FileOutsideCrs { path: PathBuf, crs: String },
    #[error(
        "--cell {cell} is not usable; give metres between 0.001 and 1000000: a number, or east,north"
    )]
    Cell { cell: Cell },
    #[error(
        "the samples of {path:?} make a cell of {cell} in {crs}, but a side must have 0.001 to 1000000 m; give --crs dem, which keeps the file's own grid, or --cell"
    )]
    CellOfFile { path: PathBuf, cell: Cell, crs: String },
    #[error(
        "a cell of {cell} averages {samples:.0} DEM samples along a side, more than {limit}; use a smaller --cell"
    )]
    Downsampling { cell: Cell, samples: f64, limit: f64 },
    #[error("--cell-every {every} is not usable; give a number from 1 to {limit}")]
    CellEvery { every: u32, limit: i64 },
    #[error(
        "--cell-every {every} leaves {columns} × {rows} nodes; ground lies between nodes, so give a smaller number that leaves at least 2 × 2"
    )]
    CellEveryLeaves { every: u32, columns: i64, rows: i64 },
    #[error("--cell and --cell-every both say what a cell is; give one of them")]
    CellTwice,
    #[error(
        "--cell-every needs nodes that are the DEM's samples, and in {crs} they are not; {way_out}"
    )]
    CellEveryResampled { crs: String, way_out: &'static str },
    #[error("--scale-latitude {latitude_deg} is not usable; give degrees between -89 and 89")]
    ScaleLatitude { latitude_deg: f64 },
    #[error(
        "--scale-latitude {latitude_deg} and --crs utm do not go together: UTM has a scale of its own; leave out one of them"
    )]
    ScaleLatitudeUtm { latitude_deg: f64 },
    #[error(
        "the DEM's own coordinate system {crs} cannot be the working CRS here: its y axis does not lie to the left of its x axis, or the DEM's middle lies outside it; leave out --crs dem"
    )]
    OwnCrs { crs: String },
    #[error(
        "UTM is defined from 80° south to 84° north, and the DEM reaches from {south:.3}° to {north:.3}°; leave out --crs utm"
    )]
    NoUtm { south: f64, north: f64 },
    #[error(
        "a cell of {cell} puts {nodes:.0} nodes along a side of each DEM sample, more than {limit}: all but one of them \
         would be interpolated; use a larger --cell, or give --force if you want this"
    )]
    Oversampling { cell: Cell, nodes: f64, limit: f64 },
    #[error("--fill-voids {cells} is too far; at most {limit} cells")]
    FillVoids { cells: u32, limit: u32 },
    #[error("the DEM's grid cannot be made")]
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
        "the sample at column {column}, row {row} of {path:?} has no height in {to}: it lies outside PROJ's geoid grids; leave out --vertical-crs, or cut the file to where they reach"
    )]
    VerticalPosition { path: PathBuf, column: usize, row: usize, to: String },
    #[error(transparent)]
    Raster(#[from] RasterError),
    #[error(transparent)]
    Crs(#[from] CrsError),
}

/// Why values are taken for no heights.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AuditError {
    #[error(
        "{count} of {samples} samples of {files} hold {stored}, {gap_m:.0} m {} all others: a value that means \"no \
         data\" and is not declared as such; give it with --nodata {stored}, or if they are heights of {height_m} m allow \
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
         as {stored}; if that means \"no data\" give it with --nodata {stored}, if it is a height say what is allowed with \
         --height-range LOW,HIGH (metres)"
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

/// Whatever can go wrong with elevation files: for callers that do all of it.
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

/// Lets an error that has a variant `Dem(DemError)` be made of the error of each activity.
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

/// What to give in place of a file without heights, which may be another input.
fn what_to_give(path: &Path) -> &'static str {
    let is_extract = path.to_string_lossy().to_ascii_lowercase().contains(".osm")
        || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("pbf"));
    if is_extract {
        "an extract of OpenStreetMap is given with --osm"
    } else {
        "give a raster of heights"
    }
}
