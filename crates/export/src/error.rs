//! Why exports fail: an enum for each activity, so that a signature tells what can happen.
//!
//! ```text
//!   FeaturesError  RasterError  MeshError  Tiles3dError  QuantizedMeshError  ProfileError  RouteError
//!        │
//!        └──► what each is made of: SelectionError  CoordinatesError  TileError  SurfaceError
//!                                   ElevationError  RoadQueryError  GdalFileError
//! ```

#![expect(missing_docs, reason = "each message documents its variant")]

use std::{
    io,
    path::{Path, PathBuf},
};

use corniche_areas::AreaObject;
use corniche_dem::ReadHeightsError;
use corniche_drape::BadLine;
use corniche_geom::{ProjectError, TileId, TooMuchWork};
use corniche_gis::{CrsError, LibraryError};
use corniche_store::LackOfRoom;
use corniche_tileset::{DecodeError, FilePackage, OpenError, ReadError};

/// What an error asks of whoever meets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// The package or the request cannot be used.
    Unusable,
    /// Something failed.
    Failed,
    /// The work was asked to stop.
    Interrupted,
}

/// Declares the error of an activity: the errors of what it is made of, and its own. Own ones in
/// `failed` say that something failed, others that the package or the request is of no use.
macro_rules! activity {
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
            /// What it asks of whoever meets it.
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

/// What reads tiles can meet their errors.
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

/// All errors of one enum are of one kind.
trait OfOneKind {
    /// What they ask of whoever meets them.
    const KIND: ErrorKind;

    fn kind(&self) -> ErrorKind {
        Self::KIND
    }
}

macro_rules! of_one_kind {
    ($($error:ident: $kind:ident;)*) => {$(
        impl OfOneKind for $error {
            const KIND: ErrorKind = ErrorKind::$kind;
        }
    )*};
}

reads_tiles! {
    SurfaceError RoadQueryError FeaturesError RouteError ProfileError MeshError Tiles3dError
    QuantizedMeshError RasterError
}

of_one_kind! {
    SelectionError: Unusable;
    TileError: Unusable;
    CoordinatesError: Unusable;
    GdalFileError: Failed;
}

/// The outlines of a tile's roads make no triangulation with its ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the outlines of its roads cannot be triangulated")]
pub struct CutError;

/// Why the package has not what is asked for.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SelectionError {
    #[error("{package:?} has no level {level}; its finest is {finest}")]
    NoLevel { package: PathBuf, level: u8, finest: u8 },
    #[error("{package:?} has no {layer}: it was built without --{layer}")]
    NoLayer { package: PathBuf, layer: &'static str },
    #[error("{package:?} has no roads: it was built without --osm")]
    NoRoads { package: PathBuf },
    #[error("{package:?} has no ground there; corniche info tells its extent")]
    NoGround { package: PathBuf },
}

impl SelectionError {
    /// The package has no ground there.
    pub(crate) fn no_ground(package: &FilePackage) -> Self {
        Self::NoGround { package: package.path().to_path_buf() }
    }

    /// Fails where a package lacks a layer that is asked for.
    pub(crate) fn check_layer<T>(
        package: &FilePackage,
        layer: &'static str,
        found: Option<&T>,
    ) -> Result<(), Self> {
        let missing = || Self::NoLayer { package: package.path().to_path_buf(), layer };
        found.map(drop).ok_or_else(missing)
    }

    /// Fails where a package was built without an extract.
    pub(crate) fn check_roads(package: &FilePackage) -> Result<(), Self> {
        if package.manifest().has_extract() {
            Ok(())
        } else {
            Err(Self::NoRoads { package: package.path().to_path_buf() })
        }
    }
}

/// Why a tile of a package cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TileError {
    #[error(transparent)]
    Package(#[from] OpenError),
    #[error(transparent)]
    Tile(#[from] ReadError),
    #[error("the roads of tile {tile} do not fit its ground; corniche verify says more")]
    Line { tile: TileId, source: BadLine },
    #[error("tile {tile} knows nothing of way {way_id}, which it holds; corniche verify says more")]
    NoAttributes { tile: TileId, way_id: i64 },
    #[error("the {layer} of a tile are damaged; corniche verify says more")]
    Damaged { layer: &'static str, source: Box<DecodeError> },
}

/// Why heights are not known to be measured from a datum that is told.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DatumError {
    #[error(
        "what the package's heights are measured from is known, {datum:?}; leave --dem-vertical-crs out"
    )]
    KnownDatum { datum: String },
    #[error("--dem-vertical-crs cannot be used")]
    VerticalCrs(#[source] Box<CrsError>),
    #[error(
        "--dem-vertical-crs {text} is not in metres upwards, and the package has taken its heights for metres; build it again with \
         --dem-vertical-crs {text}"
    )]
    NotInMetres { text: String },
}

