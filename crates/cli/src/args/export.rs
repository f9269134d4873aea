//! Commands that give what a package holds to other programs.

use clap::{ArgAction, Args, Subcommand, ValueHint};
use corniche_areas::{AreaClass, ClassedLayer, LineClass};
use corniche_export::{
    Availability, Coordinates, MeshFormat, ModelRoads, TileRoads, Tiling, UpAxis, VectorFormat,
};
use corniche_presets::{Words, one_of};
use corniche_remote::PackagePlace;

use super::{
    shared::{
        BoundsArg, ClassesArg, DatumArg, ExtractArgs, FileArgs, FolderArgs, LevelArg, PackageArg,
        RecordedArgs, RoadArg, ThreadsArg,
    },
    values::package_place,
    voice::json_progress,
};
#[derive(Debug, Subcommand)]
pub(crate) enum Export {
    /// Write the roads of a package, on its terrain, as lines with lengths and grades for GIS programs
    Roads(Box<ExportRoadsArgs>),
    /// Write the roads of a package's extract from junction to junction, with ascents and grades, for routers
    Edges(Box<ExportEdgesArgs>),
    /// Write the areas of a package (water, forest and so on) as polygons for GIS programs
    Areas(Box<ExportAreasArgs>),
    /// Write the boundaries of a package (administrative, protected) as lines for GIS programs
    Boundaries(Box<ExportBoundariesArgs>),
    /// Write the ground of a package and its roads as a model for 3D programs (GLB, PLY, OBJ)
    Mesh(Box<ExportMeshArgs>),
    /// Write the heights of a package as a raster (GeoTIFF), with --dem also how far they are from the elevation files
    #[command(name = "geotiff")]
    GeoTiff(Box<ExportGeoTiffArgs>),
    /// Write a package as 3D Tiles, with its roads cut into the ground, for CesiumJS, three.js, deck.gl and game engines
    #[command(name = "3dtiles")]
    Tiles3d(Box<ExportTiles3dArgs>),
    /// Write the ground of a package as quantized-mesh terrain (layer.json and .terrain files) for the globe of CesiumJS
    #[command(name = "quantized-mesh")]
    QuantizedMesh(Box<ExportQuantizedMeshArgs>),
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export roads [OPTIONS] --output <FILE> <PACKAGE>",
    mut_arg("level", |arg| arg.help("The level whose roads are taken [default: the finest]")),
    mut_arg("dem", |arg| arg.help("The elevation rasters the package was made from, in the same order: heights are theirs, not those of the package's triangles")),
    mut_arg("osm", |arg| arg.requires("dem")),
)]
pub(crate) struct ExportRoadsArgs {
    #[command(flatten)]
    pub(crate) vector: VectorArgs,
    #[command(flatten)]
    pub(crate) at: LevelArg,
    /// One feature for each piece of a road as the tiles have them, in place of one for each way
    #[arg(long)]
    pub(crate) pieces: bool,
    #[command(flatten)]
    pub(crate) filter: ClassesArg,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export edges [OPTIONS] --output <FILE> --dem <FILE>... --osm <FILE>... <PACKAGE>",
    mut_arg("dem", |arg| arg.required(true)),
    mut_arg("osm", |arg| arg.required(true).help("The extracts the package was made from: roads join where they name the same node")),
)]
pub(crate) struct ExportEdgesArgs {
    #[command(flatten)]
    pub(crate) vector: VectorArgs,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

// What exports of lines with heights have.
#[derive(Debug, Args)]
pub(crate) struct VectorArgs {
    #[command(flatten)]
    pub(crate) from: RecordedArgs,
    #[command(flatten)]
    pub(crate) extract: ExtractArgs,
    #[command(flatten)]
    pub(crate) file: FileArgs,
    #[command(flatten)]
    pub(crate) road: RoadArg,
    /// The format of a file with another ending
    #[arg(short, long, value_parser = one_of(VECTOR_FORMATS), value_name = "FORMAT")]
    pub(crate) format: Option<VectorFormat>,
    /// The coordinates: "package", "EPSG:4979" (with heights above the ellipsoid of WGS84), "EPSG:4326", or a projected CRS such as "EPSG:2056" [default:
    /// package; GeoJSON: EPSG:4326]
    #[arg(long, value_name = "CRS", value_parser = parse_crs)]
    pub(crate) crs: Option<Coordinates>,
    /// Keep the package's heights as they are: --crs EPSG:4979 is then EPSG:4326
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub(crate) heights: Option<Coordinates>,
    #[command(flatten)]
    pub(crate) datum: DatumArg,
}

// What exports of layers without heights have.
#[derive(Debug, Args)]
pub(crate) struct InPlanArgs {
    #[command(flatten)]
    pub(crate) file: FileArgs,
    /// The format of a file with another ending
    #[arg(short, long, value_parser = one_of(VECTOR_FORMATS), value_name = "FORMAT")]
    pub(crate) format: Option<VectorFormat>,
    #[command(flatten)]
    pub(crate) at: LevelArg,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    /// The coordinates: "package" (its CRS), "EPSG:4326" (longitude and latitude of WGS84), or a projected CRS such as "EPSG:2056" [default: package; GeoJSON:
    /// EPSG:4326]
    #[arg(long, value_name = "CRS", value_parser = parse_plan_crs)]
    pub(crate) crs: Option<Coordinates>,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("level", |arg| arg.help("The level whose areas are taken [default: the finest]")),
    mut_arg("bounds", |arg| arg.help("Cut areas at a rectangle of WGS84 degrees; a west beyond the east crosses 180°")),
)]
pub(crate) struct ExportAreasArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    #[command(flatten)]
    pub(crate) plan: InPlanArgs,
    /// Classes that are taken, such as water,forest [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_area_class)]
    pub(crate) classes: Vec<AreaClass>,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("level", |arg| arg.help("The level whose boundaries are taken [default: the finest]")),
    mut_arg("bounds", |arg| arg.help("Cut boundaries at a rectangle of WGS84 degrees; a west beyond the east crosses 180°")),
    mut_arg("osm", |arg| arg.help("The extracts the package was made from: boundaries then have the names of what they bound")),
)]
pub(crate) struct ExportBoundariesArgs {
    /// The package: a file, or an address on a web server (https://…)
    #[arg(required_unless_present = "osm", value_parser = package_place(), value_hint = ValueHint::AnyPath)]
    pub(crate) package: Option<PackagePlace>,
    #[command(flatten)]
    pub(crate) plan: InPlanArgs,
    /// Classes that are taken, such as admin-2,admin-8,protected [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_boundary_class)]
    pub(crate) classes: Vec<LineClass>,
    #[command(flatten)]
    pub(crate) extract: ExtractArgs,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("output", |arg| arg.help("The file to write; its ending is its format: .glb, .ply or .obj")),
    mut_arg("bounds", |arg| arg.help("Take what lies in a rectangle of WGS84 degrees, in whole triangles; a west beyond the east crosses 180°")),
)]
pub(crate) struct ExportMeshArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    #[command(flatten)]
    pub(crate) file: FileArgs,
    /// The format of a file with another ending
    #[arg(short, long, value_parser = one_of(MODEL_FORMATS), value_name = "FORMAT")]
    pub(crate) format: Option<MeshFormat>,
    #[command(flatten)]
    pub(crate) at: LevelArg,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    /// How roads are there: lines (centre-lines on the ground), surfaces (of their true width, in the ground's own triangles) or none; bridges are slabs of surfaces if the package has spans
    #[arg(
        long,
        value_parser = one_of(MODEL_ROADS),
        default_value = "lines",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub(crate) roads: ModelRoads,
    /// Colours and widths of roads: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "STYLE", default_value = "road-atlas")]
    pub(crate) style: String,
    #[command(flatten)]
    pub(crate) filter: ClassesArg,
    /// With .glb: normal maps of the ground from the package's relief [default: on for .glb]
    #[arg(long, value_parser = one_of(ON_NONE), value_name = "on|none", hide_possible_values = true)]
    pub(crate) relief: Option<bool>,
    /// The axis that points up: y (x east, z south) or z (x east, y north) [default: z for .ply, else y]
    #[arg(
        long,
        value_parser = one_of([("y", "", UpAxis::Y), ("z", "", UpAxis::Z)]),
        value_name = "AXIS"
    )]
    pub(crate) up: Option<UpAxis>,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    override_usage = "corniche export geotiff [OPTIONS] --output <FILE> <PACKAGE>",
    mut_arg("output", |arg| arg.help("The file to write: .tif or .tiff")),
    mut_arg("dem", |arg| arg.help("The elevation rasters the package was made from, in the same order: a second band has TIN minus DEM")),
    mut_arg("level", |arg| arg.help("The level whose triangles are taken [default: the finest]; pixels are the nodes of the finest level in any case")),
    mut_arg("bounds", |arg| arg.help("Take the nodes in a rectangle of WGS84 degrees, rounded outwards; a west beyond the east crosses 180°")),
)]
pub(crate) struct ExportGeoTiffArgs {
    #[command(flatten)]
    pub(crate) from: RecordedArgs,
    #[command(flatten)]
    pub(crate) file: FileArgs,
    #[command(flatten)]
    pub(crate) at: LevelArg,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    #[command(flatten)]
    pub(crate) datum: DatumArg,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(arg = json_progress(), mut_arg("bounds", |arg| arg.help("Take the tiles that meet a rectangle of WGS84 degrees, whole: coarse ones reach far beyond it; a west beyond the east crosses 180°")))]
