//! The schema of `corniche info --json`, and of rows of growth. Most of the document is serialized
//! by records of packages; the types here exist only for the schema.

#![expect(dead_code, reason = "only its schema is wanted")]

use schemars::JsonSchema;

use super::{
    layers::LayerDocument,
    record_schemas::{
        DistributionDocument, LeftOutDocument, LossDocument, NodeCountsDocument, NodeDocument,
        SamplesDocument,
    },
    settings_schema_tests::SettingsDocument,
    spans::SpansDocument,
};

/// The contents of a package.
#[derive(JsonSchema)]
pub(crate) struct InfoDocument {
    /// The manifest.
    manifest: ManifestDocument,
    /// Ids of all tiles, "z/x/y".
    tiles: Vec<String>,
}

/// The manifest of a package.
#[derive(JsonSchema)]
pub(crate) struct ManifestDocument {
    /// Version of the encodings.
    format_version: u32,
    /// Program and version that wrote the package, with the versions of GDAL and PROJ.
    generator: String,
    /// The tiling scheme: z/x/y is a local quadtree in the working CRS.
    tiling: String,
    /// CRS: "EPSG:…" if it has a code, otherwise its name. Its coordinates times `metres_per_unit`
    /// are working metres.
    crs: String,
    /// CRS as WKT2.
    crs_wkt: String,
    /// Working metres per unit of the CRS's coordinates, east and north.
    metres_per_unit: [f64; 2],
    /// Working metres per true metre, at the centre.
    point_scale: f64,
    /// Working metres per true metre along each axis, at the centre and along the border of the
    /// data.
    scale: ScaleDocument,
    /// The grid.
    frame: FrameDocument,
    /// Rectangle of the DEM's nodes, working metres.
    data_bounds: BoundsDocument,
    /// Rectangle of the DEM's nodes, WGS84 degrees.
    wgs84_bounds: BoundsDocument,
    /// The converted part of the elevation files (`--bounds`, `--polygon`); omitted if all of them
    /// were converted.
    #[serde(skip_serializing_if = "Option::is_none")]
    clip: Option<ClipDocument>,
    /// The outline of the elevation files on the lattice, if they do not fill a rectangle: polygons
    /// of rings of [u, v].
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<Vec<Vec<Vec<[i64; 2]>>>>,
    /// The relation between nodes and the DEM's samples, in words.
    resampling: String,
    /// Whether nodes and the DEM's samples are the same points.
    nodes_are_samples: bool,
    /// Heights.
    vertical: VerticalDocument,
    /// Operations that convert positions between datums; omitted if all datums are that of WGS84,
    /// and in older packages.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    datum_operations: Vec<DatumOperationDocument>,
    /// The conversion between WGS84 and the working CRS, without PROJ.
    coordinates: CoordinatesSchema,
    /// The levels, root first.
    levels: Vec<LevelDocument>,
    /// Settings that determine the bytes.
    settings: SettingsDocument,
    /// SHA-256 of the settings.
    settings_sha256: String,
    /// The input files.
    inputs: Vec<InputDocument>,
    /// Attribution that must be displayed wherever the package is shown.
    attribution: Vec<String>,
    /// Numbers of roads that were read, kept (are in the package) and lost, with the reasons.
    counts: CountsDocument,
    /// The cost of clipping roads to the terrain, per level and class.
    growth: Vec<RowDocument>,
    /// The photos of each level that has some, root first; omitted if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    photos: Vec<PhotoLevelDocument>,
    /// The layers, from the lowest to the highest; omitted in packages without layers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    layers: Vec<LayerDocument>,
    /// Bridges and tunnels off the ground, whose heights are estimates; omitted in packages built
    /// without spans.
    #[serde(skip_serializing_if = "Option::is_none")]
    spans: Option<SpansDocument>,
    /// The tiles with the most SV roads (roads drawn by shadow volumes) at their end, each as
    /// level, column, row and number of bytes; omitted if no tile has many.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sv_tails: Vec<[u32; 4]>,
}

/// Working metres per true metre, along x and along y.
#[derive(JsonSchema)]
struct ScaleDocument {
    /// At the centre of the data.
    center: [f64; 2],
    /// The smallest value over corners, middles of sides and centre of every file.
    least: [f64; 2],
    /// The largest value over the same points.
    largest: [f64; 2],
}

