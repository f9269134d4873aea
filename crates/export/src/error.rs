//! Errors of exports: one enum for each activity, so that a function's signature lists its errors.
//!
//! ```text
//!   FeaturesError  RasterError  MeshError  Tiles3dError  QuantizedMeshError  ProfileError  RouteError
//!        │
//!        └──► their parts:          SelectionError  CoordinatesError  TileError  SurfaceError
//!                                   ElevationError  RoadQueryError  GdalFileError
//! ```

#![expect(missing_docs, reason = "each message documents its variant")]

use std::{
    io,
    path::{Path, PathBuf},
};

use corniche_dem::ReadHeightsError;
use corniche_drape::BadLine;
use corniche_geom::{ProjectError, TileId, TooMuchWork};
use corniche_gis::{CrsError, LibraryError};
use corniche_layers::{LayerForm, OsmObject};
use corniche_store::LackOfRoom;
use corniche_tileset::{FilePackage, LayerRecord, LayerSlot, OpenError, ReadError};

/// The kind of an error, from which callers derive an exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// The package or the request cannot be used.
    Unusable,
    /// The export failed for another reason.
    Failed,
    /// The user or the caller requested a stop.
    Interrupted,
}

/// Declares the error enum of an activity: with the errors of its parts (for activities that read a
/// `package`, including those of reading it), and its own errors. Own errors in `failed` mean that
/// the export failed, others that the package or the request cannot be used.
macro_rules! activity {
(
$(#[$doc:meta])*
$error:ident: package [$($more:tt)*] $($rest:tt)*
) => {
activity! {
$(#[$doc])*
$error: [
Selection(SelectionError) FeatureCoordinates(CoordinatesError) Tile(TileError) $($more)*
] $($rest)*
}
};
(
        $(#[$doc:meta])*
        $error:ident: [$($part:ident($inner:ident))*] failed [$($failed:ident)*] { $($own:tt)* }
    ) => {
        $(#[$doc])*
        #[derive(Debug, thiserror::Error)]
        #[non_exhaustive]
        pub enum $error {
            $(#[error(transparent)]
            $part(#[from] $inner),)*
            $($own)*
            #[error("interrupted")]
            Interrupted,
        }

        impl $error {
            /// The kind of the error.
            #[must_use]
            #[allow(unreachable_patterns, reason = "all own errors may be failures")]
            pub fn kind(&self) -> ErrorKind {
                match self {
                    Self::Interrupted => ErrorKind::Interrupted,
                    $(Self::$failed { .. } => ErrorKind::Failed,)*
                    $(Self::$part(error) => error.kind(),)*
                    _ => ErrorKind::Unusable,
                }
            }
        }

        corniche_work::from_interrupted!($error);
    };
}

/// Converts errors of reading tiles to the errors of activities that read them.
macro_rules! reads_tiles {
    ($($error:ident)*) => {$(
        impl From<OpenError> for $error {
            fn from(error: OpenError) -> Self {
                Self::Tile(error.into())
            }
        }

        impl From<ReadError> for $error {
            fn from(error: ReadError) -> Self {
                Self::Tile(error.into())
            }
        }
    )*};
}

/// An error enum whose errors are all of one kind.
trait OfOneKind {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Unusable
    }
}

impl OfOneKind for SelectionError {}
impl OfOneKind for TileError {}
impl OfOneKind for CoordinatesError {}

impl OfOneKind for GdalFileError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Failed
    }
}

reads_tiles! {
    SurfaceError RoadQueryError FeaturesError RouteError ProfileError MeshError Tiles3dError
    QuantizedMeshError RasterError
}

/// The error of a tile whose road outlines cannot be triangulated with its ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the outlines of roads cannot be triangulated")]
pub struct CutError;

/// Errors of requests for something that the package does not have.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SelectionError {
    #[error("{package:?} has no level {level}; its finest level is {finest}")]
    NoLevel { package: PathBuf, level: u8, finest: u8 },
    #[error("{package:?} has no layers; build it again with --osm and --layers")]
    NoLayers { package: PathBuf },
    #[error("{package:?} has no layer {layer:?}; its layers are {layers}")]
    NoLayer { package: PathBuf, layer: String, layers: String },
    #[error("layer {layer:?} has no class {class:?}; its classes are {classes}")]
    NoClass { layer: String, class: String, classes: String },
    #[error("{package:?} has no roads: it was built without --osm; build it again with an extract")]
    NoRoads { package: PathBuf },
    #[error("{package:?} has no ground in the requested area; corniche info prints its extent")]
    NoGround { package: PathBuf },
}

impl SelectionError {
    /// Returns the error of a package without ground in the requested area.
    pub(crate) fn no_ground(package: &FilePackage) -> Self {
        Self::NoGround { package: package.path().to_path_buf() }
    }

    /// Returns a layer of a package by its id.
    pub(crate) fn find_layer<'a>(
        package: &'a FilePackage,
        layer: &str,
    ) -> Result<(LayerSlot, &'a LayerRecord), Self> {
        let manifest = package.manifest();
        manifest.layer(layer).ok_or_else(|| {
            let ids = manifest.layers().map(|(_, record)| record.table.id.as_str());
            let layers = ids.collect::<Vec<_>>().join(", ");
            let (package, layer) = (package.path().to_path_buf(), layer.to_owned());
            if layers.is_empty() {
                Self::NoLayers { package }
            } else {
                Self::NoLayer { package, layer, layers }
            }
        })
    }

    /// Returns the classes of a layer with these ids as flags, in the order of its table; all of
    /// them without ids.
    pub(crate) fn find_classes(table: &LayerForm, ids: &[String]) -> Result<Vec<bool>, Self> {
        let all = || table.classes.iter().map(|class| class.id.as_str());
        if let Some(class) = ids.iter().find(|id| !all().any(|class| class == **id)) {
            return Err(Self::NoClass {
                layer: table.id.clone(),
                class: class.clone(),
                classes: all().collect::<Vec<_>>().join(", "),
            });
        }
        Ok(all().map(|class| ids.is_empty() || ids.iter().any(|id| id == class)).collect())
    }

    /// Fails if a package was built without an extract.
    pub(crate) fn check_roads(package: &FilePackage) -> Result<(), Self> {
        if package.manifest().has_extract() {
            Ok(())
        } else {
            Err(Self::NoRoads { package: package.path().to_path_buf() })
        }
    }
}

/// Errors of reading a tile of a package.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TileError {
    #[error(transparent)]
    Package(#[from] OpenError),
    #[error(transparent)]
    Tile(#[from] ReadError),
    #[error("the lines of tile {tile} do not match its ground; run corniche verify for details")]
    Line { tile: TileId, source: BadLine },
    #[error(
        "tile {tile} contains way {way_id}, but not its attributes; run corniche verify for details"
    )]
    NoAttributes { tile: TileId, way_id: i64 },
}