pub(crate) struct ExportTiles3dArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    #[command(flatten)]
    pub(crate) folder: FolderArgs,
    /// How roads are there: cut (surfaces of true width), line (centre-lines just above the ground), vector (these as vector content
    /// for CesiumJS) or none. Surfaces are in the ground's own triangles, and bridges are slabs if the package has spans;
    /// vector content is in a second tileset, roads/tileset.json, a draft, and not valid glTF 2.0 for others
    #[arg(
        long,
        value_parser = one_of(TILE_ROADS),
        default_value = "cut",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub(crate) roads: TileRoads,
    #[command(flatten)]
    pub(crate) filter: ClassesArg,
    /// Colours and widths: road-atlas, dark, relief, photo or a style file (TOML)
    #[arg(long, value_name = "STYLE", default_value = "road-atlas")]
    pub(crate) style: String,
    /// The finest level that is written [default: the package's finest]
    #[arg(long, value_name = "Z")]
    pub(crate) finest_level: Option<u8>,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    /// Normal maps of the ground from the package's relief
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of(ON_NONE),
        default_value = "on",
        value_name = "on|none",
        hide_possible_values = true
    )]
    pub(crate) relief: bool,
    /// Walls below the borders of tiles, which hide gaps between levels
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of(ON_NONE),
        default_value = "on",
        value_name = "on|none",
        hide_possible_values = true
    )]
    pub(crate) skirts: bool,
    /// Compression of vertices without loss: meshopt, or none
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of([("meshopt", "", true), ("none", "", false)]),
        default_value = "meshopt",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub(crate) compress: bool,
    /// Keep the package's heights as they are, although 3D Tiles count heights from the ellipsoid of WGS84
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub(crate) heights: Option<Coordinates>,
    #[command(flatten)]
    pub(crate) datum: DatumArg,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