/// The grid of a package.
#[derive(JsonSchema)]
pub(crate) struct FrameDocument {
    /// Position of node 0, 0: x and y in working metres.
    origin_m: [f64; 2],
    /// Cell size of the finest level, east and north, working metres.
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

/// The converted part of the elevation files.
#[derive(JsonSchema)]
pub(crate) struct ClipDocument {
    /// The requested bounds, rounded outwards to whole cells: south-western and north-eastern node.
    /// They may extend beyond the data.
    nodes: [NodeDocument; 2],
    /// Rectangle of the nodes of all elevation files, working metres.
    whole_data_bounds: BoundsDocument,
    /// Rectangle of the nodes of all elevation files, WGS84 degrees.
    whole_wgs84_bounds: BoundsDocument,
}

/// Step, unit and datum of the heights.
#[derive(JsonSchema)]
struct VerticalDocument {
    /// One step of heights, metres.
    quantum_m: f64,
    /// Always "metre".
    unit: String,
    /// Vertical datum if the inputs name one, otherwise "unknown".
    datum: String,
    /// Operations on the heights of the inputs, in words.
    treatment: String,
    /// The step between heights that the DEM can distinguish, metres; 0 if heights have fractions.
    height_step_m: f64,
    /// Lowest and highest node, metres.
    range_m: [f64; 2],
}

/// The operation that converts positions between two datums.
#[derive(JsonSchema)]
struct DatumOperationDocument {
    /// The source system.
    from: String,
    /// The target system. The operation is also used in reverse.
    to: String,
    /// PROJ's name for the operation.
    operation: String,
    /// Accuracy of the operation, metres; omitted if PROJ does not know it.
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy_m: Option<f64>,
    /// Whether the operation is a ballpark transformation, without datum shift; omitted if it is
    /// not.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    ballpark: bool,
}

/// A table of longitudes and latitudes over the working CRS, for interpolation with Lagrange's
/// cubic along both axes. This type exists only for the schema.
#[derive(JsonSchema)]
pub(crate) struct CoordinatesSchema {
    /// The covered rectangle, working metres.
    bounds: BoundsDocument,
    /// Samples along each side.
    size: usize,
    /// Longitude and latitude of each sample, degrees, row by row from the south. Longitudes may
    /// continue past 180.
    samples_deg: Vec<[f64; 2]>,
}

/// A level, and its errors.
#[derive(JsonSchema)]
pub(crate) struct LevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Cell size, east and north, working metres.
    cell_m: [f64; 2],
    /// Meshing tolerance, at the nodes of the level's own grid.
    max_error_m: f64,
    /// Largest stored geometric error of the level's tiles, at the nodes of the finest level: on
    /// coarse levels it may exceed the tolerance.
    geometric_error_m: f64,
    /// Stored geometric errors of the level's tiles; null on a level without tiles.
    errors_m: Option<DistributionDocument>,
    /// Differences between the level's TINs and the DEM's own samples.
    sample_error: SamplesDocument,
    /// Ratio of the stored error to the largest true one, where that can be measured.
    tightness: Option<DistributionDocument>,
    /// Least important class shown on this level; null if no roads are shown.
    least_class: Option<u8>,
    /// Tolerance of the simplification of roads, metres; 0 if they are not simplified.
    simplify_tolerance_m: f64,
    /// Distance that plan lines extend beyond their tile.
    width_margin_m: f64,
    /// Tiles with ground.
    tiles: u64,
    /// Triangles of these tiles.
    triangles: u64,
    /// Vertices of these tiles.
    vertices: u64,
    /// Stored bytes of the terrain.
    terrain_bytes: u64,
    /// Stored bytes of the relief; 0 if the level has none.
    relief_bytes: u64,
    /// Nodes of the finest level that have a height and are not covered by the level's triangles.
    uncovered_nodes: u64,
}

/// An input file.
#[derive(JsonSchema)]
struct InputDocument {
    /// "dem"; "dem-part" (a file that belongs to the previous "dem", or is named in it); "photo";
    /// "photo-part" (the same for photos); "polygon"; or "osm".
    kind: String,
    /// File name without folders.
    name: String,
    /// Size of the file, bytes.
    bytes: u64,
    /// SHA-256 of the file.
    sha256: String,
}

/// Numbers of roads that were read, kept (are in the package) and lost, with the reasons.
#[derive(JsonSchema)]
pub(crate) struct CountsDocument {
    /// Nodes of the finest grid in the rectangle of the data.
    samples: NodeCountsDocument,
    /// Roads read from the extract: OSM ways with a class in the FRC table.
    roads_in: u64,
    /// True length in plan of the roads read, micrometres.
    roads_in_um: u64,
    /// Roads kept: on the package's finest level, in whole or in part.
    roads_kept: u64,
    /// True length in plan of the roads kept, micrometres.
    roads_kept_um: u64,
    /// Roads lost: the difference between the roads read and the roads kept, by reason.
    roads_lost: Vec<LossDocument>,
    /// Defects in the extract.
    defects: Vec<NamedCount>,
    /// OSM ways by `highway` value that the FRC table does not contain.
    unknown_highways: Vec<NamedCount>,
    /// Road tags that are interpreted as another value, with the number of OSM ways.
    tags_taken_otherwise: Vec<NamedCount>,
    /// Blobs of the extract that have an unknown type and are skipped.
    blobs_passed_over: u64,
    /// OSM ways with a `highway` tag in the extract.
    highways_in: u64,
    /// Number of OSM ways with a `highway` tag that did not become roads, by reason.
    highways_left_out: Vec<NamedCount>,
    /// OSM ways that the FRC table skips, with lengths; by reason, the longest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<LeftOutDocument>,
    /// Roads read, by class.
    classes: Vec<ClassCount>,
}

/// A number of occurrences.
#[derive(JsonSchema)]
struct NamedCount {
    /// The defect, value, tag or reason.
    name: String,
    /// Number of occurrences.
    count: u64,
}

/// Roads of one class.
#[derive(JsonSchema)]
struct ClassCount {
    /// Functional road class (FRC).
    class: usize,
    /// Number of roads.
    roads: u64,
    /// True length in plan, micrometres.
    length_um: u64,
}

/// The photos of a level.
#[derive(JsonSchema)]
struct PhotoLevelDocument {
    /// Level, 0 = root.
    level: u8,
    /// Tiles with a photo.
    tiles: u64,
    /// Stored bytes of the photos.
    bytes: u64,
}

/// The cost of one class on one level.
#[derive(JsonSchema)]
pub(crate) struct RowDocument {
    /// Level.
    level: u8,
    /// Functional road class (FRC).
    class: u8,
    /// Points of the source lines in tiles with ground.
    source_vertices: u64,
    /// Points of the level's simplified lines in tiles with ground.
    simplified_vertices: u64,
    /// Vertices of the clipped lines: those split at the edges of the triangles.
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
