//! The schema of `corniche info --json`, and of rows of growth. Records of packages write most of it; this is only its schema.

#![expect(dead_code, reason = "only its schema is wanted")]

use schemars::JsonSchema;

use super::{
    areas::AreasDocument,
    lines::LinesDocument,
    record_schemas::{
        DistributionDocument, LeftOutDocument, LossDocument, NodeCountsDocument, NodeDocument,
        SamplesDocument,
    },
    settings_schema_tests::SettingsDocument,
    spans::SpansDocument,
};

/// What a package holds.
#[derive(JsonSchema)]
pub(crate) struct InfoDocument {
    /// Its table of contents.
    manifest: ManifestDocument,
    /// Its tiles, "z/x/y".
    tiles: Vec<String>,
}

/// The table of contents of a package.
#[derive(JsonSchema)]
pub(crate) struct ManifestDocument {
    /// Version of the encodings.
    format_version: u32,
    /// Program and version that wrote the package, with its GDAL and PROJ.
    generator: String,
    /// Says that z/x/y is a local quadtree in the working CRS.
    tiling: String,
    /// CRS: "EPSG:…" where it has a code, else its name. Its coordinates times `metres_per_unit` are working metres.
    crs: String,
    /// CRS as WKT2.
    crs_wkt: String,
    /// Working metres to a unit of the CRS's coordinates, east and north.
    metres_per_unit: [f64; 2],
    /// Working metres to a true metre, at the centre.
    point_scale: f64,
    /// The same along each axis, at the centre and over the data's rim.
    scale: ScaleDocument,
    /// The grid.
    frame: FrameDocument,
    /// Rectangle of the DEM's nodes, working metres.
    data_bounds: BoundsDocument,
    /// The same in WGS84 degrees.
    wgs84_bounds: BoundsDocument,
    /// The part of the elevation files that the package is of (`--bounds`, `--polygon`); left out where it is of all.
    #[serde(skip_serializing_if = "Option::is_none")]
    clip: Option<ClipDocument>,
    /// The outline of the elevation files, where they fill no rectangle, on the lattice: polygons of rings of [u, v].
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    /// How nodes relate to the DEM's samples, in words.
    resampling: String,
    /// Whether nodes and the DEM's samples are the same points.
    nodes_are_samples: bool,
    /// Heights.
    vertical: VerticalDocument,
    /// How positions come from one datum to another; left out where all datums are that of WGS84, and in packages of before.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    datum_operations: Vec<DatumOperationDocument>,
    /// WGS84 ⇄ working CRS without PROJ.
    coordinates: CoordinatesSchema,
    /// One for each level, root first.
    levels: Vec<LevelDocument>,
    /// Settings that determine the bytes.
    settings: SettingsDocument,
    /// SHA-256 of the settings.
    settings_sha256: String,
    /// What was read.
    inputs: Vec<InputDocument>,
    /// Credits to show wherever the package is shown.
    attribution: Vec<String>,
    /// What came in, what was kept, what was lost and why.
    counts: CountsDocument,
    /// What clipping costs, per level and class.
    growth: Vec<RowDocument>,
    /// The photos of each level that has some, root first; left out without any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    photos: Vec<PhotoLevelDocument>,
    /// The areas; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    areas: Option<AreasDocument>,
    /// The boundaries, in the classes "admin-2" to "admin-8" and "protected"; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    boundaries: Option<LinesDocument>,
    /// Bridges and tunnels off the ground, whose heights are estimates; left out in packages made without.
    #[serde(skip_serializing_if = "Option::is_none")]
    spans: Option<SpansDocument>,
    /// The tiles that end with most SV roads, each as level, column, row and how many bytes these are; left out where none has many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sv_tails: Vec<[u32; 4]>,
}

/// Working metres to a true metre, along x and along y.
#[derive(JsonSchema)]
struct ScaleDocument {
    /// In the middle of the data.
    center: [f64; 2],
    /// The smallest over corners, middles of sides and centre of every file.
    least: [f64; 2],
    /// The largest.
    largest: [f64; 2],
}

/// The grid of a package.
#[derive(JsonSchema)]
pub(crate) struct FrameDocument {
    /// Position of node 0, 0: x and y in working metres.
    origin_m: [f64; 2],
    /// Spacing of the finest nodes, east and north, working metres.
    cell_m: [f64; 2],
    /// North-west corner of the root tile.
    root_corner: NodeDocument,
    /// The finest level.
    max_level: u8,
}

/// A rectangle.
#[derive(JsonSchema)]
pub(crate) struct BoundsDocument {
    /// West edge.
    min_x: f64,
    /// South edge.
    min_y: f64,
    /// East edge.
    max_x: f64,
    /// North edge.
    max_y: f64,
}

/// The part of the elevation files that a package is of.
#[derive(JsonSchema)]
pub(crate) struct ClipDocument {
    /// The bounds that were asked for, rounded outwards to whole cells: south-western and north-eastern node. They may reach
    /// beyond the data.
    nodes: [NodeDocument; 2],
    /// Rectangle of the nodes of all elevation files, working metres.
    whole_data_bounds: BoundsDocument,
    /// The same in WGS84 degrees.
    whole_wgs84_bounds: BoundsDocument,
}

/// Heights: step, unit, datum.
#[derive(JsonSchema)]
struct VerticalDocument {
    /// One step of heights, metres.
    quantum_m: f64,
    /// Always "metre".
    unit: String,
    /// Vertical datum as far as the inputs name one, else "unknown".
    datum: String,
    /// What was done to the inputs' heights, in words.
    treatment: String,
    /// The step between heights that the DEM can tell apart, metres; 0 where they have fractions.
    height_step_m: f64,
    /// Lowest and highest node, metres.
    range_m: [f64; 2],
}

