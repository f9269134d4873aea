//! Commands that export packages to other formats.

use clap::{ArgAction, Args, Subcommand};
use corniche_export::{
    Availability, FeatureCoordinates, MeshFormat, ModelRoads, TileRoads, Tiling, UpAxis,
    VectorFormat,
};
use corniche_presets::{Words, one_of};

use super::{
    shared::{
        BoundsArg, ClassesArg, DatumArg, ExtractArgs, FileArgs, FolderArgs, LevelArg, PackageArg,
        RecordedArgs, RoadArg, ThreadsArg,
    },
    voice::json_progress,
};
#[derive(Debug, Subcommand)]
pub(crate) enum Export {
    /// Write the roads of a package, draped on its terrain, as lines with lengths and grades for
    /// GIS programs
    Roads(Box<ExportRoadsArgs>),
    /// Write the road network of a package's extract as edges from junction to junction, with
    /// ascents and grades, for routers
    Edges(Box<ExportEdgesArgs>),
    /// Write a layer of a package (areas, waterways, your own …) as lines, polygons or points for
    /// GIS programs
    Layer(Box<ExportLayerArgs>),
    /// Write the terrain and roads of a package as a model for 3D programs (GLB, PLY, OBJ)
    Mesh(Box<ExportMeshArgs>),
    /// Write the heights of a package as a raster (GeoTIFF), with --dem also their differences from
    /// the DEM
    #[command(name = "geotiff")]
    GeoTiff(Box<ExportGeoTiffArgs>),
    /// Write a package as 3D Tiles, with its roads cut into the terrain, for CesiumJS, three.js,
    /// deck.gl and game engines
    #[command(name = "3dtiles")]
    Tiles3d(Box<ExportTiles3dArgs>),
    /// Write the terrain of a package as quantized-mesh (layer.json and .terrain files) for
    /// CesiumJS
    #[command(name = "quantized-mesh")]
    QuantizedMesh(Box<ExportQuantizedMeshArgs>),
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export roads [OPTIONS] --output <FILE> <PACKAGE>",
    mut_arg("level", |arg| arg.help("The level whose roads are exported [default: the finest]")),
    mut_arg("dem", |arg| arg.help("The DEM the package was built from (same files, same order): heights are read from these files, not from the package's triangles")),
    mut_arg("osm", |arg| arg.requires("dem")),
)]
pub(crate) struct ExportRoadsArgs {
    #[command(flatten)]
    pub vector: VectorArgs,
    #[command(flatten)]
    pub at: LevelArg,
    /// Write one feature per piece of a way, as stored in the tiles, instead of one per way
    #[arg(long)]
    pub pieces: bool,
    #[command(flatten)]
    pub filter: ClassesArg,
    #[command(flatten)]
    pub within: BoundsArg,
    #[command(flatten)]
    pub cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export edges [OPTIONS] --output <FILE> --dem <FILE>... --osm <FILE>... <PACKAGE>",
    mut_arg("dem", |arg| arg.required(true)),
    mut_arg("osm", |arg| arg.required(true).help("The extracts the package was built from: roads join at shared OSM nodes")),
)]
pub(crate) struct ExportEdgesArgs {
    #[command(flatten)]
    pub vector: VectorArgs,
    #[command(flatten)]
    pub cpu: ThreadsArg,
}