/// Errors of naming the vertical datum of a package.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DatumError {
    #[error(
        "the vertical datum of the package is already known, {datum:?}; omit --dem-vertical-crs"
    )]
    KnownDatum { datum: String },
    #[error("--dem-vertical-crs cannot be used")]
    VerticalCrs(#[source] Box<CrsError>),
    #[error(
        "--dem-vertical-crs {text} is not in metres upwards, but the package was built as if its heights were in metres; build it again with \
         --dem-vertical-crs {text}"
    )]
    NotInMetres { text: String },
}

/// Errors of transforming places to the requested coordinates.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CoordinatesError {
    #[error(
        "heights above the ellipsoid cannot be computed: the vertical datum of the package is {datum:?}; pass its vertical CRS with \
         --dem-vertical-crs EPSG:N, here or when you build the package, or keep the package's heights with --heights as-is"
    )]
    UnknownDatum { datum: String },
    #[error(
        "heights in vertical datum {datum:?} cannot be transformed to the ellipsoid of WGS84: a geoid grid may be missing; install it with projsync \
         (Debian: package proj-bin), or keep the package's heights with --heights as-is"
    )]
    Heights { datum: String, source: Box<CrsError> },
    #[error(
        "a height in vertical datum {datum:?} near {lon:.5}, {lat:.5} cannot be transformed to the ellipsoid of WGS84: the geoid grid does not cover this position; keep \
         the package's heights with --heights as-is"
    )]
    NoHeightHere { datum: String, lon: f64, lat: f64 },
    #[error("the package's CRS cannot be used")]
    Crs(#[source] Box<CrsError>),
    #[error("positions cannot be transformed to WGS84")]
    Project(#[from] ProjectError),
    #[error("a position of the ground has no longitude and latitude in WGS84")]
    NoGroundPosition,
    #[error("coordinates cannot be transformed to the requested CRS; choose another --crs")]
    OtherCrs(#[source] Box<CrsError>),
    #[error(
        "a position of {object} has no coordinates in the requested CRS; choose another CRS with --crs, or clip with --bounds"
    )]
    NoPosition { object: OsmObject },
    #[error(
        "{object} crosses 180 degrees of longitude and cannot be split there; export it in the package's CRS"
    )]
    AcrossAntimeridian { object: OsmObject },
}

