//! Errors of files and coordinate systems, one enum for each activity, and how messages name files.

#![expect(missing_docs, reason = "each message documents its variant")]

use std::{
    fmt,
    path::{Path, PathBuf},
};

use gdal::errors::GdalError;

use crate::LibraryError;

/// The purpose for which a file is read, as messages name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileUse {
    /// A raster, for its heights.
    Dem,
    /// A raster, for its colours.
    Photo,
    /// A vector file, to clip elevation data.
    Polygon,
    /// A vector file, to be drawn.
    Lines,
}

impl FileUse {
    /// One of two words: the first for heights and polygons, the second for photos and lines.
    fn pick(self, first: &'static str, second: &'static str) -> &'static str {
        if matches!(self, Self::Dem | Self::Polygon) { first } else { second }
    }
}

impl fmt::Display for FileUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Dem => "DEM",
            Self::Photo => "photo",
            Self::Polygon => "the polygon",
            Self::Lines => "the file of lines",
        })
    }
}

/// The largest number of files that a message names.
const MAX_NAMES: usize = 3;

/// The first few names, and the number of the others.
#[must_use]
pub fn first_names(names: impl ExactSizeIterator<Item = String>) -> String {
    names_up_to(MAX_NAMES, names)
}

/// Up to `most` names, and the number of the others.
#[must_use]
pub fn names_up_to(most: usize, names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(most);
    let told = names.take(most).collect::<Vec<_>>().join(", ");
    if more == 0 { told } else { format!("{told} and {more} more") }
}

/// Files as a message names them: quoted, and only the first few.
#[must_use]
pub fn listed_files<F: AsRef<Path>>(files: &[F]) -> String {
    first_names(files.iter().map(|file| format!("\"{}\"", file.as_ref().display())))
}

/// A file name that GDAL does not accept.
#[derive(Debug, thiserror::Error)]
#[error(
    "the name of {kind} {path:?} is not UTF-8, and GDAL accepts no other names here; rename the file (or its folder)"
)]
pub struct NotUtf8 {
    /// What the file is read for.
    pub kind: FileUse,
    /// The name.
    pub path: PathBuf,
}

/// Why a name matches no files.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NameError {
    #[error("cannot read {path:?}, a list or folder of input files")]
    List { path: PathBuf, source: std::io::Error },
    #[error("the list {path:?} names no file; write one file name per line")]
    EmptyList { path: PathBuf },
    #[error(
        "the folder {path:?} contains no {sought}; subfolders are not searched, so name the files or the right folder"
    )]
    EmptyFolder { path: PathBuf, sought: String },
    #[error("the pattern {pattern:?} is not usable: {reason}")]
    Pattern { pattern: String, reason: String },
    #[error(
        "{path:?} is not an archive with an elevation file (extensions {endings}) that GDAL can read; unpack it, or name the file in it as /vsizip/ARCHIVE/FILE"
    )]
    Archive { path: PathBuf, endings: String },
    #[error(transparent)]
    NotUtf8(#[from] NotUtf8),
}