// Options of the exports of lines with heights.
#[derive(Debug, Args)]
pub(crate) struct VectorArgs {
    #[command(flatten)]
    pub from: RecordedArgs,
    #[command(flatten)]
    pub extract: ExtractArgs,
    #[command(flatten)]
    pub file: FileArgs,
    #[command(flatten)]
    pub road: RoadArg,
    /// Output format, if the file's extension does not name it
    #[arg(short, long, value_parser = one_of(VECTOR_FORMATS), value_name = "FORMAT")]
    pub format: Option<VectorFormat>,
    /// CRS of the coordinates: "package", "EPSG:4979" (with heights above the WGS84 ellipsoid),
    /// "EPSG:4326", or a projected CRS such as "EPSG:2056" [default: package; GeoJSON: EPSG:4326]
    #[arg(long, value_name = "CRS", value_parser = parse_crs)]
    pub crs: Option<FeatureCoordinates>,
    /// Do not convert heights to the WGS84 ellipsoid: --crs EPSG:4979 is then the same as EPSG:4326
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub heights: Option<FeatureCoordinates>,
    #[command(flatten)]
    pub datum: DatumArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("level", |arg| arg.help("The level whose objects are exported [default: the finest]")),
    mut_arg("bounds", |arg| arg.help("Clip objects to a bounding box in WGS84 degrees; one with west > east crosses 180°")),
)]
pub(crate) struct ExportLayerArgs {
    /// The id of the layer; corniche info lists those of a package
    #[arg(value_name = "LAYER")]
    pub layer: String,
    #[command(flatten)]
    pub from: PackageArg,
    #[command(flatten)]
    pub file: FileArgs,
    /// Output format, if the file's extension does not name it
    #[arg(short, long, value_parser = one_of(VECTOR_FORMATS), value_name = "FORMAT")]
    pub format: Option<VectorFormat>,
    #[command(flatten)]
    pub at: LevelArg,
    #[command(flatten)]
    pub within: BoundsArg,
    /// Classes to export, such as water,forest [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub classes: Vec<String>,
    /// Languages of additional fields with names, such as de,en
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub lang: Vec<String>,
    /// CRS of the coordinates: "package", "EPSG:4979" (with heights above the WGS84 ellipsoid),
    /// "EPSG:4326", or a projected CRS such as "EPSG:2056" [default: package; GeoJSON: EPSG:4326]
    #[arg(long, value_name = "CRS", value_parser = parse_crs)]
    pub crs: Option<FeatureCoordinates>,
    #[command(flatten)]
    pub datum: DatumArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("output", |arg| arg.help("The file to write; its extension selects the format: .glb, .ply or .obj")),
    mut_arg("bounds", |arg| arg.help("Export the whole triangles in a bounding box in WGS84 degrees; one with west > east crosses 180°")),
)]
pub(crate) struct ExportMeshArgs {
    #[command(flatten)]
    pub from: PackageArg,
    #[command(flatten)]
    pub file: FileArgs,
    /// Output format, if the file's extension does not name it
    #[arg(short, long, value_parser = one_of(MODEL_FORMATS), value_name = "FORMAT")]
    pub format: Option<MeshFormat>,
    #[command(flatten)]
    pub at: LevelArg,
    #[command(flatten)]
    pub within: BoundsArg,
    /// How roads are exported: lines (centre-lines on the ground), surfaces (with their true width,
    /// cut into the terrain's triangles) or none; with surfaces, bridges are slabs if the package
    /// has spans (bridges and tunnels between two points on the ground)
    #[arg(
        long,
        value_parser = one_of(MODEL_ROADS),
        default_value = "lines",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub roads: ModelRoads,
    /// Colours and widths of roads: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "STYLE", default_value = "road-atlas")]
    pub style: String,
    #[command(flatten)]
    pub filter: ClassesArg,
    /// Add normal maps of the terrain, from the package's relief (only .glb) [default: on for .glb]
    #[arg(long, value_parser = one_of(ON_NONE), value_name = "on|none", hide_possible_values = true)]
    pub relief: Option<bool>,
    /// The axis that points up: y (x east, z south) or z (x east, y north) [default: z for .ply,
    /// else y]
    #[arg(
        long,
        value_parser = one_of([("y", "", UpAxis::Y), ("z", "", UpAxis::Z)]),
        value_name = "AXIS"
    )]
    pub up: Option<UpAxis>,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export geotiff [OPTIONS] --output <FILE> <PACKAGE>",
    mut_arg("output", |arg| arg.help("The file to write: .tif or .tiff")),
    mut_arg("dem", |arg| arg.help("The DEM the package was built from (same files, same order): adds a second band, the heights of the triangles minus those of the DEM")),
    mut_arg("level", |arg| arg.help("The level whose triangles are sampled [default: the finest]; pixels are always the grid nodes of the finest level")),
    mut_arg("bounds", |arg| arg.help("Export the grid nodes in a bounding box in WGS84 degrees, rounded outwards; one with west > east crosses 180°")),
)]
pub(crate) struct ExportGeoTiffArgs {
    #[command(flatten)]
    pub from: RecordedArgs,
    #[command(flatten)]
    pub file: FileArgs,
    #[command(flatten)]
    pub at: LevelArg,
    #[command(flatten)]
    pub within: BoundsArg,
    #[command(flatten)]
    pub datum: DatumArg,
    #[command(flatten)]
    pub cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(arg = json_progress(), mut_arg("bounds", |arg| arg.help("Export the whole tiles that intersect a bounding box in WGS84 degrees: coarse tiles extend far beyond it; one with west > east crosses 180°")))]