/// Why places cannot be carried to the coordinates that are asked for.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CoordinatesError {
    #[error(
        "heights above the ellipsoid cannot be told: what the package's heights are measured from is {datum:?}; say it with \
         --dem-vertical-crs EPSG:N, here or when the package is built, or keep the heights as they are with --heights as-is"
    )]
    UnknownDatum { datum: String },
    #[error(
        "heights of {datum:?} cannot be carried to the ellipsoid of WGS84: a geoid grid may be missing; get it with projsync \
         (Debian: package proj-bin), or keep the heights as they are with --heights as-is"
    )]
    Heights { datum: String, source: Box<CrsError> },
    #[error(
        "a height of {datum:?} near {lon:.5}, {lat:.5} has no height above the ellipsoid of WGS84: the geoid grid ends before; keep \
         the heights as they are with --heights as-is"
    )]
    NoHeightHere { datum: String, lon: f64, lat: f64 },
    #[error("the package's CRS cannot be used")]
    Crs(#[source] Box<CrsError>),
    #[error("positions cannot be carried to WGS84")]
    Project(#[from] ProjectError),
    #[error("a position of the ground has no longitude and latitude in WGS84")]
    NoGroundPosition,
    #[error("the coordinates cannot be made")]
    OtherCrs(#[source] Box<CrsError>),
    #[error(
        "a position of {object} has no place in the CRS that is asked for; choose another with --crs, or cut with --bounds"
    )]
    NoPosition { object: AreaObject },
    #[error(
        "{object} lies across 180 degrees of longitude and cannot be cut there; export it in the package's CRS"
    )]
    AcrossAntimeridian { object: AreaObject },
}

impl From<CrsError> for CoordinatesError {
    fn from(source: CrsError) -> Self {
        Self::Crs(Box::new(source))
    }
}

activity! {
    /// Why heights of the elevation files are not known.
    ElevationError: [] failed [] {
        #[error("the elevation files cannot be read")]
        Read(#[source] Box<ReadHeightsError>),
    }
}

/// Why a tile has no surfaces of roads, or no picture for its ground.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    #[error(transparent)]
    Tile(#[from] TileError),
    #[error(
        "the bridges of tile {tile} lie over more ground than any writer makes; corniche verify says more"
    )]
    TooManyBridges { tile: TileId, source: TooMuchWork },
    #[error(
        "tile {tile} cannot be written with its roads as surfaces; --roads line or none does without"
    )]
    Cut { tile: TileId, source: CutError },
    #[error(
        "the photo of tile {tile} cannot be written as a picture; a --style without photos does without"
    )]
    Picture { tile: TileId, source: Box<jpeg_encoder::EncodingError> },
    #[error("the relief of tile {tile} cannot be written as a picture; --relief none does without")]
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

/// Why a file that GDAL writes is not there, or not whole.
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
        "{path:?} is not whole: {written} features were written, {found} can be read{}",
        LackOfRoom::advice(*.room)
    )]
    NotWhole { path: PathBuf, room: Option<LackOfRoom>, written: u64, found: u64 },
    #[error(
        "{path:?} is not whole: what was written is not what can be read{}",
        LackOfRoom::advice(*.room)
    )]
    RasterNotWhole { path: PathBuf, room: Option<LackOfRoom> },
    #[error("cannot read {path:?} again")]
    ReadAgain { path: PathBuf, source: io::Error },
}

impl GdalFileError {
    /// A library could not write a file that is still there.
    pub(crate) fn write(path: &Path, source: impl Into<Box<LibraryError>>) -> Self {
        Self::Write { path: path.to_path_buf(), room: LackOfRoom::at(path), source: source.into() }
    }
}

activity! {
    /// Why the ways of a number or a name are not found.
    RoadQueryError: [Tile(TileError)] failed [] {
        #[error("{package:?} has no road with {query}{near}; spaces, hyphens and case do not matter")]
        NoSuchRoad { package: PathBuf, query: String, near: String },
    }
}

activity! {
    /// Why roads, edges, areas or lines cannot be written as features, or not be measured by way.
    FeaturesError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError) Road(RoadQueryError)
        Elevation(ElevationError) File(GdalFileError)
    ] failed [Sort] {
        #[error("{object} is not the same in all tiles; corniche verify says more")]
        Differs { object: AreaObject },
        #[error("{object} cannot be cut at --bounds; leave them out")]
        BoundsAcross { object: AreaObject },
        #[error(
            "GeoJSON has longitudes and latitudes of WGS84 (RFC 7946); leave --crs out, name a registered system (--crs EPSG:N), or choose another format"
        )]
        GeoJsonCrs,
        #[error("cannot sort in {folder:?}{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
        Sort { folder: PathBuf, source: io::Error },
    }
}