/// Why a raster could not be opened, georeferenced or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RasterError {
    #[error("cannot open {kind} {path:?}")]
    Missing { kind: FileUse, path: PathBuf, source: std::io::Error },
    #[error(transparent)]
    NotUtf8(#[from] NotUtf8),
    #[error(
        "{path:?} is {found}, not a file; a raster is read in any order and more than once, so save it to a file first"
    )]
    Stream { path: PathBuf, found: &'static str },
    #[error("{path:?} is not a file; name the raster itself")]
    NotAFile { path: PathBuf },
    #[error("{path:?} is empty (0 bytes); download it again")]
    Empty { path: PathBuf },
    #[error(
        "{path:?} is not a raster that GDAL can read; it is corrupt, truncated, or of an unknown format"
    )]
    Open { path: PathBuf, source: Box<LibraryError> },
    #[error(
        "{path:?} has {bytes} bytes; whole .hgt files have 2884802 (cells of 3″), 25934402 (1″) or 12970802 (2″ × 1″), so this one is truncated or of another format: download it again"
    )]
    HgtSize { path: PathBuf, bytes: u64 },
    #[error(
        "the name of {path:?} does not give its position, and an .hgt file stores it nowhere else: name the file after its south-western corner, like N47E009.hgt"
    )]
    HgtName { path: PathBuf },
    #[error("cannot read {path:?}: {advice}")]
    NoDriver { path: PathBuf, advice: String },
    #[error("{path:?} is {found}; {advice}")]
    StandIn { path: PathBuf, found: &'static str, advice: &'static str },
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
        "{path:?} has a corner at {x}, {y}, which is not a longitude and latitude in {crs}; assign its true CRS with gdal_translate -a_srs"
    )]
    OffGlobe { path: PathBuf, x: f64, y: f64, crs: String },
    #[error("{path:?} names no usable coordinate system; pass its CRS with --dem-crs EPSG:n")]
    NoCrs { path: PathBuf },
    #[error(
        "{path:?} has coordinate system {name:?}, which is neither projected nor geographic; pass the true CRS with --dem-crs EPSG:n"
    )]
    UnusableCrs { path: PathBuf, name: String },
    #[error(transparent)]
    Crs(#[from] CrsError),
    #[error(
        "cannot read {} × {} {} at column {}, row {} of {}{path:?}; {}",
        .size[0], .size[1], .kind.pick("samples", "pixels"), .start[0], .start[1], .kind.pick("", "photo "),
        .kind.pick(
            "the file, or one that it refers to, is corrupt, truncated or missing: download it again",
            "it is corrupt or truncated: download it again"
        )
    )]
    Read {
        kind: FileUse,
        path: PathBuf,
        start: [usize; 2],
        size: [usize; 2],
        source: Box<LibraryError>,
    },
}

impl RasterError {
    /// GDAL cannot read a file, with GDAL's message.
    #[must_use]
    pub fn unreadable(path: &Path, source: GdalError) -> Self {
        Self::Open { path: path.to_path_buf(), source: source.into() }
    }
}

/// Why a coordinate system, or an operation between two, cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CrsError {
    #[error(
        "PROJ does not even know EPSG:4326: its database (proj.db) is missing or belongs to another version of PROJ; correct the installation, or the \
         environment variables PROJ_DATA and PROJ_LIB"
    )]
    NoProjTables { source: Box<LibraryError> },
    #[error("{option} {text:?} is not a coordinate system that PROJ knows; write EPSG:n or WKT")]
    Text { option: &'static str, text: String, source: Box<LibraryError> },
    #[error(
        "--crs {text} is not a projected CRS; pass a projected one, such as EPSG:2056, or WGS84 in degrees: EPSG:4326 (ETRS89 is within a metre of it), and EPSG:4979 with heights"
    )]
    NotProjected { text: String },
    #[error(
        "{option} {text:?} is neither projected nor geographic; write EPSG:n or WKT of a projected or geographic CRS"
    )]
    Kind { option: &'static str, text: String },
    #[error(
        "{option} {text:?} is not a vertical coordinate system that PROJ knows; write EPSG:n or WKT, such as EPSG:5773"
    )]
    VerticalText { option: &'static str, text: String, source: Option<Box<LibraryError>> },
    #[error(
        "vertical coordinate system {name:?} has no unit of length for its axis; pass another one, such as EPSG:5773"
    )]
    VerticalUnit { name: String },
    #[error("coordinate system {name:?} cannot be written as WKT; pass another one as EPSG:n")]
    Wkt { name: String, source: Box<LibraryError> },
    #[error(
        "PROJ knows no transformation from {from} to {to}; choose another --crs, or correct the files' CRS with gdal_translate -a_srs"
    )]
    Transform { from: String, to: String, source: Box<LibraryError> },
    #[error("--bounds {bounds} has no position in {crs}; choose another --crs or other bounds")]
    BoundsOutside { bounds: String, crs: String },
    #[error(
        "{whose}: PROJ knows no transformation between the geodetic datums of {} and {}, and would treat them as the same ({:?}): ground, roads and \
         other data can then be off by 100 m or more; assign the true coordinate system (gdal_edit.py -a_srs EPSG:n; \
         for vectors ogr2ogr -a_srs), or pass --allow-ballpark if you want this",
        .between[0], .between[1], .between[2]
    )]
    Ballpark {
        whose: String,
        /// The source datum, the target datum, and the operation.
        between: Box<[String; 3]>,
    },
}