#[derive(Debug, Args)]
#[command(
    arg = json_progress(),
    mut_arg("output", |arg| arg.help("The folder to write: layer.json and a folder for each level")),
    mut_arg("bounds", |arg| arg.help("Take the tiles of the finest level that meet a rectangle of WGS84 degrees, whole, and those above them; a west beyond the east crosses 180°")),
)]
pub(crate) struct ExportQuantizedMeshArgs {
    #[command(flatten)]
    pub(crate) from: PackageArg,
    #[command(flatten)]
    pub(crate) folder: FolderArgs,
    /// The grid of tiles: geographic (EPSG:4326) or web-mercator (EPSG:3857)
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
    pub(crate) tiling: Tiling,
    /// The finest level [default: the one with the package's cells, or a coarser one whose error is the package's]
    #[arg(long, value_name = "Z", value_parser = clap::value_parser!(u8).range(0..=24))]
    pub(crate) max_level: Option<u8>,
    /// Refuse to write more files than this
    #[arg(long, value_name = "N", default_value_t = 250_000)]
    pub(crate) max_files: u64,
    #[command(flatten)]
    pub(crate) within: BoundsArg,
    /// Where it is told which tiles there are: layer (in layer.json) or tiles (in tiles of each tenth level: layer.json stays small with many tiles)
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
    pub(crate) availability: Availability,
    /// Compression of files: none, or gzip for servers that then send "Content-Encoding: gzip"
    #[arg(
        long,
        action = ArgAction::Set,
        value_parser = one_of([("none", "", false), ("gzip", "", true)]),
        default_value = "none",
        value_name = "HOW",
        hide_possible_values = true
    )]
    pub(crate) compress: bool,
    /// Keep the package's heights as they are, although quantized-mesh counts heights from the ellipsoid of WGS84
    #[arg(long, value_parser = one_of(HEIGHTS), value_name = "as-is")]
    pub(crate) heights: Option<Coordinates>,
    #[command(flatten)]
    pub(crate) datum: DatumArg,
    #[command(flatten)]
    pub(crate) cpu: ThreadsArg,
}

