//! Errors of opening, planning and reading elevation files.

use std::path::{Path, PathBuf};

use corniche_geom::{Cell, GridFrameError};

use crate::LibraryError;

/// Why elevation files could not be opened, planned or read.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum DemError {
    #[error("no DEM file is given")]
    NoFiles,
    #[error("cannot read {path:?}, which was to name files")]
    List { path: PathBuf, source: std::io::Error },
    #[error("the list {path:?} names no file; write the name of a file on each line")]
    EmptyList { path: PathBuf },
    #[error(
        "the folder {path:?} holds no elevation file (names ending in {endings}, or these in .gz or .zip); folders in it are not looked into, so name the files or the right folder"
    )]
    EmptyFolder { path: PathBuf, endings: String },
    #[error(
        "the folder {path:?} holds no extract (names ending in .pbf); folders in it are not looked into, so name the files or the right folder"
    )]
    NoExtracts { path: PathBuf },
    #[error(
        "the folder {path:?} holds no photo (names ending in {endings}, or these in .gz or .zip); folders in it are not looked into, so name the files or the right folder"
    )]
    NoPhotos { path: PathBuf, endings: String },
    #[error("the pattern {pattern:?} names no file: {reason}")]
    Pattern { pattern: String, reason: String },
    #[error(
        "{path:?} is no archive with an elevation file (names ending in {endings}) that GDAL can read; unpack it, or name the file in it as /vsizip/ARCHIVE/FILE"
    )]
    Archive { path: PathBuf, endings: String },
    #[error("cannot open DEM {path:?}")]
    Missing { path: PathBuf, source: std::io::Error },
    #[error(
        "{path:?} is {found}, not a file; a raster is read in any order and more than once, so save it to a file first"
    )]
    Stream { path: PathBuf, found: &'static str },
    #[error(
        "the name of DEM {path:?} is not UTF-8, and GDAL takes no other names here; rename the file (or its folder)"
    )]
    NotUtf8 { path: PathBuf },
    #[error("{path:?} is not a file; name the raster itself")]
    NotAFile { path: PathBuf },
    #[error("{path:?} is empty (0 bytes); fetch it again")]
    Empty { path: PathBuf },
    #[error(
        "{path:?} is not a raster that GDAL can read; it is damaged, cut off, or of an unknown format"
    )]
    Open { path: PathBuf, source: Box<LibraryError> },
    #[error(
        "{path:?} has {bytes} bytes; whole .hgt files have 2884802 (cells of 3″), 25934402 (1″) or 12970802 (2″ × 1″), so it is cut off or of another kind: fetch it again"
    )]
    HgtSize { path: PathBuf, bytes: u64 },
    #[error(
        "the name of {path:?} does not say where it lies, and nothing else of an .hgt file does: call it like N47E009.hgt, after its south-western corner"
    )]
    HgtName { path: PathBuf },
    #[error("cannot read {path:?}: {advice}")]
    NoDriver { path: PathBuf, advice: String },
    #[error("{path:?} is {found}; {advice}")]
    StandIn { path: PathBuf, found: &'static str, advice: &'static str },
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
        "{path:?} has no georeference (geotransform); add one with gdal_translate -a_ullr or a world file"
    )]
    NoGeoTransform { path: PathBuf },
    #[error(
        "the geotransform ({}) of {path:?} is not usable, it has no inverse; correct it with gdal_translate -a_ullr",
        .coefficients.map(|value| value.to_string()).join(", ")
    )]
    GeoTransform { path: PathBuf, coefficients: [f64; 6] },
    #[error(
        "{path:?} has a corner at {x}, {y}, which is not a longitude and latitude in {crs}; name its true CRS with gdal_translate -a_srs"
    )]
    OffGlobe { path: PathBuf, x: f64, y: f64, crs: String },
    #[error("{path:?} names no usable coordinate system; give it with --dem-crs EPSG:n")]
    NoCrs { path: PathBuf },
    #[error(
        "{path:?} has coordinate system {name:?}, which is neither projected nor geographic; give it with --dem-crs EPSG:n"
    )]
    UnusableCrs { path: PathBuf, name: String },
    #[error(
        "PROJ does not even know EPSG:4326: its tables (proj.db) are not found, or those of another PROJ are; correct the installation, or the \
         variables of the environment that are read (PROJ_DATA, PROJ_LIB)"
    )]
    NoProjTables { source: Box<LibraryError> },
    #[error("{option} {text:?} is not a coordinate system that PROJ knows; write EPSG:n or WKT")]
    CrsText { option: &'static str, text: String, source: Box<LibraryError> },
    #[error(
        "--crs {text:?} is not a coordinate system that PROJ knows; write dem (the DEM's own), utm, EPSG:n or WKT"
    )]
    WorkingCrsText { text: String, source: Box<LibraryError> },
    #[error(
        "--crs {text} is not a projected CRS; give one that is, such as EPSG:2056, or degrees of WGS84: EPSG:4326, which ETRS89 is within a metre of, and EPSG:4979 with heights"
    )]
    NotProjected { text: String },
    #[error(
        "{option} {text:?} is neither projected nor geographic; write EPSG:n or WKT of one that is"
    )]
    CrsKind { option: &'static str, text: String },
    #[error(
        "{option} {text:?} is not a vertical coordinate system that PROJ knows; write EPSG:n or WKT, such as EPSG:5773"
    )]
    VerticalCrsText { option: &'static str, text: String, source: Option<Box<LibraryError>> },
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
        "vertical coordinate system {name:?} gives its axis no unit of length; name one that does, such as EPSG:5773"
    )]
    VerticalUnit { name: String },
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
        "the sample at column {column}, row {row} of {path:?} has no height in {to}: it lies outside PROJ's geoid grids; leave out --vertical-crs, or cut the file to where they reach"
    )]
    VerticalPosition { path: PathBuf, column: usize, row: usize, to: String },
    #[error(
        "geoid grid {grids:?} is marked optional (@), so that heights would stay as they are where it is missing; write it without @"
    )]
    OptionalGeoidGrid { grids: String },
    #[error(
        "--crs {text:?} is not a projected coordinate system with x to the right of y, nor the DEM's own; choose one that is"
    )]
    WorkingCrs { text: String },
    #[error("coordinate system {name:?} cannot be written down as WKT; give another by EPSG:n")]
    Wkt { name: String, source: Box<LibraryError> },
    #[error(
        "PROJ knows no transformation from {from} to {to}; choose another --crs, or correct the files' CRS with gdal_translate -a_srs"
    )]
    Transform { from: String, to: String, source: Box<LibraryError> },
    #[error(
        "{whose}: PROJ knows nothing between the datums of {from} and {to}, and would take the one for the other ({operation:?}): ground, roads and \
         what else is put together can then lie 100 m and more beside each other; name the true coordinate system (gdal_edit.py -a_srs EPSG:n; \
         for vectors ogr2ogr -a_srs), or give --allow-ballpark if you want this"
    )]
    Ballpark { whose: String, from: String, to: String, operation: String },
    #[error("the DEM's centre has no position in {crs}; choose another --crs")]
    OutsideCrs { crs: String },
    #[error(transparent)]
    Polygon(#[from] crate::PolygonError),
    #[error("--bounds {bounds} has no position in {crs}; choose another --crs or other bounds")]
    BoundsOutsideCrs { bounds: String, crs: String },
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
        "{path:?} lies nowhere on earth by its coordinate system {crs}; name its true CRS with gdal_translate -a_srs"
    )]
    Nowhere { path: PathBuf, crs: String },
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
    #[error(
        "{count} of {samples} samples of {files} hold {stored}, {gap_m:.0} m {side} all others: a value that means \"no \
         data\" and is not declared as such; give it with --nodata {stored}, or if they are heights of {height_m} m allow \
         them with --height-range {low_m},{high_m}"
    )]
    Sentinel {
        files: String,
        stored: String,
        count: u64,
        samples: u64,
        height_m: f64,
        gap_m: f64,
        side: &'static str,
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
    #[error("--fill-voids {cells} is too far; at most {limit} cells")]
    FillVoids { cells: u32, limit: u32 },
    #[error("the DEM's grid cannot be made")]
    Frame(#[from] GridFrameError),
    #[error("windows of stride {stride} are not read from the DEM, only of stride 1")]
    Stride { stride: i64 },
    #[error(
        "cannot read {columns} × {rows} samples at column {column}, row {row} of {path:?}; the file, or one that it refers to, is damaged, cut off or gone: fetch it again"
    )]
    Read {
        path: PathBuf,
        column: usize,
        row: usize,
        columns: usize,
        rows: usize,
        source: Box<LibraryError>,
    },
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