pub(crate) struct ExportTiles3dArgs {
    #[command(flatten)]
    pub from: PackageArg,
    #[command(flatten)]
    pub folder: FolderArgs,
    /// How roads are exported: cut (surfaces with true widths, in the terrain's triangles), line
    /// (centre-lines above the ground), vector (vector content for CesiumJS) or none. With
    /// cut, bridges are slabs if the package has spans. Vector content is in a second tileset,
    /// roads/tileset.json; it follows a draft specification and is not valid glTF 2.0 for other
    /// programs
    #[arg(
        long,
        value_parser = one_of(TILE_ROADS),
        default_value = "cut",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub roads: TileRoads,
    #[command(flatten)]
    pub filter: ClassesArg,
    /// Colours and widths: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "STYLE", default_value = "road-atlas")]
    pub style: String,
    /// The finest level to write [default: the package's finest]
    #[arg(long, value_name = "Z")]
    pub finest_level: Option<u8>,
    #[command(flatten)]
    pub within: BoundsArg,
    /// Add normal maps of the terrain, from the package's relief
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of(ON_NONE),
        default_value = "on",
        value_name = "on|none",
        hide_possible_values = true
    )]
    pub relief: bool,
    /// Add skirts below the borders of tiles, which hide gaps between levels
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of(ON_NONE),
        default_value = "on",
        value_name = "on|none",
        hide_possible_values = true
    )]
    pub skirts: bool,
    /// Lossless compression of vertices: meshopt, or none
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of([("meshopt", "", true), ("none", "", false)]),
        default_value = "meshopt",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub compress: bool,
    /// Do not convert heights to the WGS84 ellipsoid, although 3D Tiles expects ellipsoidal heights
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub heights: Option<FeatureCoordinates>,
    #[command(flatten)]
    pub datum: DatumArg,
    #[command(flatten)]
    pub cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("output", |arg| arg.help("The folder to write: layer.json and a folder for each level")),
    mut_arg("bounds", |arg| arg.help("Export the whole tiles of the finest level that intersect a bounding box in WGS84 degrees, and their parents; one with west > east crosses 180°")),
)]
pub(crate) struct ExportQuantizedMeshArgs {
    #[command(flatten)]
    pub from: PackageArg,
    #[command(flatten)]
    pub folder: FolderArgs,
    /// The tiling scheme: geographic (EPSG:4326) or web-mercator (EPSG:3857)
    #[arg(
        long,
        value_parser = one_of([
            ("geographic", "", Tiling::Geographic),
            ("web-mercator", "", Tiling::WebMercator),
        ]),
        default_value = "geographic",
        value_name = "GRID",
        hide_possible_values = true
    )]
    pub tiling: Tiling,
    /// The finest level [default: the first level whose cell size or whose error is at most the
    /// package's]
    #[arg(long, value_name = "Z", value_parser = clap::value_parser!(u8).range(0..=24))]
    pub max_level: Option<u8>,
    /// Fail if the export would have more files than this
    #[arg(long, value_name = "N", default_value_t = 250_000)]
    pub max_files: u64,
    #[command(flatten)]
    pub within: BoundsArg,
    /// How tile availability is stored: layer (in layer.json) or tiles (as metadata in the tiles of
    /// every tenth level, which keeps layer.json small)
    #[arg(
        long,
        value_parser = one_of([
            ("layer", "", Availability::Layer),
            ("tiles", "", Availability::Tiles),
        ]),
        default_value = "layer",
        value_name = "WHERE",
        hide_possible_values = true
    )]
    pub availability: Availability,
    /// Compression of files: none, or gzip for servers that then send "Content-Encoding: gzip"
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of([("none", "", false), ("gzip", "", true)]),
        default_value = "none",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub compress: bool,
    /// Do not convert heights to the WGS84 ellipsoid, although quantized-mesh expects ellipsoidal
    /// heights
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub heights: Option<FeatureCoordinates>,
    #[command(flatten)]
    pub datum: DatumArg,
    #[command(flatten)]
    pub cpu: ThreadsArg,
}