/// What 3D Tiles have of roads.
const TILE_ROADS: Words<TileRoads, 4> = [
    ("cut", "Surfaces in the ground's triangles", TileRoads::Cut),
    ("line", "Centre-lines above the ground", TileRoads::Line),
    ("vector", "Centre-lines as vector content", TileRoads::Vector),
    ("none", "Nothing", TileRoads::None),
];

/// What a model has of roads.
const MODEL_ROADS: Words<ModelRoads, 3> = [
    ("lines", "Their centre-lines on the ground", ModelRoads::Lines),
    ("surfaces", "Surfaces in the ground's own triangles", ModelRoads::Surfaces),
    ("none", "Nothing", ModelRoads::None),
];

/// Whether an export has something: normal maps of the ground, walls below the borders of tiles.
const ON_NONE: Words<bool, 2> = [("on", "", true), ("none", "", false)];

/// What becomes of heights in degrees of WGS84.
const HEIGHTS: Words<Coordinates, 1> =
    [("as-is", "The package's heights", Coordinates::Wgs84WithPackageHeights)];

/// Formats of models by the endings of their files.
pub(crate) const MODEL_FORMATS: Words<MeshFormat, 3> = [
    ("glb", "Binary glTF 2.0", MeshFormat::Glb),
    ("ply", "PLY, binary, positions in double precision", MeshFormat::Ply),
    ("obj", "Wavefront OBJ", MeshFormat::Obj),
];

/// Formats of features by the endings of their files.
pub(crate) const VECTOR_FORMATS: Words<VectorFormat, 4> = [
    ("gpkg", "GeoPackage", VectorFormat::GeoPackage),
    ("fgb", "FlatGeobuf", VectorFormat::FlatGeobuf),
    ("geojson", "GeoJSON (RFC 7946)", VectorFormat::GeoJson),
    ("csv", "Comma-separated values, geometries as WKT", VectorFormat::Csv),
];

fn parse_area_class(text: &str) -> Result<AreaClass, String> {
    class_named(text, "areas", &AreaClass::ALL)
}

fn parse_boundary_class(text: &str) -> Result<LineClass, String> {
    let layer = ClassedLayer::Boundaries;
    class_named(text, layer.name(), &layer.classes())
}

fn class_named<C: Copy + ToString>(text: &str, layer: &str, classes: &[C]) -> Result<C, String> {
    let names: Vec<String> = classes.iter().map(ToString::to_string).collect();
    let place = names.iter().position(|name| name == text);
    let class = place.map(|place| classes[place]);
    class.ok_or_else(|| format!("classes of {layer} are {}", names.join(", ")))
}

fn parse_plan_crs(text: &str) -> Result<Coordinates, String> {
    match parse_crs(text)? {
        Coordinates::Wgs84 => {
            Err("EPSG:4979 has heights, which these layers have not; give EPSG:4326".to_owned())
        }
        crs => Ok(crs),
    }
}

fn parse_crs(text: &str) -> Result<Coordinates, String> {
    if text == "package" {
        return Ok(Coordinates::Package);
    }
    let code = match text.split_once(':') {
        Some((registry, code)) if registry.trim().eq_ignore_ascii_case("EPSG") => Some(code),
        Some(_) => None,
        None => Some(text),
    };
    match code.and_then(|code| code.trim().parse().ok()) {
        Some(4979) => Ok(Coordinates::Wgs84),
        Some(4326) => Ok(Coordinates::Wgs84WithPackageHeights),
        Some(code) => Ok(Coordinates::Epsg(code)),
        None => Err(
            "give \"package\", EPSG:4326 or a projected CRS as EPSG:n; for others use ogr2ogr -t_srs on the result".to_owned()
        ),
    }
}

#[cfg(test)]
#[path = "export_tests.rs"]
mod tests;