impl CoordinatesError {
    /// Returns the error of heights that cannot be transformed from a datum.
    pub(crate) fn of_heights(datum: &str) -> impl FnOnce(CrsError) -> Self {
        |source| Self::Heights { datum: datum.to_owned(), source: Box::new(source) }
    }
}

impl From<ReadHeightsError> for ElevationError {
    fn from(source: ReadHeightsError) -> Self {
        Self::Read(Box::new(source))
    }
}

impl From<CrsError> for CoordinatesError {
    fn from(source: CrsError) -> Self {
        Self::Crs(Box::new(source))
    }
}

activity! {
    /// Errors of reading heights of the elevation files.
    ElevationError: [] failed [] {
        #[error("the elevation files cannot be read")]
        Read(#[source] Box<ReadHeightsError>),
    }
}

/// Errors of creating the surfaces of a tile's roads, or the images of its ground.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    #[error(transparent)]
    Tile(#[from] TileError),
    #[error(
        "the bridges of tile {tile} cover more ground than in any valid package; run corniche verify for details"
    )]
    TooManyBridges { tile: TileId, source: TooMuchWork },
    #[error(
        "tile {tile} cannot be written with its roads as surfaces; avoid them with --roads line or --roads none"
    )]
    Cut { tile: TileId, source: CutError },
    #[error(
        "the photo of tile {tile} cannot be encoded as an image; choose a --style without photos"
    )]
    Picture { tile: TileId, source: Box<jpeg_encoder::EncodingError> },
    #[error("the relief of tile {tile} cannot be encoded as an image; omit it with --relief none")]
    Relief { tile: TileId, source: Box<image::ImageError> },
}

impl SurfaceError {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Tile(_) | Self::TooManyBridges { .. } => ErrorKind::Unusable,
            Self::Cut { .. } | Self::Picture { .. } | Self::Relief { .. } => ErrorKind::Failed,
        }
    }
}

/// Errors of writing a file through GDAL.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GdalFileError {
    #[error(
        "this GDAL has no driver {driver} for writing; install a GDAL with it, or choose another format"
    )]
    NoDriver { driver: &'static str },
    #[error("cannot write {path:?}{}", LackOfRoom::advice(*.room))]
    Write { path: PathBuf, room: Option<LackOfRoom>, source: Box<LibraryError> },
    #[error(
        "{path:?} is incomplete: {written} features were written, but {found} can be read back{}",
        LackOfRoom::advice(*.room)
    )]
    NotWhole { path: PathBuf, room: Option<LackOfRoom>, written: u64, found: u64 },
    #[error(
        "{path:?} is incomplete: the data read back differs from the data written{}",
        LackOfRoom::advice(*.room)
    )]
    RasterNotWhole { path: PathBuf, room: Option<LackOfRoom> },
    #[error("cannot read back {path:?}")]
    ReadAgain { path: PathBuf, source: io::Error },
}

impl GdalFileError {
    /// Returns the error of a library that could not write a file; the file still exists.
    pub(crate) fn write(path: &Path, source: impl Into<Box<LibraryError>>) -> Self {
        Self::Write { path: path.to_path_buf(), room: LackOfRoom::at(path), source: source.into() }
    }
}

activity! {
    /// Errors of finding the ways with a number or a name.
    RoadQueryError: [Tile(TileError)] failed [] {
        #[error("{package:?} has no road with {query}{near}; list its roads with corniche export roads (the search ignores spaces, hyphens and case)")]
        NoSuchRoad { package: PathBuf, query: String, near: String },
    }
}

activity! {
    /// Errors of writing roads, edges or layers as features, and of measuring the growth of ways.
    FeaturesError: package [
        Road(RoadQueryError) Elevation(ElevationError) File(GdalFileError)
    ] failed [Sort] {
        #[error("{object} differs between tiles; run corniche verify for details")]
        Differs { object: OsmObject },
        #[error("{object} cannot be clipped to --bounds; omit --bounds")]
        BoundsAcross { object: OsmObject },
        #[error(
            "the lines of a tile cross its ground more often than in any valid package; run corniche verify for details"
        )]
        TooManyCrossings(#[from] TooMuchWork),
        #[error(
            "GeoJSON needs longitudes and latitudes of WGS84 (RFC 7946); omit --crs, name a registered CRS (--crs EPSG:N), or choose another format"
        )]
        GeoJsonCrs,
        #[error("cannot use a temporary file for sorting in {folder:?}{}", LackOfRoom::advice(LackOfRoom::from_io_error(.source)))]
        Sort { folder: PathBuf, source: io::Error },
    }
}