/// The values of `--roads` for 3D Tiles.
const TILE_ROADS: Words<TileRoads, 4> = [
    ("cut", "Surfaces in the terrain's triangles", TileRoads::Cut),
    ("line", "Centre-lines above the ground", TileRoads::Line),
    ("vector", "Centre-lines as vector content", TileRoads::Vector),
    ("none", "No roads", TileRoads::None),
];

/// The values of `--roads` for a model.
const MODEL_ROADS: Words<ModelRoads, 3> = [
    ("lines", "Centre-lines on the ground", ModelRoads::Lines),
    ("surfaces", "Surfaces in the terrain's own triangles", ModelRoads::Surfaces),
    ("none", "No roads", ModelRoads::None),
];

/// The values of switches: normal maps, skirts.
const ON_NONE: Words<bool, 2> = [("on", "", true), ("none", "", false)];

/// The values of `--heights`.
const HEIGHTS: Words<FeatureCoordinates, 1> =
    [("as-is", "The package's heights, unconverted", FeatureCoordinates::Wgs84WithPackageHeights)];

/// Formats of models, by file extension.
pub(crate) const MODEL_FORMATS: Words<MeshFormat, 3> = [
    ("glb", "Binary glTF 2.0", MeshFormat::Glb),
    ("ply", "PLY, binary, positions in double precision", MeshFormat::Ply),
    ("obj", "Wavefront OBJ", MeshFormat::Obj),
];

/// Formats of features, by file extension.
pub(crate) const VECTOR_FORMATS: Words<VectorFormat, 4> = [
    ("gpkg", "GeoPackage", VectorFormat::GeoPackage),
    ("fgb", "FlatGeobuf", VectorFormat::FlatGeobuf),
    ("geojson", "GeoJSON (RFC 7946)", VectorFormat::GeoJson),
    ("csv", "Comma-separated values, geometries as WKT", VectorFormat::Csv),
];

fn parse_crs(text: &str) -> Result<FeatureCoordinates, String> {
    if text == "package" {
        return Ok(FeatureCoordinates::Package);
    }
    let code = match text.split_once(':') {
        Some((registry, code)) if registry.trim().eq_ignore_ascii_case("EPSG") => Some(code),
        Some(_) => None,
        None => Some(text),
    };
    match code.and_then(|code| code.trim().parse().ok()) {
        Some(4979) => Ok(FeatureCoordinates::Wgs84),
        Some(4326) => Ok(FeatureCoordinates::Wgs84WithPackageHeights),
        Some(code) => Ok(FeatureCoordinates::Epsg(code)),
        None => Err(
            "use \"package\", EPSG:4326 or a projected CRS as EPSG:n; for other CRSs run ogr2ogr -t_srs on the result".to_owned()
        ),
    }
}

#[cfg(test)]
#[path = "export_tests.rs"]
mod tests;