/// Why a vector file could not be opened or read completely.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VectorError {
    #[error("cannot open {kind} {path:?}")]
    Missing { kind: FileUse, path: PathBuf, source: std::io::Error },
    #[error("{kind} {path:?} is a pipe or a device; save it to a file first")]
    Stream { kind: FileUse, path: PathBuf },
    #[error(
        "{path:?} is not a vector file that GDAL can read; it is corrupt, truncated, or of an unknown format; GeoJSON, {}GeoPackage and Shapefile can be read (ogr2ogr converts others)",
        .kind.pick("", "GPX, ")
    )]
    Open { kind: FileUse, path: PathBuf, source: Box<LibraryError> },
    #[error("cannot read {path:?}: {advice}")]
    NoDriver { path: PathBuf, advice: String },
    #[error(
        "not all features of {}{path:?} can be read; download or export it again",
        .kind.pick("the polygon ", "")
    )]
    Damaged { kind: FileUse, path: PathBuf, source: Box<LibraryError> },
    #[error(
        "layer {layer:?} of {}{path:?} claims to have {claimed} features, and {found} can be read: it is corrupt or truncated; download or export it again",
        .kind.pick("the polygon ", "")
    )]
    CutOff { kind: FileUse, path: PathBuf, layer: String, claimed: u64, found: u64 },
}

/// Why a file has no valid polygon to clip elevation data, or the polygon cannot be transformed to
/// a working CRS.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    #[error(transparent)]
    Vector(#[from] VectorError),
    #[error(transparent)]
    Transform(#[from] CrsError),
    #[error(
        "{path:?} has no polygon: it is empty; pass a file with one or more polygons, which are merged"
    )]
    Empty { path: PathBuf },
    #[error(
        "feature {feature} of {path:?} is a {found}, which encloses no area; pass a file with polygons only (ogr2ogr -where selects features, -nlt CONVERT_TO_LINEAR makes arcs straight)"
    )]
    OtherGeometry { path: PathBuf, feature: u64, found: String },
    #[error(
        "the polygon {path:?} names no coordinate system; assign one: ogr2ogr -a_srs EPSG:n NEW.gpkg {path:?}, or add the .prj file of a Shapefile"
    )]
    NoCrs { path: PathBuf },
    #[error("the coordinate system of the polygon {path:?} cannot be used: {reason}")]
    Crs { path: PathBuf, reason: String },
    #[error(
        "feature {feature} of the polygon {path:?} is not valid ({reason}), so its interior is undefined; repair it: ogr2ogr -makevalid NEW.gpkg {path:?}"
    )]
    Invalid { path: PathBuf, feature: u64, reason: String },
    #[error(
        "a ring of feature {feature} of the polygon {path:?} begins at {}, {} and ends at {}, {}; close it: repeat the first \
         position as the last one (RFC 7946, section 3.1.6)",
        .first[0], .first[1], .last[0], .last[1]
    )]
    OpenRing { path: PathBuf, feature: u64, first: [f64; 2], last: [f64; 2] },
    #[error(
        "feature {feature} of the polygon {path:?} has an edge over more than half of the earth: if it crosses 180°, cut it there (ogr2ogr -wrapdateline NEW.geojson {path:?})"
    )]
    HalfTheEarth { path: PathBuf, feature: u64 },
    #[error("the polygon {path:?} has more than {limit} corners; simplify it (ogr2ogr -simplify)")]
    TooManyCorners { path: PathBuf, limit: usize },
    #[error(
        "the polygon {path:?} reaches into areas where {crs} has no positions or is discontinuous; clip it to the surroundings of the elevation data (ogr2ogr -clipsrc), or choose another --crs"
    )]
    OutsideCrs { path: PathBuf, crs: String },
    #[error("the polygon {path:?} encloses no area; its corners are on one line or at one point")]
    NoArea { path: PathBuf },
}
