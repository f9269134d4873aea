//! Errors of all exports.

use std::{
    io,
    path::{Path, PathBuf},
};

use corniche_areas::AreaObject;
use corniche_dem::ReadHeightsError;
use corniche_drape::BadLine;
use corniche_geom::{ProjectError, TileId};
use corniche_gis::{CrsError, LibraryError};
use corniche_store::LackOfRoom;
use corniche_tileset::{OpenError, ReadError};
use corniche_work::Interrupted;

/// The outlines of a tile's roads make no triangulation with its ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the outlines of its roads cannot be triangulated")]
pub struct CutError;

/// Why something could not be exported.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each message documents its variant")]
#[non_exhaustive]
pub enum ExportError {
    #[error(transparent)]
    Package(#[from] OpenError),
    #[error(transparent)]
    Tile(#[from] ReadError),
    #[error("the roads of tile {tile} do not fit its ground; corniche verify says more")]
    Line { tile: TileId, source: BadLine },
    #[error("tile {tile} knows nothing of way {way_id}, which it holds; corniche verify says more")]
    NoAttributes { tile: TileId, way_id: i64 },
    #[error("{object} is not the same in all tiles; corniche verify says more")]
    Differs { object: AreaObject },
    #[error("the {layer} of a tile are damaged; corniche verify says more")]
    Damaged { layer: &'static str, source: Box<corniche_tileset::DecodeError> },
    #[error("{object} cannot be cut at --bounds; leave them out")]
    BoundsAcross { object: AreaObject },
    #[error(
        "{object} lies across 180 degrees of longitude and cannot be cut there; export it in the package's CRS"
    )]
    AcrossAntimeridian { object: AreaObject },
    #[error("{package:?} has no {layer}: it was built without --{layer}")]
    NoLayer { package: PathBuf, layer: &'static str },
    #[error("{package:?} has no roads: it was built without --osm")]
    NoRoads { package: PathBuf },
    #[error(
        "{package:?} has no way {way_id} on level {level}; corniche export roads lists the ways that it has"
    )]
    NoWay { package: PathBuf, way_id: i64, level: u8 },
    #[error("{package:?} has no road with {query}{near}; spaces, hyphens and case do not matter")]
    NoSuchRoad { package: PathBuf, query: String, near: String },
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
    #[error(
        "the bridges of tile {tile} lie over more ground than any writer makes; corniche verify says more"
    )]
    TooManyBridges { tile: TileId, source: corniche_geom::TooMuchWork },
    #[error("no line lies on ground of {package:?}{begins}; the package covers {covered}")]
    NoLineOnGround { package: PathBuf, begins: String, covered: String },
    #[error("{package:?} has no ground there; corniche info tells its extent")]
    NoGround { package: PathBuf },
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
    #[error(
        "the raster would have {columns} × {rows} nodes, and the tiles of level {level} have no more than {within} of them, which is too few; give the part \
         with ground with --bounds"
    )]
    MostlyNothing { columns: usize, rows: usize, level: u8, within: u64 },
    #[error(
        "the lines cross so many triangles that their profile would have millions of points; give a coarser level with --level, or simplify them (ogr2ogr -simplify)"
    )]
    TooManyCrossings(#[from] corniche_geom::TooMuchWork),
    #[error("glTF has the y axis upwards, always; leave --up z out, or choose another format")]
    GlbAxis,
    #[error("cannot write {path:?}{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
    WriteModel { path: PathBuf, source: io::Error },
    #[error("the tiles cannot be written{}", LackOfRoom::advice(LackOfRoom::of(.0)))]
    WriteTiles(#[source] io::Error),
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
    #[error("terrain tile {tile} cannot be triangulated")]
    Triangulate { tile: String, source: corniche_tin::TriangulateError },
    #[error("{package:?} has no level {level}; its finest is {finest}")]
    NoLevel { package: PathBuf, level: u8, finest: u8 },
    #[error(
        "GeoJSON has longitudes and latitudes of WGS84 (RFC 7946); leave --crs out, name a registered system (--crs EPSG:N), or choose another format"
    )]
    GeoJsonCrs,
    #[error(
        "heights above the ellipsoid cannot be told: what the package's heights are measured from is {datum:?}; say it with \
         --dem-vertical-crs EPSG:N, here or when the package is built, or keep the heights as they are with --heights as-is"
    )]
    UnknownDatum { datum: String },
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
    #[error("the elevation files cannot be read")]
    Elevation(#[source] Box<ReadHeightsError>),
    #[error("cannot read {path:?} again")]
    ReadAgain { path: PathBuf, source: io::Error },
    #[error("cannot sort in {folder:?}{}", LackOfRoom::advice(LackOfRoom::of(.source)))]
    Sort { folder: PathBuf, source: io::Error },
    #[error("interrupted")]
    Interrupted,
}

impl From<Interrupted> for ExportError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

impl ExportError {
    /// A library could not write a file that is still there.
    pub(crate) fn write(path: &Path, source: impl Into<Box<LibraryError>>) -> Self {
        Self::Write { path: path.to_path_buf(), room: LackOfRoom::at(path), source: source.into() }
    }

    /// Whether the package or the request cannot be used, rather than that something failed.
    #[must_use]
    pub fn is_unusable_input(&self) -> bool {
        !matches!(
            self,
            Self::NoDriver { .. }
                | Self::Write { .. }
                | Self::WriteModel { .. }
                | Self::WriteTiles(_)
                | Self::Cut { .. }
                | Self::Picture { .. }
                | Self::Relief { .. }
                | Self::Triangulate { .. }
                | Self::NotWhole { .. }
                | Self::RasterNotWhole { .. }
                | Self::ReadAgain { .. }
                | Self::Sort { .. }
                | Self::Interrupted
        )
    }
}