activity! {
    /// Errors of finding a route through the network.
    RouteError: package [Road(RoadQueryError)] failed [] {
        #[error(
            "{} roads with {query} are not connected; name the ways of one of them with --way, or two places on it with --from LON,LAT --to LON,LAT",
            roads.len()
        )]
        SeveralRoads { query: String, roads: Vec<String> },
        #[error(
            "the ways with {query} are interrupted by more than 300 m of other roads near {lon:.5},{lat:.5}; omit --ref and --name, or choose --from and --to on one part of the road"
        )]
        RoadInterrupted { query: String, lon: f64, lat: f64 },
        #[error(
            "there are no {of} within 500 m of {lon},{lat}: the nearest are {off_m:.0} m away; {covered}"
        )]
        FarFromRoads { of: String, lon: f64, lat: f64, off_m: f64, covered: String },
        #[error("there are no {of} near {lon},{lat}; {covered}")]
        NoRoadNear { of: String, lon: f64, lat: f64, covered: String },
        #[error("no {of} in the package lead from {},{} to {},{}; bounds or a void may interrupt them", ends[0][0], ends[0][1], ends[1][0], ends[1][1])]
        NotConnected { of: String, ends: [[f64; 2]; 2] },
        #[error(
            "the package has no {of} among the roads that a route may follow; choose other classes with --classes"
        )]
        NothingToFollow { of: String },
        #[error(
            "--from and --to snap to one place on a road; choose places that are farther apart"
        )]
        OnePlace,
    }
}

activity! {
    /// Errors of computing the profile of ways or lines.
    ProfileError: package [Elevation(ElevationError)] failed [] {
        #[error(
            "{package:?} has no way {way_id} on level {level}; list the ways of the package with corniche export roads"
        )]
        NoWay { package: PathBuf, way_id: i64, level: u8 },
        #[error("no line crosses the ground of {package:?}{begins}; {covered}")]
        NoLineOnGround { package: PathBuf, begins: String, covered: String },
        #[error(
            "the lines cross so many triangles that their profile would have millions of points; choose a coarser level with --level, or simplify the lines (ogr2ogr -simplify)"
        )]
        TooManyCrossings(#[from] TooMuchWork),
    }
}

activity! {
    /// Errors of writing a model of a level.
    MeshError: package [Surface(SurfaceError)] failed [Write] {
        #[error("the y axis of glTF always points up; omit --up z, or choose another format")]
        GlbAxis,
        #[error("cannot write {path:?}{}", LackOfRoom::advice(LackOfRoom::from_io_error(.source)))]
        Write { path: PathBuf, source: io::Error },
    }
}

activity! {
    /// Errors of writing 3D Tiles.
    Tiles3dError: package [Surface(SurfaceError)] failed [Write] {
        #[error("the tiles cannot be written{}", LackOfRoom::advice(LackOfRoom::from_io_error(.source)))]
        Write { #[from] source: io::Error },
    }
}

activity! {
    /// Errors of writing quantized-mesh terrain.
    QuantizedMeshError: package [] failed [Write Triangulate] {
        #[error(
            "the data reaches latitude {lat:.2}, but Web Mercator ends at {north:.2}; use --tiling geographic"
        )]
        BeyondGrid { lat: f64, north: f64 },
        #[error(
            "level {finest} would have more than {most} tiles, the limit of an export; limit the levels with --max-level {level}"
        )]
        TooManyTiles { finest: u8, most: u64, level: u8 },
        #[error(
            "levels 0 to {finest} would need up to {files} files, more than {most}; allow them with --max-files {files}, or limit the levels with --max-level {level}"
        )]
        TooManyFiles { finest: u8, files: u64, most: u64, level: u8 },
        #[error(
            "{package:?}: its table of coordinates contradicts its bounds in degrees; run corniche verify for details"
        )]
        OtherCoordinates { package: PathBuf },
        #[error("terrain tile {tile} cannot be triangulated")]
        Triangulate { tile: String, source: corniche_tin::TriangulateError },
        #[error("the tiles cannot be written{}", LackOfRoom::advice(LackOfRoom::from_io_error(.source)))]
        Write { #[from] source: io::Error },
    }
}

activity! {
    /// Errors of writing a raster of heights.
    RasterError: package [Elevation(ElevationError) File(GdalFileError)] failed [] {
        #[error(
            "the raster would have {columns} × {rows} grid nodes, but the tiles of level {level} have at most {within} of them; limit the raster with \
             --bounds to the part that has ground"
        )]
        MostlyNothing { columns: usize, rows: usize, level: u8, within: u64 },
    }
}