/// How positions come from one datum to another.
#[derive(JsonSchema)]
struct DatumOperationDocument {
    /// The system that positions are in.
    from: String,
    /// The system that they come to. The operation is also used the other way around.
    to: String,
    /// PROJ's name for the operation.
    operation: String,
    /// How accurate it is, metres; left out where PROJ does not know it.
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy_m: Option<f64>,
    /// Whether one datum was taken for another, as PROJ knows nothing between them; left out where not.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    ballpark: bool,
}

/// A table of longitudes and latitudes over the working CRS, to be interpolated by Lagrange's cubic along both axes. It writes itself;
/// this is its schema.
#[derive(JsonSchema)]
pub(crate) struct CoordinatesSchema {
    /// What it covers, working metres.
    bounds: BoundsDocument,
    /// Samples along each side.
    size: usize,
    /// Longitude and latitude of each sample, degrees, row by row from the south. Longitudes may run on past 180.
    samples_deg: Vec<[f64; 2]>,
}

/// What a level is, and how close it is to the data.
#[derive(JsonSchema)]
pub(crate) struct LevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Spacing of its nodes, east and north, working metres.
    cell_m: [f64; 2],
    /// Meshing tolerance against the level's own raster.
    max_error_m: f64,
    /// Largest stored geometric error of its tiles.
    geometric_error_m: f64,
    /// Stored geometric errors of its tiles; null on a level without tiles.
    errors_m: Option<DistributionDocument>,
    /// How far its TINs are from the DEM's own samples.
    sample_error: SamplesDocument,
    /// Stored error over the largest true one, where that can be measured.
    tightness: Option<DistributionDocument>,
    /// Least important class shown on this level; null shows no road.
    least_class: Option<u8>,
    /// Tolerance of the simplification of roads; 0 keeps every point.
    simplify_tolerance_m: f64,
    /// How far outside a tile its plan lines reach.
    width_margin_m: f64,
    /// Tiles with ground.
    tiles: u64,
    /// Triangles in them.
    triangles: u64,
    /// Vertices in them.
    vertices: u64,
    /// Stored bytes of their ground.
    terrain_bytes: u64,
    /// Stored bytes of their relief; 0 without.
    relief_bytes: u64,
    /// Full-resolution nodes with data that the level's TINs do not cover.
    uncovered_nodes: u64,
}

/// An input file.
#[derive(JsonSchema)]
struct InputDocument {
    /// "dem"; "dem-part", a file that the one before it refers to or that belongs to it; "photo"; "photo-part", likewise; "polygon"; or "osm".
    kind: String,
    /// File name without folders.
    name: String,
    /// Its size.
    bytes: u64,
    /// SHA-256 of its bytes.
    sha256: String,
}

/// What came in, what was kept, what was lost and why.
#[derive(JsonSchema)]
pub(crate) struct CountsDocument {
    /// Nodes of the finest grid over the data's rectangle.
    samples: NodeCountsDocument,
    /// Roads read from the extract: ways that the FRC table knows.
    roads_in: u64,
    /// Their true length in plan, micrometres.
    roads_in_um: u64,
    /// Roads of which anything is kept at the finest level.
    roads_kept: u64,
    /// True length in plan kept at the finest level, micrometres.
    roads_kept_um: u64,
    /// The difference, by reason.
    roads_lost: Vec<LossDocument>,
    /// Defects met in the extract.
    defects: Vec<NamedCount>,
    /// Ways by `highway` value that the FRC table does not know.
    unknown_highways: Vec<NamedCount>,
    /// Tags of roads that are read as another value: on how many ways.
    tags_taken_otherwise: Vec<NamedCount>,
    /// Blobs of the extract that have an unknown type and are skipped.
    blobs_passed_over: u64,
    /// Ways with a `highway` tag in the extract.
    highways_in: u64,
    /// How many of them did not become roads, by reason.
    highways_left_out: Vec<NamedCount>,
    /// Those that the FRC table leaves out, with their lengths; by reason, the longest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<LeftOutDocument>,
    /// Roads read, by class.
    classes: Vec<ClassCount>,
}

/// How many there are of one kind.
#[derive(JsonSchema)]
struct NamedCount {
    /// The defect, value, tag or reason.
    name: String,
    /// How many.
    count: u64,
}

/// Roads of one class.
#[derive(JsonSchema)]
struct ClassCount {
    /// Functional road class.
    class: usize,
    /// How many.
    roads: u64,
    /// Their true length in plan, micrometres.
    length_um: u64,
}

/// The photos of a level.
#[derive(JsonSchema)]
struct PhotoLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with a photo.
    tiles: u64,
    /// Stored bytes of their photos.
    bytes: u64,
}

/// What one class costs on one level.
#[derive(JsonSchema)]
pub(crate) struct RowDocument {
    /// Level.
    level: u8,
    /// Functional road class.
    class: u8,
    /// Points of the source lines that lie in tiles with ground.
    source_vertices: u64,
    /// Points of the level's simplified lines that lie in tiles with ground.
    simplified_vertices: u64,
    /// Vertices of the clipped lines.
    geo_vertices: u64,
    /// Points of the plan lines for shadow volumes.
    sv_vertices: u64,
    /// Bytes of the source lines as plain f64 pairs.
    source_bytes: u64,
    /// Bytes of the simplified lines as plain f64 pairs.
    simplified_bytes: u64,
    /// Bytes of the clipped lines as plain f64 triples.
    geo_raw_bytes: u64,
    /// Bytes of the clipped lines as stored.
    geo_stored_bytes: u64,
    /// Bytes of the plan lines as stored.
    sv_stored_bytes: u64,
}