activity! {
    /// Why there is no way through the network, or not one alone.
    RouteError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError) Road(RoadQueryError)
    ] failed [] {
        #[error(
            "{} roads that are not connected have {query}; name the ways of one, or two places on it with --from LON,LAT --to LON,LAT",
            roads.len()
        )]
        SeveralRoads { query: String, roads: Vec<String> },
        #[error(
            "the ways with {query} are interrupted near {lon:.5},{lat:.5}, by more than 300 m of other roads; leave it out, or name places on one part with --from and --to"
        )]
        RoadInterrupted { query: String, lon: f64, lat: f64 },
        #[error(
            "there are no {of} within 500 m of {lon},{lat}: the nearest are {off_m:.0} m away; the package covers {covered}"
        )]
        FarFromRoads { of: String, lon: f64, lat: f64, off_m: f64, covered: String },
        #[error("there are no {of} near {lon},{lat}; the package covers {covered}")]
        NoRoadNear { of: String, lon: f64, lat: f64, covered: String },
        #[error("no {of} of the package lead from {},{} to {},{}; a bound or a void may cut them", ends[0][0], ends[0][1], ends[1][0], ends[1][1])]
        NotConnected { of: String, ends: [[f64; 2]; 2] },
        #[error(
            "{of} of the package cannot be followed: they are not among its roads of these classes"
        )]
        NothingToFollow { of: String },
        #[error(
            "--from and --to are nearest to one place of a road; give places that are farther apart"
        )]
        OnePlace,
    }
}

activity! {
    /// Why ways or lines have no profile.
    ProfileError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError)
        Elevation(ElevationError)
    ] failed [] {
        #[error(
            "{package:?} has no way {way_id} on level {level}; corniche export roads lists the ways that it has"
        )]
        NoWay { package: PathBuf, way_id: i64, level: u8 },
        #[error("no line lies on ground of {package:?}{begins}; the package covers {covered}")]
        NoLineOnGround { package: PathBuf, begins: String, covered: String },
        #[error(
            "the lines cross so many triangles that their profile would have millions of points; give a coarser level with --level, or simplify them (ogr2ogr -simplify)"
        )]
        TooManyCrossings(#[from] TooMuchWork),
    }
}

activity! {
    /// Why there is no model of a level.
    MeshError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError)
        Surface(SurfaceError)
    ] failed [Write] {
        #[error("glTF has the y axis upwards, always; leave --up z out, or choose another format")]
        GlbAxis,
        #[error("cannot write {path:?}{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
        Write { path: PathBuf, source: io::Error },
    }
}

activity! {
    /// Why there are no 3D Tiles.
    Tiles3dError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError)
        Surface(SurfaceError)
    ] failed [Write] {
        #[error("the tiles cannot be written{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
        Write { source: io::Error },
    }
}

activity! {
    /// Why there is no quantized-mesh terrain.
    QuantizedMeshError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError)
    ] failed [Write Triangulate] {
        #[error(
            "the data reach to latitude {lat:.2}, and Web Mercator ends at {north:.2}; use --tiling geographic"
        )]
        BeyondGrid { lat: f64, north: f64 },
        #[error(
            "level {finest} would have more than {most} tiles, which no export makes; end with --max-level {level}"
        )]
        TooManyTiles { finest: u8, most: u64, level: u8 },
        #[error(
            "levels 0 to {finest} would be up to {files} files, more than {most}; write them all with --max-files {files}, or end with --max-level {level}"
        )]
        TooManyFiles { finest: u8, files: u64, most: u64, level: u8 },
        #[error(
            "{package:?}: its table of coordinates and its rectangle in degrees do not agree; corniche verify tells more"
        )]
        OtherCoordinates { package: PathBuf },
        #[error("terrain tile {tile} cannot be triangulated")]
        Triangulate { tile: String, source: corniche_tin::TriangulateError },
        #[error("the tiles cannot be written{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
        Write { source: io::Error },
    }
}

activity! {
    /// Why there is no raster of heights.
    RasterError: [
        Selection(SelectionError) Coordinates(CoordinatesError) Tile(TileError)
        Elevation(ElevationError) File(GdalFileError)
    ] failed [] {
        #[error(
            "the raster would have {columns} × {rows} nodes, and the tiles of level {level} have no more than {within} of them, which is too few; give the part \
             with ground with --bounds"
        )]
        MostlyNothing { columns: usize, rows: usize, level: u8, within: u64 },
    }
}
